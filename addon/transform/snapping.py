# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a goal snaps: to steps of its value, or to a vertex, edge or face under the pointer."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

from ..modal.axis_lock import Constraint
from ..modal.state import State
from .frame import Frame
from .view import Pixel, Vector, View

REACH = 30.0  # pixels within which a vertex or an edge is taken
GEOMETRY = ("VERTEX", "EDGE_MIDPOINT", "EDGE", "FACE")  # nearest first to what is small and hard to hit


@dataclass(frozen=True)
class Seen:
    """What a line of sight meets: the place (3,), and the corners of the face there, (k, 3), in order."""

    place: Vector
    corners: Vector


@dataclass(frozen=True)
class Steps:
    """Length of a step of each kind of value, and of the fine one that Shift gives."""

    move: tuple[float, float] = (1.0, 0.1)
    rotate: tuple[float, float] = (math.radians(5.0), math.radians(1.0))
    scale: tuple[float, float] = (0.1, 0.01)


@dataclass(frozen=True)
class Snap:
    """How the scene wants goals to snap.

    Attributes:
        elements: subset of {"INCREMENT", "GRID", *GEOMETRY}.
        kinds: the transforms that snap without Ctrl, and to geometry; the others snap to steps while Ctrl is held.
        steps: for increments.
        source: "CLOSEST", "CENTER", "MEDIAN" or "ACTIVE": what of the selection is to lie on the target.
        points: (k, 3) of the selection, one of which may be the source.
        active: (3,) the active one, if there is any.
        look: what is seen at a pixel, nothing of what moves.

    """

    elements: frozenset[str] = frozenset({"INCREMENT"})
    kinds: frozenset[str] = frozenset({"move"})
    steps: Steps = field(default_factory=Steps)
    source: str = "CLOSEST"
    points: Vector = field(default_factory=lambda: np.empty((0, 3)))
    active: Vector | None = None
    look: Callable[[Pixel], Seen | None] = lambda pixel: None

    def applies(self, state: State) -> bool:
        """Whether the goal of a state snaps."""
        return state.snapping and (state.ctrl or state.kind in self.kinds)

    def translation(self, vector: Vector, pixel: Pixel, frame: Frame, constraint: Constraint, *, fine: bool) -> Vector:
        """The vector (3,) of a move, snapped."""
        axes = frame.axes_of(constraint)[:, list(constraint.axes)]
        target = self.target(pixel, frame.view) if "move" in self.kinds else None
        if target is not None:
            return np.asarray(axes @ (axes.T @ (target - self._source(target - vector, frame.pivot))))
        step = self.steps.move[fine]
        if "GRID" in self.elements:
            return np.asarray(axes @ (axes.T @ (np.round((frame.pivot + vector) / step) * step - frame.pivot)))
        if "INCREMENT" in self.elements or "move" not in self.kinds:
            return np.asarray(axes @ (np.round(axes.T @ vector / step) * step))
        return vector

    def angle(self, angle: float, *, fine: bool) -> float:
        """An angle, in whole steps."""
        return _rounded(angle, self.steps.rotate[fine])

    def factor(self, factor: float, *, fine: bool) -> float:
        """A factor, in whole steps."""
        return _rounded(factor, self.steps.scale[fine])

    def target(self, pixel: Pixel, view: View | None) -> Vector | None:
        """The point (3,) to snap to, None where nothing is near the pointer."""
        seen = self._seen(pixel) if view is not None else None
        if seen is None or view is None:
            return None
        for element in GEOMETRY:
            if element in self.elements:
                nearest = _nearest(_places(element, seen, view, pixel), view, pixel)
                if nearest is not None:
                    return nearest
        return None

    def _seen(self, pixel: Pixel) -> Seen | None:
        """Under the pointer, or just beside it for vertices and edges of an outline."""
        if not self.elements.intersection(GEOMETRY):
            return None
        seen = self.look(pixel)
        if seen is None and self.elements.intersection({"VERTEX", "EDGE", "EDGE_MIDPOINT"}):
            around = ((REACH / 2 * math.cos(a), REACH / 2 * math.sin(a)) for a in np.arange(8) * math.pi / 4)
            return next(filter(None, (self.look((pixel[0] + x, pixel[1] + y)) for x, y in around)), None)
        return seen

    def _source(self, wanted: Vector, pivot: Vector) -> Vector:
        """What is to lie on the target: for the closest, of those moved by the mouse (`wanted` is the way back)."""
        if self.source == "ACTIVE" and self.active is not None:
            return self.active
        if self.source == "CENTER" or len(self.points) == 0:
            return pivot
        if self.source == "CLOSEST":
            return np.asarray(self.points[np.linalg.norm(self.points - wanted, axis=1).argmin()])
        return np.asarray(self.points.mean(axis=0))


def _places(element: str, seen: Seen, view: View, pixel: Pixel) -> Iterable[tuple[Vector, float]]:
    """Candidates, each with the distance in pixels at which it still counts."""
    following = np.roll(seen.corners, -1, axis=0)
    if element == "FACE":
        return [(seen.place, math.inf)]
    if element == "VERTEX":
        return [(corner, REACH) for corner in seen.corners]
    if element == "EDGE_MIDPOINT":
        return [(middle, REACH) for middle in (seen.corners + following) / 2.0]
    edges = zip(seen.corners, following, strict=True)
    return [(_on_edge(a, b, view, pixel, seen.place), REACH) for a, b in edges]


def _on_edge(a: Vector, b: Vector, view: View, pixel: Pixel, place: Vector) -> Vector:
    """The point of an edge nearest to the line of sight (both lines' common perpendicular)."""
    origin, direction = view.ray(pixel, place)
    edge, across = b - a, (b - a) - direction * (direction @ (b - a))
    length = across @ across
    share = (origin - a) @ across / length if length > 0.0 else 0.0
    return np.asarray(a + edge * min(max(share, 0.0), 1.0))


def _nearest(places: Iterable[tuple[Vector, float]], view: View, pixel: Pixel) -> Vector | None:
    best, distance = None, math.inf
    for place, reach in places:
        at = view.project(place)
        away = math.inf if at is None else math.hypot(at[0] - pixel[0], at[1] - pixel[1])
        if away < min(reach, distance) or (reach == math.inf and best is None):
            best, distance = place, away
    return best


def _rounded(value: float, step: float) -> float:
    return round(value / step) * step
