# SPDX-License-Identifier: GPL-3.0-or-later
"""How far each control may respond, and in which directions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from stiv.blender.controls.directions import FreeDirections
from stiv.blender.scene.arrays import Flags, Floats

if TYPE_CHECKING:
    from stiv.blender.controls.control_set import ControlSet


@dataclass(frozen=True, eq=False)
class Response:
    """Response weights, (m,), or (m, 3) along `axes`, (m, 3, 3); None for the world axes."""

    weights: Floats
    axes: Floats | None = None

    def along(self, free: FreeDirections) -> Response:
        """The response in the free directions only. Pins in other directions still hold."""
        count = len(self.weights)
        if self.weights.ndim == 1:
            return Response(self.weights[:, None] * free.free, _repeated(free.axes, count))
        axes = np.broadcast_to(np.eye(3), (count, 3, 3)) if self.axes is None else self.axes
        shares = np.einsum("mij,ik->mjk", axes, free.axes) ** 2  # of each lock axis k in each axis j
        limited = Response(np.einsum("mj,mjk->mk", self.weights, shares) * free.free, _repeated(free.axes, count))
        pinned = (self.weights == 0).any(axis=1)
        if not pinned.any():
            return limited
        first = int(np.argmax(pinned))  # the pins of an object have the same directions
        both = FreeDirections(axes[first], self.weights[first] > 0).within(free)
        largest = self.weights.max(axis=1)[:, None]
        return limited.replaced(pinned, Response(largest * both.free, _repeated(both.axes, count)))

    def replaced(self, rows: Flags, other: Response) -> Response:
        """The rows flagged in `rows`, (m,), from the other response."""
        if self.weights.ndim == other.weights.ndim == 1:
            return Response(np.where(rows, other.weights, self.weights))
        weights = np.where(rows[:, None], _by_axis(other.weights), _by_axis(self.weights))
        if self.axes is None and other.axes is None:
            return Response(weights)
        world = np.eye(3)
        mine, others = (world if each.axes is None else each.axes for each in (self, other))
        return Response(weights, np.where(rows[:, None, None], others, mine))

    def given_to(self, control_set: ControlSet) -> ControlSet:
        """The control set with this response."""
        return replace(control_set, weights=self.weights, weight_axes=self.axes)


def _by_axis(weights: Floats) -> Floats:
    return np.asarray(np.broadcast_to(weights.reshape(len(weights), -1), (len(weights), 3)), np.float64)


def _repeated(axes: Floats, count: int) -> Floats | None:
    """The same axes for each control; None for those of the world."""
    return None if np.array_equal(axes, np.eye(3)) else np.broadcast_to(axes, (count, 3, 3))
