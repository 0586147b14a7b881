# SPDX-License-Identifier: GPL-3.0-or-later
"""Scale: three factors for the distance of the pointer from the pivot, or for typed factors."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ..modal.header_texts import Translate, entry_text, fixed_text
from ..modal.pointer import Pointer
from ..modal.state import State
from ..modal.typed_numbers import Read
from .frame import Frame, about
from .snapping import Snap
from .view import Pixel, Vector

LEAST_FACTOR = 1e-3  # the pointer alone cannot collapse or mirror
LEAST_RADIUS = 1.0  # pixels, for a drag that starts at the pivot


@dataclass(frozen=True)
class Scaling:
    """A scaling by `factors` (3,) along `axes`, (3, 3) unit columns."""

    factors: Vector
    axes: Vector = field(default_factory=lambda: np.eye(3))
    rotation = None  # no rotation vector

    def matrix(self, frame: Frame) -> Vector:
        """(4, 4) world matrix about the frame's pivot."""
        return about(frame.pivot, self.axes @ np.diag(self.factors) @ self.axes.T)

    def fraction(self, fraction: float) -> Scaling:
        """The scaling at a fraction of the way, 0 to 1."""
        return Scaling(1.0 + fraction * (self.factors - 1.0), self.axes)

    def text(
        self, state: State, frame: Frame, translate: Translate = str, length: Callable[[float], str] = fixed_text
    ) -> str:
        """The text of the header, as Blender's: the factors of the locked axes, or of all three."""
        lock = state.axis_lock
        factors = [f"{self.factors[axis]:.4f}" for axis in lock.axes]
        entries = [entry_text(state, i, factor) for i, factor in enumerate(factors)]
        if lock.axis is not None:
            return translate("Scale: {}").format(" : ".join(entries))
        return translate("Scale {}").format(
            "   ".join(f"{axis}: {entry}" for axis, entry in zip("XYZ", entries, strict=True))
        )


def requested_scaling(state: State, frame: Frame, read: Read = float, snap: Snap | None = None) -> Scaling:
    """The scaling that a state requests, along the axes of the lock. A single typed number applies to all of them.

    ValueError for invalid text.
    """
    factors = np.ones(3)
    free = list(state.axis_lock.axes)
    if state.typed.active:
        factors[free] = _typed(state, read)
    else:
        factor = 1.0 if state.picking_base else _dragged(state.pointer)
        snaps = state.snapping and not state.picking_base
        factors[free] = snap.factor(factor, state, frame) if snap is not None and snaps else factor
    return Scaling(factors, frame.axes_of(state.axis_lock))


def _typed(state: State, read: Read) -> list[float]:
    values = [state.typed.value(i, read) for i in range(state.components)]
    if values[1:] == [None] * len(values[1:]):
        values = values[:1] * len(values)
    return [1.0 if value is None else value for value in values]


def _dragged(pointer: Pointer) -> float:
    if pointer.centre is None:
        return 1.0
    before, after = _distance(pointer.start, pointer.centre), _distance(pointer.effective, pointer.centre)
    return max(after / max(before, LEAST_RADIUS), LEAST_FACTOR)


def _distance(a: Pixel, b: Pixel) -> float:
    return math.hypot(a[0] - b[0], a[1] - b[1])
