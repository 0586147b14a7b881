# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapping of a goal: to increments of its value, or so that a point of the selection meets a target."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..modal.axis_lock import AxisLock
from ..modal.state import State
from .frame import Frame
from .snap_search import GEOMETRY, SCREEN_ELEMENTS, Found, SnapSearch
from .view import Vector, View

PARALLEL = 1e-4  # sine or cosine below which an axis cannot meet the line or plane of a target
BASE_ELEMENTS = GEOMETRY - {"EDGE_PERPENDICULAR"}  # for the snap base, if only increments are chosen
INDIVIDUAL = frozenset({"FACE_PROJECT", "FACE_NEAREST"})  # each object or point is put onto a face of its own
MAX_REPEATS = 4  # searches until the source no longer changes, which Blender takes from the motion before
FROM_SOURCE = frozenset({"EDGE_PERPENDICULAR", "GRID"})  # elements whose place depends on the source


@dataclass(frozen=True)
class Increments:
    """Increments of each kind of transform, coarse and, with Shift, fine."""

    move: tuple[float, float] = (1.0, 0.1)
    rotate: tuple[float, float] = (math.radians(5.0), math.radians(1.0))
    scale: tuple[float, float] = (0.1, 0.01)


def _no_search(elements: frozenset[str]) -> SnapSearch:
    return SnapSearch((), elements)


