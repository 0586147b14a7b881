# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotate: from the pointer's turn around the pivot, or a typed angle, to an axis and an angle."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..modal.header_texts import decimal_text
from ..modal.state import State
from ..modal.typed_numbers import Read
from .frame import Frame, about
from .snapping import Snap
from .view import Vector


@dataclass(frozen=True)
class Rotation:
    """A rotation by `angle` radians, counter-clockwise about the unit `axis` (3,) in world space."""

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
        """As a rotation vector, whole turns included."""
        return self.angle * self.axis

    def part(self, fraction: float) -> Rotation:
        """A fraction of the way to it, 0 to 1."""
        return Rotation(fraction * self.angle, self.axis)

    def text(self, say: Callable[[str], str] = str, length: Callable[[float], str] = decimal_text) -> str:
        """For the header; `say` puts a text into the language of the interface, `length` writes a length."""
        return say("Rotate {}").format(f"{decimal_text(math.degrees(self.angle))}°")


def read_degrees(text: str) -> float:
    """A number of degrees, in radians."""
    return math.radians(float(text))


def measure_rotation(state: State, frame: Frame, read: Read = read_degrees, snap: Snap | None = None) -> Rotation:
    """What a drag asks for: about the locked axis, or the line of sight when none is locked.

    ValueError for typed text that is no angle; `read` gives radians.
    """
    toward = np.array([0.0, 0.0, 1.0]) if frame.view is None else frame.view.toward_viewer(frame.pivot)
    locked = state.constraint.axis
    axis = toward if locked is None else frame.axes_of(state.constraint)[:, locked]
    if state.typed.active:
        return Rotation(state.typed.value(0, read) or 0.0, axis)
    # Seen from behind, an axis turns the other way round.
    angle = state.pointer.turn * (1.0 if axis @ toward >= 0.0 else -1.0)
    return Rotation(snap.angle(angle, fine=state.precise) if snap is not None and snap.applies(state) else angle, axis)
