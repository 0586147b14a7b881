# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances of all primitives of a surface at rest that are near each other, by brute force."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import stiv

from .path import _distances, _outline, _pairs_in_reach

Pair = tuple[str, int, int, int, int]


def near_pairs(surface: stiv.Surface, q: NDArray[np.float64], reach: float) -> dict[Pair, float]:
    """Return the distances of all pairs of a vertex and a face, or of two edges, that are nearer than `reach`.

    Named by kind and vertices; those that share a vertex are left out.
    """
    near: dict[Pair, float] = {}
    for kind, pairs in _pairs_in_reach(surface.triangles, surface.loose_edges, q, q, reach):
        distances = _distances(_outline(kind, q[pairs]))
        for pair, distance in zip(pairs[distances < reach].tolist(), distances[distances < reach], strict=True):
            near[(kind, *pair)] = float(distance)
    return near
