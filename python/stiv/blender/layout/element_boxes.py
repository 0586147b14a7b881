# SPDX-License-Identifier: GPL-3.0-or-later
"""The boxes of triangles, edges or vertices, and which of them touch another box, without looking at all of them."""

from __future__ import annotations

import numpy as np

from stiv.blender.scene.arrays import Flags, Floats, Indices

BLOCK = 128  # consecutive elements at rest that share a box; neighbors in a mesh mostly have near numbers


class ElementBoxes:
    """Lowest and highest corners, `low` and `high`, (k, 3) each, of elements; those of movers change.

    A scene has millions of resting elements, and a search needs a few of them: it tests their blocks first.
    """

    def __init__(self, positions: Floats, elements: Indices, moves: Flags) -> None:
        """elements: vertices of each, (k, c). moves: flags of those that `update` may change, (k,)."""
        self._elements = elements
        self.low, self.high = _boxes(positions, elements)
        self._moving, self._resting = (np.flatnonzero(flags).astype(np.int32) for flags in (moves, ~moves))
        starts = np.arange(0, len(self._resting), BLOCK)
        low, high = self.low[self._resting], self.high[self._resting]
        self._block_low = np.minimum.reduceat(low, starts) if len(starts) else low
        self._block_high = np.maximum.reduceat(high, starts) if len(starts) else high

    def update(self, positions: Floats, rows: Indices) -> None:
        """Take the positions, (N, 3), of moving elements."""
        self.low[rows], self.high[rows] = _boxes(positions, self._elements[rows])

    def touching(self, box: Floats) -> Indices:
        """The elements whose box touches a box, (2, 3), ascending."""
        blocks = np.flatnonzero(overlap(self._block_low, self._block_high, box))
        places = (blocks[:, None] * BLOCK + np.arange(BLOCK)).ravel()
        rows = np.concatenate([self._resting[places[places < len(self._resting)]], self._moving])
        return np.sort(self.among(rows, box))

    def among(self, rows: Indices, box: Floats) -> Indices:
        """Those of some elements whose box touches a box, (2, 3)."""
        return rows[overlap(self.low[rows], self.high[rows], box)]


def overlap(low: Floats, high: Floats, box: Floats) -> Flags:
    """Flags of boxes, (k, 3) each corner, that touch a box, (2, 3); by columns, which is faster than by rows."""
    found: Flags = np.ones(len(low), np.bool_)
    for axis in range(3):
        found &= (low[:, axis] <= box[1, axis]) & (high[:, axis] >= box[0, axis])
    return found


def _boxes(positions: Floats, elements: Indices) -> Floats:
    """Lowest and highest corner of each element, (2, k, 3)."""
    corners = positions[elements]
    return np.stack([corners.min(axis=1), corners.max(axis=1)]) if len(elements) else np.zeros((2, 0, 3))
