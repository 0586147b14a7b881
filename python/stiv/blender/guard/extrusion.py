# SPDX-License-Identifier: GPL-3.0-or-later
"""Where new vertices of a mesh came from: an extrusion starts at the vertices from which it was pulled."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stiv.blender.scene.arrays import Floats, Indices, Singles

Flags = NDArray[np.bool_]


def extruded_from(before: Singles, after: Singles, edges: Indices) -> tuple[Floats, Flags] | None:
    """Origin of each vertex, (n, 3), and flags of the moved vertices, (n,), of an extruded mesh.

    before: vertices before the tool, (m, 3). after: vertices after it, (n, 3). edges: those after it, (e, 2).

    Each extruded vertex has one edge to the vertex from which it was pulled, which did not move. Vertices inside an
    extruded region have none; they moved like their neighbors. Returns None if the new vertices come from elsewhere.
    """
    moved = ~is_among(after, before)
    if not moved.any():
        return None
    steps, known = _along_sides(after, edges, moved)
    inner = edges[moved[edges].all(axis=1)]
    while not known[moved].all():
        grown = _spread(steps, known, inner)
        if not grown.any():
            return None
        known |= grown
    return after - steps, moved


def is_among(points: Singles, others: Singles) -> Flags:
    """Which points are exactly among others, (n,)."""
    stored = {row.tobytes() for row in np.ascontiguousarray(others, np.float32) + np.float32(0)}
    return np.array([row.tobytes() in stored for row in np.ascontiguousarray(points, np.float32) + np.float32(0)])


def _along_sides(points: Singles, edges: Indices, moved: Flags) -> tuple[Floats, Flags]:
    """Steps of the moved vertices with exactly one edge to a vertex that did not move, and their flags."""
    sides = edges[moved[edges].sum(axis=1) == 1]
    new = np.where(moved[sides[:, 0]], sides[:, 0], sides[:, 1])
    old = sides.sum(axis=1) - new
    count = np.bincount(new, minlength=len(points))
    steps = np.zeros((len(points), 3))
    steps[new] = points[new].astype(np.float64) - points[old]
    known: Flags = count == 1
    steps[~known] = 0.0
    return steps, known


def _spread(steps: Floats, known: Flags, inner: Indices) -> Flags:
    """Give the neighbors of known vertices their mean step; returns the flags of the vertices that received one."""
    both = np.concatenate([inner, inner[:, ::-1]])
    from_known = both[known[both[:, 0]] & ~known[both[:, 1]]]
    total, count = np.zeros_like(steps), np.bincount(from_known[:, 1], minlength=len(steps))
    np.add.at(total, from_known[:, 1], steps[from_known[:, 0]])
    grown: Flags = count > 0
    steps[grown] = total[grown] / count[grown, None]
    return grown