@dataclass(frozen=True)
class Snap:
    """The snapping settings of a scene.

    Attributes:
        elements: subset of {"INCREMENT", "GRID", *INDIVIDUAL, *GEOMETRY}.
        kinds: the transforms that snap to `elements`; the others snap to increments.
        increments: lengths of the increments; the grid has that of a move.
        source: "CLOSEST", "CENTER", "MEDIAN" or "ACTIVE": the point of the selection that moves onto the target.
        points: (k, 3) candidates for "CLOSEST", at the start of the transform.
        median: (3,) the median of the selection; None for the pivot.
        active: (3,) the active element, None without one: then "ACTIVE" is the median.
        whole: "VOLUME" is the middle of the whole object, not of its first layer.
        nearest_steps: number of steps in which "FACE_NEAREST" follows the surface.
        same_object: "FACE_NEAREST" stays on the object that is nearest at the start.
        align: a move turns objects onto the normal of the target.
        search: begins a search for elements among the targets; called once.
        search_base: the same with the selection as targets, for the snap base.

    """

    elements: frozenset[str] = frozenset({"INCREMENT"})
    kinds: frozenset[str] = frozenset({"move"})
    increments: Increments = field(default_factory=Increments)
    source: str = "CLOSEST"
    points: Vector = field(default_factory=lambda: np.empty((0, 3)))
    median: Vector | None = None
    active: Vector | None = None
    whole: bool = False
    nearest_steps: int = 1
    same_object: bool = False
    align: bool = False
    search: Callable[[frozenset[str]], SnapSearch] = _no_search
    search_base: Callable[[frozenset[str]], SnapSearch] = _no_search

    def translation(self, vector: Vector, from_pivot: Vector, state: State, frame: Frame) -> Vector:
        """The vector (3,) of a move, snapped. `from_pivot`: the move that takes the pivot to the pointer."""
        snapped = self.match(state, frame, from_pivot)
        axes = frame.axes_of(state.axis_lock)[:, list(state.axis_lock.axes)]
        if snapped is not None:
            return _within_lock(*snapped, state.axis_lock, axes)
        step = self.increments.move[state.precise]
        if "INCREMENT" not in self._elements(state):
            return vector
        if state.axis_lock.axis is None:
            return np.round(vector / step) * step
        return np.asarray(axes @ (np.round(axes.T @ vector / step) * step))

    def alignment(self, state: State, frame: Frame, from_pivot: Vector) -> tuple[Vector, Vector] | None:
        """The direction onto which a move turns objects, and the point about which; None without a target."""
        snapped = self.match(state, frame, from_pivot) if self.align else None
        if snapped is None or snapped[2] is None or not snapped[2].direction.any():
            return None
        return snapped[2].direction, snapped[1]

    def angle(self, angle: float, axis: Vector, state: State, frame: Frame) -> float:
        """An angle about a unit axis, (3,), snapped."""
        snapped = self.match(state, frame)
        if snapped is not None:
            return angle_between(snapped[1], snapped[0], axis, frame, locked=state.axis_lock.axis is not None)
        return self.increment(angle, state)

    def increment(self, angle: float, state: State) -> float:
        """An angle, snapped to increments only."""
        if "INCREMENT" not in self._elements(state):
            return angle
        return _rounded(angle, self.increments.rotate[state.precise])

    def factor(self, factor: float, state: State, frame: Frame) -> float:
        """A factor, snapped."""
        snapped = self.match(state, frame)
        if snapped is not None:
            found = factor_between(snapped[1], snapped[0], state.axis_lock, frame)
            return factor if found is None else found
        if "INCREMENT" not in self._elements(state):
            return factor
        return _rounded(factor, self.increments.scale[state.precise])

    def place(self, state: State, frame: Frame) -> Callable[[Vector, Vector], Vector] | None:
        """Puts each object or point, (k, 3), onto a face of its own; None if that is not chosen."""
        chosen, view = self._elements(state) & INDIVIDUAL, frame.view
        if not chosen or view is None or not state.snapping or state.typed.active or state.base is not None:
            return None

        def onto_faces(points: Vector, moved: Vector) -> Vector:
            return np.array([self._onto_face(chosen, view, *pair) for pair in zip(points, moved, strict=True)])

        return onto_faces

    def _onto_face(self, chosen: frozenset[str], view: View, point: Vector, moved: Vector) -> Vector:
        pixel = view.project(moved) if "FACE_PROJECT" in chosen else None
        found = self._search.face_under(pixel, view) if pixel is not None else None
        if found is not None:
            return found.position
        if "FACE_NEAREST" not in chosen:
            return moved
        nearest = self._search.nearest(point, moved, steps=self.nearest_steps, same_object=self.same_object)
        return moved if nearest is None else nearest

    def match(
        self, state: State, frame: Frame, from_pivot: Vector | None = None
    ) -> tuple[Vector, Vector, Found | None] | None:
        """The point to snap to, the point of the selection that moves there, and the element; None without a target."""
        if frame.view is None:
            return None
        source, found = self._source(None, state, frame), None
        for _ in range(MAX_REPEATS if self._elements(state) & FROM_SOURCE else 1):
            found = self.target(state, frame, source, from_pivot)
            before, source = source, self._source(found, state, frame)
            if np.array_equal(before, source):
                break
        points = [np.array(point) for point in state.snap_points] + ([] if found is None else [found.position])
        return (np.mean(points, axis=0), source, found) if points else None

    def target(
        self, state: State, frame: Frame, source: Vector | None = None, from_pivot: Vector | None = None
    ) -> Found | None:
        """The element that the pointer snaps to; `source` (3,) is where perpendiculars start, by default the pivot."""
        view, pixel, elements = frame.view, state.pointer.last, self._elements(state)
        if view is None:
            return None
        source = self._source(None, state, frame) if source is None else source
        search = self._base_search if state.picking_base else self._search
        search = search.among(elements & GEOMETRY)
        found = search.find(pixel, view, source) if elements & (SCREEN_ELEMENTS | {"FACE"}) else None
        if found is None and "GRID" in elements:
            found = self._on_grid(state, frame, view, source, from_pivot)
        if found is None and "VOLUME" in elements:
            found = search.middle(pixel, view, whole=self.whole)
        return found

    def _elements(self, state: State) -> frozenset[str]:
        """The elements in effect."""
        chosen = self.elements if state.kind in self.kinds else frozenset({"INCREMENT"})
        if state.picking_base or state.base is not None:
            geometry = chosen & (GEOMETRY if state.base is not None else BASE_ELEMENTS)
            return geometry or BASE_ELEMENTS
        return chosen

    def _source(self, found: Found | None, state: State, frame: Frame) -> Vector:
        if state.base is not None:
            return np.array(state.base)
        median = frame.pivot if self.median is None else self.median
        if self.source == "ACTIVE" and self.active is not None:
            return self.active
        if self.source == "CENTER" and state.kind == "move":
            return frame.pivot
        on_grid = found is not None and found.element == "GRID" and state.kind == "move"
        if self.source != "CLOSEST" or found is None or on_grid or len(self.points) == 0:
            return median
        return _closest(self.points, found.position, state, frame)

    def _on_grid(
        self, state: State, frame: Frame, view: View, source: Vector, from_pivot: Vector | None
    ) -> Found | None:
        """The point of the grid on the floor under the pointer, or on another plane where the floor is not seen."""
        step = self.increments.move[state.precise]
        if state.axis_lock.axis is not None and from_pivot is not None:
            return Found(np.round((frame.pivot + from_pivot) / step) * step, np.zeros(3), "GRID")
        origin, direction = view.segment(state.pointer.last)
        order = (2, 1, 0) if abs(direction[0]) < abs(direction[1]) else (2, 0, 1)
        for axis in order:
            length = -origin[axis] / direction[axis] if direction[axis] else -1.0
            point = np.round((origin + length * direction) / step) * step
            if length > 0.0 and view.shows(point):
                if view.looks_along_axis:
                    point[axis] += source[axis]
                return Found(point, np.eye(3)[axis], "GRID")
        return None

    @cached_property
    def _search(self) -> SnapSearch:
        return self.search(self.elements & GEOMETRY)

    @cached_property
    def _base_search(self) -> SnapSearch:
        return self.search_base(BASE_ELEMENTS)


