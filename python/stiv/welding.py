# SPDX-License-Identifier: GPL-3.0-or-later
"""Welding: merges coincident vertices, so that seams of files and exports become edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv._native import InputError
from stiv.arrays import Indices, as_floats
from stiv.seams import group_seams
from stiv.surface import Surface, as_surface


@dataclass(frozen=True)
class Welded:
    """A surface without coincident vertices, and its relation to the original surface."""

    surface: Surface
    positions: NDArray[np.float64]  #: (N', 3)
    vertex_map: Indices  #: (N,) welded vertex of each original one: `positions[vertex_map]` are the original positions


def weld(surface: Surface | ArrayLike, positions: ArrayLike) -> Welded:
    """Merge vertices of the same body at exactly the same position.

    surface    Surface, or its triangles (F, 3)
    positions  (N, 3)

    Removes triangles and loose edges that degenerate, and duplicates. Raises InputError for a surface with flip faces,
    whose polygons would be lost.
    """
    q = as_floats(positions, "positions", (None, 3))
    before = as_surface(surface, len(q))
    if before.flip_faces:
        raise InputError("a surface with flip faces cannot be welded; weld its mesh first")
    keyed = np.column_stack([before.vertex_body, q + 0.0])  # + 0.0 turns -0.0 into 0.0
    _, first, index = np.unique(keyed, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)  # in order of first occurrence
    place = np.empty(len(order), np.int32)
    place[order] = np.arange(len(order), dtype=np.int32)
    vertex_map: Indices = place[index.reshape(-1)]
    kept = np.sort(first)
    after = Surface(
        _distinct(vertex_map[before.triangles]),
        len(kept),
        _distinct(vertex_map[before.loose_edges]),
        before.vertex_body[kept],
        before.bodies,
        [(int(a), int(b)) for a, b in before.ignored],
    )
    return Welded(after, q[kept], vertex_map)


def join_seams(surface: Surface | ArrayLike, positions: ArrayLike) -> Welded:
    """Merge vertices of the same body at exactly the same position, and keep all triangles.

    surface    Surface, or its triangles (F, 3)
    positions  (N, 3)

    Like `weld`, but triangles and loose edges keep their indices, including duplicates, which intersect. Faces that
    only touch at coincident vertices or edges of a body are neighbors on the joined surface: find_intersections does
    not report them, and an EditSession keeps them together.
    """
    q = as_floats(positions, "positions", (None, 3))
    before = as_surface(surface, len(q))
    seams = group_seams(q, before.vertex_body)
    if seams is None:
        return Welded(before, q, np.arange(len(q), dtype=np.int32))
    kept, index = seams.first, seams.index
    after = Surface(
        index[before.triangles],
        len(kept),
        index[before.loose_edges],
        before.vertex_body[kept],
        before.bodies,
        [(int(a), int(b)) for a, b in before.ignored],
        [sorted({int(index[vertex]) for vertex in face}) for face in before.flip_faces],
    )
    return Welded(after, q[kept], index)


def _distinct(elements: Indices) -> Indices:
    """The first of all rows with the same entries, without rows with repeated entries."""
    proper = elements[(elements != np.roll(elements, 1, axis=1)).all(axis=1)]
    _, first = np.unique(np.sort(proper, axis=1), axis=0, return_index=True)
    return np.ascontiguousarray(proper[np.sort(first)])
