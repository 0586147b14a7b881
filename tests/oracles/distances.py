# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances of all nearby primitives of a static surface, by brute force."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import stiv

from .path import _distances, _outline, _pairs_in_reach

Pair = tuple[str, int, int, int, int]


def near_pairs(surface: stiv.Surface, q: NDArray[np.float64], reach: float) -> dict[Pair, float]:
    """Return the distances of all vertex-face and edge-edge pairs that are closer than `reach`.

    Keys are the kind and the vertices. Pairs that share a vertex are omitted.
    """
    near: dict[Pair, float] = {}
    for kind, pairs in _pairs_in_reach(surface.triangles, surface.loose_edges, q, q, reach):
        distances = _distances(_outline(kind, q[pairs]))
        for pair, distance in zip(pairs[distances < reach].tolist(), distances[distances < reach], strict=True):
            near[(kind, *pair)] = float(distance)
    return near