def _closest(points: Vector, target: Vector, state: State, frame: Frame) -> Vector:
    """The point that the least transform takes to the target."""
    if state.kind == "rotate":
        locked, axis = state.axis_lock.axis is not None, rotation_axis(state, frame)
        costs = [abs(angle_between(point, target, axis, frame, locked=locked)) for point in points]
    elif state.kind == "scale":
        factors = [factor_between(point, target, state.axis_lock, frame) for point in points]
        costs = [math.inf if factor is None else factor for factor in factors]
    else:
        costs = list(np.linalg.norm(points - target, axis=1))
    return np.asarray(points[int(np.argmin(costs))])


def _within_lock(point: Vector, source: Vector, found: Found | None, axis_lock: AxisLock, axes: Vector) -> Vector:
    """The vector from the source to a target, or to where the locked axis or plane meets its edge or face."""
    vector = point - source
    if axis_lock.axis is None:
        return vector
    projected = np.asarray(axes @ (axes.T @ vector))
    if found is None or found.element not in ("EDGE", "FACE"):
        return projected
    if axis_lock.plane:
        normal = np.cross(axes[:, 0], axes[:, 1])
        slope = found.direction @ normal
        if found.element == "FACE" or abs(slope) < PARALLEL or not projected.any():
            return projected
        return vector - found.direction * (vector @ normal / slope)
    axis = axes[:, 0]
    if found.element == "FACE":
        slope = axis @ found.direction
        return projected if abs(slope) < PARALLEL else axis * (vector @ found.direction / slope)
    if abs(axis @ found.direction) > 1.0 - PARALLEL:
        return projected
    across = axis - found.direction * (axis @ found.direction)
    return np.asarray(axis * (vector @ across / (axis @ across)))


def rotation_axis(state: State, frame: Frame) -> Vector:
    """Unit axis (3,): the locked one, or that of the view without a lock."""
    if state.axis_lock.axis is not None:
        return np.asarray(frame.axes_of(state.axis_lock)[:, state.axis_lock.axis])
    return np.array([0.0, 0.0, 1.0]) if frame.view is None else frame.view.backward


def angle_between(start: Vector, end: Vector, axis: Vector, frame: Frame, *, locked: bool) -> float:
    """The angle about an axis through the pivot from one point to another, within half a turn."""
    start, end = start - frame.pivot, end - frame.pivot
    if locked or frame.view is None:
        return math.atan2(float(np.cross(start, end) @ axis), float(start @ end - (start @ axis) * (end @ axis)))
    right = frame.view.right
    up = np.cross(axis, right)
    angle = math.atan2(end @ up, end @ right) - math.atan2(start @ up, start @ right)
    return math.remainder(angle, 2.0 * math.pi)


def factor_between(start: Vector, end: Vector, axis_lock: AxisLock, frame: Frame) -> float | None:
    """The factor about the pivot that takes one point to the height of another; None for a point at the pivot."""
    axes = frame.axes_of(axis_lock)[:, list(axis_lock.axes)]
    start, end = (axes @ (axes.T @ (point - frame.pivot)) for point in (start, end))
    along = abs(float(start @ end))
    return float(end @ end) / along if along > 0.0 else None


def _rounded(value: float, step: float) -> float:
    return round(value / step) * step if step else value
