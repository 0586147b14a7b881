# SPDX-License-Identifier: GPL-3.0-or-later
"""Move: from the pointer's motion, or a typed number, to a vector."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..modal.axis_lock import Constraint
from ..modal.header_texts import decimal_text
from ..modal.state import State
from ..modal.typed_numbers import Read
from .frame import Frame
from .snapping import Snap
from .view import Vector, View

GRAZING = np.sin(np.radians(5.0))  # an axis or plane seen under a smaller angle cannot be pointed at
HORIZON = 100.0  # a motion longer than so many times the motion in the view plane points beyond the horizon


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

    rotation = None  # as a rotation vector: there is none

    def part(self, fraction: float) -> Translation:
        """A fraction of the way to it, 0 to 1."""
        return Translation(fraction * self.vector)

    def text(self, say: Callable[[str], str] = str, length: Callable[[float], str] = decimal_text) -> str:
        """For the header; `say` puts a text into the language of the interface, `length` writes a length."""
        x, y, z = map(length, self.vector)
        distance = length(float(np.linalg.norm(self.vector)))
        return say("Move {}  (distance {})").format(f"X {x}  Y {y}  Z {z}", distance)


def measure_translation(state: State, frame: Frame, read: Read = float, snap: Snap | None = None) -> Translation:
    """What a drag asks for. Typed numbers count along the axes that are left, in order.

    ValueError for typed text that is no length.
    """
    if state.typed.active:
        return Translation(_typed(state, frame, read))
    if frame.view is None:
        return Translation(np.zeros(3))
    vector = _dragged(state, frame, frame.view)
    if snap is not None and snap.applies(state):
        vector = snap.translation(vector, state.pointer.last, frame, state.constraint, fine=state.precise)
    return Translation(vector)


def _typed(state: State, frame: Frame, read: Read) -> Vector:
    axes = frame.axes_of(state.constraint)[:, list(state.constraint.axes)]
    values = [state.typed.value(i, read) or 0.0 for i in range(state.components)]
    return np.asarray(axes @ np.array(values))


def _dragged(state: State, frame: Frame, view: View) -> Vector:
    start, end = state.pointer.start, state.pointer.effective
    shift = view.beside(end, frame.pivot) - view.beside(start, frame.pivot)
    if state.constraint.axis is None or not shift.any():
        return shift
    rays = view.ray(start, frame.pivot), view.ray(end, frame.pivot)
    axis = frame.axes_of(state.constraint)[:, state.constraint.axis]
    exact = _on_locked(state.constraint, axis, frame.pivot, rays)
    if exact is not None and _before_horizon(exact, shift, view, frame.pivot):
        return exact
    return _flattened(state.constraint, axis, shift, view, frame.pivot)


def _on_locked(constraint: Constraint, axis: Vector, pivot: Vector, rays: tuple[Ray, Ray]) -> Vector | None:
    """From where the first line of sight meets the locked plane or line to where the second does; None if grazing."""
    meet = _meet_plane if constraint.plane else _meet_line
    points = [meet(pivot, axis, origin, direction) for origin, direction in rays]
    return None if points[0] is None or points[1] is None else points[1] - points[0]


def _meet_plane(pivot: Vector, normal: Vector, origin: Vector, direction: Vector) -> Vector | None:
    slope = direction @ normal
    if abs(slope) < GRAZING:
        return None
    return origin + direction * ((pivot - origin) @ normal / slope)


def _meet_line(pivot: Vector, axis: Vector, origin: Vector, direction: Vector) -> Vector | None:
    """The point of the line nearest to the line of sight."""
    across = axis - direction * (axis @ direction)
    if np.linalg.norm(across) < GRAZING:
        return None
    return pivot + axis * ((origin - pivot) @ across / (across @ across))


def _before_horizon(exact: Vector, shift: Vector, view: View, pivot: Vector) -> bool:
    near = bool(np.linalg.norm(exact) <= HORIZON * np.linalg.norm(shift))
    return near and view.project(pivot + exact) is not None


def _flattened(constraint: Constraint, axis: Vector, shift: Vector, view: View, pivot: Vector) -> Vector:
    """Grazing: a plane takes what of the motion lies in it; an axis comes nearer as the pointer goes down."""
    if constraint.plane:
        return shift - axis * (axis @ shift)
    across = axis - (toward := view.toward_viewer(pivot)) * (axis @ toward)
    if np.linalg.norm(across) >= GRAZING:
        return axis * (shift @ across / (across @ across))
    middle = view.size[0] / 2.0, view.size[1] / 2.0
    up = view.beside((middle[0], middle[1] + 1.0), pivot) - view.beside(middle, pivot)
    return axis * (shift @ up / np.linalg.norm(up)) * -np.sign(axis @ toward)
