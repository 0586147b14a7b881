# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotate: axis and angle for the turn of the pointer around the pivot, or for a typed angle."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..modal.header_texts import Translate, entry_text, fixed_text
from ..modal.state import State
from ..modal.typed_numbers import Read
from .frame import Frame, about
from .snapping import Snap, rotation_axis
from .view import Vector

TRACKBALL = 0.01  # radians for each pixel


@dataclass(frozen=True)
class Rotation:
    """A rotation by `angle` radians, counterclockwise about the unit `axis` (3,) in world space."""

    angle: float
    axis: Vector

    def matrix(self, frame: Frame) -> Vector:
        """(4, 4) world matrix about the frame's pivot (Rodrigues' formula)."""
        x, y, z = self.axis
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        linear = np.eye(3) + math.sin(self.angle) * cross + (1.0 - math.cos(self.angle)) * (cross @ cross)
        return about(frame.pivot, linear)

    @property
    def rotation(self) -> Vector:
        """The rotation vector, with whole turns."""
        return self.angle * self.axis

    def fraction(self, fraction: float) -> Rotation:
        """The rotation at a fraction of the way, 0 to 1."""
        return Rotation(fraction * self.angle, self.axis)

    def text(
        self, state: State, frame: Frame, translate: Translate = str, length: Callable[[float], str] = fixed_text
    ) -> str:
        """The text of the header, as Blender's; a rotation has no `length`."""
        degrees = f"{math.degrees(self.angle):.2f}°".replace("-0.00", "0.00")
        return translate("Rotation: {}").format(entry_text(state, 0, degrees))


def read_degrees(text: str) -> float:
    """Radians of a text in degrees."""
    return math.radians(float(text))


def requested_rotation(state: State, frame: Frame, read: Read = read_degrees, snap: Snap | None = None) -> Rotation:
    """The rotation that a state requests: about the locked axis, or the view direction without a lock.

    `read` returns radians. ValueError for invalid text.
    """
    if state.trackball:
        return _trackball(state, frame, read, snap)
    axis = rotation_axis(state, frame)
    if state.typed.active:
        return Rotation(state.typed.value(0, read) or 0.0, axis)
    if state.picking_base:
        return Rotation(0.0, axis)
    # An axis that points away from the viewer turns the other way.
    faces_viewer = frame.view is None or axis @ frame.view.backward >= 0.0
    angle = state.pointer.turn * (1.0 if faces_viewer else -1.0)
    return Rotation(snap.angle(angle, axis, state, frame) if snap is not None and state.snapping else angle, axis)


def _trackball(state: State, frame: Frame, read: Read, snap: Snap | None) -> Rotation:
    """The rotation that follows the pointer like the surface of a ball: angles about both axes of the view."""
    if state.typed.active:
        angles = np.array([state.typed.value(i, read) or 0.0 for i in range(2)])
    elif state.picking_base:
        angles = np.zeros(2)
    else:
        right, up = np.subtract(state.pointer.effective, state.pointer.start)
        angles = TRACKBALL * np.array([-up, right])
    if snap is not None and state.snapping and not state.typed.active:
        angles = np.array([snap.increment(angle, state) for angle in angles])
    view = frame.view
    axes = np.eye(3)[:2] if view is None else np.array([view.right, np.cross(view.backward, view.right)])
    vector = angles @ axes
    angle = float(np.linalg.norm(vector))
    return Rotation(angle, vector / angle if angle > 0.0 else axes[0])
