# SPDX-License-Identifier: GPL-3.0-or-later
"""Move: the vector for the motion of the pointer, or for typed numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..modal.axis_lock import AxisLock
from ..modal.header_texts import Translate, entry_text, fixed_text
from ..modal.pointer import Pointer
from ..modal.state import State
from ..modal.typed_numbers import Read
from .frame import Frame
from .snapping import Snap
from .view import Vector, View

NEARLY_ALIGNED = np.cos(np.radians(5.0))  # an axis at a smaller angle to the view cannot be pointed at
EDGE_ON = 1e-3  # sine of the angle below which a plane cannot be pointed at
HORIZON = 100.0  # a motion longer than this many motions in the view plane is beyond the horizon


@dataclass(frozen=True)
class Translation:
    """A translation by `vector`, (3,) in world units.

    `alignment`: unit direction onto which objects turn first, and the point about which, (3,) each; None for no turn.
    """

    vector: Vector
    alignment: tuple[Vector, Vector] | None = None

    def matrix(self, frame: Frame) -> Vector:
        """(4, 4) world matrix."""
        matrix = np.eye(4)
        matrix[:3, 3] = self.vector
        return matrix

    rotation = None  # no rotation vector

    def fraction(self, fraction: float) -> Translation:
        """The translation at a fraction of the way, 0 to 1."""
        return Translation(fraction * self.vector, self.alignment)

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
    if state.picking_base:
        return Translation(np.zeros(3))
    vector = _dragged(state.pointer, state.axis_lock, frame, frame.view)
    if snap is not None and state.snapping:
        from_pivot = Pointer.at(frame.view.project(frame.pivot) or state.pointer.last).moved(state.pointer.last)
        shift = _dragged(from_pivot, state.axis_lock, frame, frame.view)
        return Translation(snap.translation(vector, shift, state, frame), snap.alignment(state, frame, shift))
    return Translation(vector)


def _typed(state: State, frame: Frame, read: Read) -> Vector:
    axes = frame.axes_of(state.axis_lock)[:, list(state.axis_lock.axes)]
    values = [state.typed.value(i, read) or 0.0 for i in range(state.components)]
    return np.asarray(axes @ np.array(values))


def _dragged(pointer: Pointer, axis_lock: AxisLock, frame: Frame, view: View) -> Vector:
    """The motion of the pointer at the depth of the pivot; with a lock, where that takes the pivot on axis or plane."""
    start, end = pointer.start, pointer.effective
    shift = view.at_depth_of(end, frame.pivot) - view.at_depth_of(start, frame.pivot)
    if axis_lock.axis is None or not shift.any():
        return shift
    axis = frame.axes_of(axis_lock)[:, axis_lock.axis]
    if not axis_lock.plane and abs(axis @ view.backward) > NEARLY_ALIGNED:
        return _by_height(shift, axis, view)
    along = _in_plane if axis_lock.plane else _on_line
    exact = along(shift, axis, frame.pivot, view)
    if _before_horizon(exact, shift, view, frame.pivot):
        return exact
    flat = axis * (axis @ shift)
    return shift - flat if axis_lock.plane else flat


def _in_plane(shift: Vector, normal: Vector, pivot: Vector, view: View) -> Vector:
    """Along the view ray onto the plane; if that is seen from its edge, the part of the motion in the plane."""
    if abs(normal @ view.toward_viewer(pivot)) < EDGE_ON:
        return shift - normal * (normal @ shift)
    direction = view.toward_viewer(pivot + shift)
    slope = direction @ normal
    return shift - direction * (shift @ normal / slope) if slope else shift


def _on_line(shift: Vector, axis: Vector, pivot: Vector, view: View) -> Vector:
    """Along the view ray onto the line."""
    across = np.cross(view.toward_viewer(pivot), axis)
    seen = shift - across * (across @ shift / (across @ across))
    direction = view.toward_viewer(pivot + seen)
    away = axis - direction * (axis @ direction)
    return np.asarray(axis * (seen @ away / (axis @ away)))


def _by_height(shift: Vector, axis: Vector, view: View) -> Vector:
    """Along an axis in the line of sight: by the motion up and down, squared."""
    up = 2.0 * (shift @ np.cross(view.backward, view.right))
    return np.asarray(-axis * up * abs(up))


def _before_horizon(exact: Vector, shift: Vector, view: View, pivot: Vector) -> bool:
    near = bool(np.linalg.norm(exact) <= HORIZON * np.linalg.norm(shift))
    return near and view.project(pivot + exact) is not None
