# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapping of a goal: to increments of its value, or to a vertex, edge or face under the pointer."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

from ..modal.axis_lock import AxisLock
from ..modal.state import State
from .frame import Frame
from .view import Pixel, Vector, View

REACH = 30.0  # pixels within which a vertex or an edge is snapped to
GEOMETRY = ("VERTEX", "EDGE_MIDPOINT", "EDGE", "FACE")  # the smallest targets first


@dataclass(frozen=True)
class Hit:
    """The first surface on a view ray: the position (3,), and the corners of its face, (k, 3), in order."""

    position: Vector
    corners: Vector


@dataclass(frozen=True)
class Increments:
    """Increments of each kind of transform, coarse and, with Shift, fine."""

    move: tuple[float, float] = (1.0, 0.1)
    rotate: tuple[float, float] = (math.radians(5.0), math.radians(1.0))
    scale: tuple[float, float] = (0.1, 0.01)


@dataclass(frozen=True)
class Snap:
    """The snapping settings of a scene.

    Attributes:
        elements: subset of {"INCREMENT", "GRID", *GEOMETRY}.
        kinds: the transforms that snap without Ctrl, and to geometry; the others snap to increments while Ctrl is held.
        increments: lengths of the increments.
        source: "CLOSEST", "CENTER", "MEDIAN" or "ACTIVE": the point of the selection that moves onto the target.
        points: (k, 3) candidates for the source.
        active: (3,) the active one, None without one.
        cast: the first surface on the view ray of a pixel, without the moving objects.

    """

    elements: frozenset[str] = frozenset({"INCREMENT"})
    kinds: frozenset[str] = frozenset({"move"})
    increments: Increments = field(default_factory=Increments)
    source: str = "CLOSEST"
    points: Vector = field(default_factory=lambda: np.empty((0, 3)))
    active: Vector | None = None
    cast: Callable[[Pixel], Hit | None] = lambda pixel: None

    def applies(self, state: State) -> bool:
        """Whether the goal of a state snaps."""
        return state.snapping and (state.ctrl or state.kind in self.kinds)

    def translation(self, vector: Vector, pixel: Pixel, frame: Frame, axis_lock: AxisLock, *, fine: bool) -> Vector:
        """The vector (3,) of a move, snapped."""
        axes = frame.axes_of(axis_lock)[:, list(axis_lock.axes)]
        target = self.target(pixel, frame.view) if "move" in self.kinds else None
        if target is not None:
            return np.asarray(axes @ (axes.T @ (target - self._source(target - vector, frame.pivot))))
        step = self.increments.move[fine]
        if "GRID" in self.elements:
            return np.asarray(axes @ (axes.T @ (np.round((frame.pivot + vector) / step) * step - frame.pivot)))
        if "INCREMENT" in self.elements or "move" not in self.kinds:
            return np.asarray(axes @ (np.round(axes.T @ vector / step) * step))
        return vector

    def angle(self, angle: float, *, fine: bool) -> float:
        """An angle, snapped to increments."""
        return _rounded(angle, self.increments.rotate[fine])

    def factor(self, factor: float, *, fine: bool) -> float:
        """A factor, snapped to increments."""
        return _rounded(factor, self.increments.scale[fine])

    def target(self, pixel: Pixel, view: View | None) -> Vector | None:
        """The point (3,) to snap to, None without a target near the pointer."""
        hit = self._hit(pixel) if view is not None else None
        if hit is None or view is None:
            return None
        for element in GEOMETRY:
            if element in self.elements:
                nearest = _nearest(_candidates(element, hit, view, pixel), view, pixel)
                if nearest is not None:
                    return nearest
        return None

    def _hit(self, pixel: Pixel) -> Hit | None:
        """The surface under the pointer, or close to it for vertices and edges of an outline."""
        if not self.elements.intersection(GEOMETRY):
            return None
        hit = self.cast(pixel)
        if hit is None and self.elements.intersection({"VERTEX", "EDGE", "EDGE_MIDPOINT"}):
            around = ((REACH / 2 * math.cos(a), REACH / 2 * math.sin(a)) for a in np.arange(8) * math.pi / 4)
            return next(filter(None, (self.cast((pixel[0] + x, pixel[1] + y)) for x, y in around)), None)
        return hit

    def _source(self, wanted: Vector, pivot: Vector) -> Vector:
        """The point that moves onto the target; for "CLOSEST", among the dragged points. `wanted` undoes the drag."""
        if self.source == "ACTIVE" and self.active is not None:
            return self.active
        if self.source == "CENTER" or len(self.points) == 0:
            return pivot
        if self.source == "CLOSEST":
            return np.asarray(self.points[np.linalg.norm(self.points - wanted, axis=1).argmin()])
        return np.asarray(self.points.mean(axis=0))


def _candidates(element: str, hit: Hit, view: View, pixel: Pixel) -> Iterable[tuple[Vector, float]]:
    """Candidates, each with the largest distance in pixels for it."""
    next_corners = np.roll(hit.corners, -1, axis=0)
    if element == "FACE":
        return [(hit.position, math.inf)]
    if element == "VERTEX":
        return [(corner, REACH) for corner in hit.corners]
    if element == "EDGE_MIDPOINT":
        return [(middle, REACH) for middle in (hit.corners + next_corners) / 2.0]
    edges = zip(hit.corners, next_corners, strict=True)
    return [(_on_edge(a, b, view, pixel, hit.position), REACH) for a, b in edges]


def _on_edge(a: Vector, b: Vector, view: View, pixel: Pixel, position: Vector) -> Vector:
    """The point of an edge closest to the view ray (on the common perpendicular of both lines)."""
    origin, direction = view.ray(pixel, position)
    edge, across = b - a, (b - a) - direction * (direction @ (b - a))
    length = across @ across
    fraction = (origin - a) @ across / length if length > 0.0 else 0.0
    return np.asarray(a + edge * min(max(fraction, 0.0), 1.0))


def _nearest(positions: Iterable[tuple[Vector, float]], view: View, pixel: Pixel) -> Vector | None:
    best, distance = None, math.inf
    for position, reach in positions:
        at = view.project(position)
        away = math.inf if at is None else math.hypot(at[0] - pixel[0], at[1] - pixel[1])
        if away < min(reach, distance) or (reach == math.inf and best is None):
            best, distance = position, away
    return best


def _rounded(value: float, step: float) -> float:
    return round(value / step) * step
