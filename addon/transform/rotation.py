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
from .snapping import Snap
from .view import Vector


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
    toward = np.array([0.0, 0.0, 1.0]) if frame.view is None else frame.view.toward_viewer(frame.pivot)
    locked = state.axis_lock.axis
    axis = toward if locked is None else frame.axes_of(state.axis_lock)[:, locked]
    if state.typed.active:
        return Rotation(state.typed.value(0, read) or 0.0, axis)
    # An axis that points away from the viewer turns the other way.
    angle = state.pointer.turn * (1.0 if axis @ toward >= 0.0 else -1.0)
    return Rotation(snap.angle(angle, fine=state.precise) if snap is not None and snap.applies(state) else angle, axis)
