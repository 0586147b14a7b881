# SPDX-License-Identifier: GPL-3.0-or-later
"""Move: the vector for the motion of the pointer, or for typed numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..modal.axis_lock import AxisLock
from ..modal.header_texts import Translate, entry_text, fixed_text
from ..modal.state import State
from ..modal.typed_numbers import Read
from .frame import Frame
from .snapping import Snap
from .view import Vector, View

GRAZING = np.sin(np.radians(5.0))  # below this angle to the view, an axis or plane cannot be pointed at
HORIZON = 100.0  # a motion longer than this many motions in the view plane is beyond the horizon


Ray = tuple[Vector, Vector]


@dataclass(frozen=True)
class Translation:
    """A translation by `vector`, (3,) in world units."""

    vector: Vector

    def matrix(self, frame: Frame) -> Vector:
        """(4, 4) world matrix."""
        matrix = np.eye(4)
        matrix[:3, 3] = self.vector
        return matrix

    rotation = None  # no rotation vector

    def fraction(self, fraction: float) -> Translation:
        """The translation at a fraction of the way, 0 to 1."""
        return Translation(fraction * self.vector)

    def text(
        self, state: State, frame: Frame, translate: Translate = str, length: Callable[[float], str] = fixed_text
    ) -> str:
        """The text of the header, as Blender's: along the locked axes, or the world's. `length` formats a length."""
        lock = state.axis_lock
        along = self.vector if lock.axis is None else self.vector @ frame.axes_of(lock)[:, list(lock.axes)]
        labels = ("Dx", "Dy", "Dz") if lock.axis is None else ("D",) * len(along)
        entries = [
            f"{label}: {entry_text(state, i, length(float(value)))}"
            for i, (label, value) in enumerate(zip(labels, along, strict=True))
        ]
        return f"{'   '.join(entries)} ({length(float(np.linalg.norm(self.vector)))})"


def requested_translation(state: State, frame: Frame, read: Read = float, snap: Snap | None = None) -> Translation:
    """The translation that a state requests. Typed numbers apply to the axes of the lock in order.

    ValueError for invalid text.
    """
    if state.typed.active:
        return Translation(_typed(state, frame, read))
    if frame.view is None:
        return Translation(np.zeros(3))
    vector = _dragged(state, frame, frame.view)
    if snap is not None and snap.applies(state):
        vector = snap.translation(vector, state.pointer.last, frame, state.axis_lock, fine=state.precise)
    return Translation(vector)


def _typed(state: State, frame: Frame, read: Read) -> Vector:
    axes = frame.axes_of(state.axis_lock)[:, list(state.axis_lock.axes)]
    values = [state.typed.value(i, read) or 0.0 for i in range(state.components)]
    return np.asarray(axes @ np.array(values))


def _dragged(state: State, frame: Frame, view: View) -> Vector:
    start, end = state.pointer.start, state.pointer.effective
    shift = view.at_depth_of(end, frame.pivot) - view.at_depth_of(start, frame.pivot)
    if state.axis_lock.axis is None or not shift.any():
        return shift
    rays = view.ray(start, frame.pivot), view.ray(end, frame.pivot)
    axis = frame.axes_of(state.axis_lock)[:, state.axis_lock.axis]
    exact = _on_locked(state.axis_lock, axis, frame.pivot, rays)
    if exact is not None and _before_horizon(exact, shift, view, frame.pivot):
        return exact
    return _in_view_plane(state.axis_lock, axis, shift, view, frame.pivot)


def _on_locked(axis_lock: AxisLock, axis: Vector, pivot: Vector, rays: tuple[Ray, Ray]) -> Vector | None:
    """From the point of the first view ray on the locked plane or line to that of the second; None if grazing."""
    intersect = _intersect_plane if axis_lock.plane else _closest_on_line
    points = [intersect(pivot, axis, origin, direction) for origin, direction in rays]
    return None if points[0] is None or points[1] is None else points[1] - points[0]


def _intersect_plane(pivot: Vector, normal: Vector, origin: Vector, direction: Vector) -> Vector | None:
    slope = direction @ normal
    if abs(slope) < GRAZING:
        return None
    return origin + direction * ((pivot - origin) @ normal / slope)


def _closest_on_line(pivot: Vector, axis: Vector, origin: Vector, direction: Vector) -> Vector | None:
    """The point of the line closest to the view ray."""
    across = axis - direction * (axis @ direction)
    if np.linalg.norm(across) < GRAZING:
        return None
    return pivot + axis * ((origin - pivot) @ across / (across @ across))


def _before_horizon(exact: Vector, shift: Vector, view: View, pivot: Vector) -> bool:
    near = bool(np.linalg.norm(exact) <= HORIZON * np.linalg.norm(shift))
    return near and view.project(pivot + exact) is not None


def _in_view_plane(axis_lock: AxisLock, axis: Vector, shift: Vector, view: View, pivot: Vector) -> Vector:
    """For grazing angles: the component in the plane; along an axis, the pointer moving down approaches the viewer."""
    if axis_lock.plane:
        return shift - axis * (axis @ shift)
    across = axis - (toward := view.toward_viewer(pivot)) * (axis @ toward)
    if np.linalg.norm(across) >= GRAZING:
        return axis * (shift @ across / (across @ across))
    middle = view.size[0] / 2.0, view.size[1] / 2.0
    up = view.at_depth_of((middle[0], middle[1] + 1.0), pivot) - view.at_depth_of(middle, pivot)
    return axis * (shift @ up / np.linalg.norm(up)) * -np.sign(axis @ toward)
