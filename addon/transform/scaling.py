# SPDX-License-Identifier: GPL-3.0-or-later
"""Scale: from the pointer's distance to the pivot, or a typed factor, to three factors."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..modal.pointer import Pointer
from ..modal.state import State
from ..modal.typed_number import TypedNumber
from .frame import Frame, about
from .view import Pixel, Vector

LEAST_FACTOR = 1e-3  # the pointer alone neither collapses nor mirrors
LEAST_RADIUS = 1.0  # pixels, where the drag starts on the pivot itself


@dataclass(frozen=True)
class Scaling:
    """A scaling by `factors` (3,) along the frame's axes."""

    factors: Vector

    def matrix(self, frame: Frame) -> Vector:
        """(4, 4) world matrix about the frame's pivot."""
        return about(frame.pivot, frame.axes @ np.diag(self.factors) @ frame.axes.T)

    def part(self, fraction: float) -> Scaling:
        """A fraction of the way to it, 0 to 1."""
        return Scaling(1.0 + fraction * (self.factors - 1.0))

    def text(self) -> str:
        """For the header."""
        x, y, z = self.factors
        return f"Scale {x:.4g}" if x == y == z else f"Scale X {x:.4g}  Y {y:.4g}  Z {z:.4g}"


def measure_scaling(state: State, frame: Frame) -> Scaling:
    """What a drag asks for, on the axes that are not locked."""
    factor = _typed(state.typed) if state.typed.active else _dragged(state.pointer)
    factors = np.ones(3)
    factors[list(state.constraint.axes)] = factor
    return Scaling(factors)


def _typed(typed: TypedNumber) -> float:
    return 1.0 if typed.value is None else typed.value


def _dragged(pointer: Pointer) -> float:
    if pointer.centre is None:
        return 1.0
    before, after = _distance(pointer.start, pointer.centre), _distance(pointer.effective, pointer.centre)
    return max(after / max(before, LEAST_RADIUS), LEAST_FACTOR)


def _distance(a: Pixel, b: Pixel) -> float:
    return math.hypot(a[0] - b[0], a[1] - b[1])
