# SPDX-License-Identifier: GPL-3.0-or-later
"""Welding: coincident vertices made one, so that seams of files and exports become edges."""

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
    """A surface without coincident vertices, and where those of the surface before have gone."""

    surface: Surface
    positions: NDArray[np.float64]  #: (N', 3)
    vertex_map: Indices  #: (N,) vertex of the welded surface for each one before: `positions[vertex_map]` goes back


def weld(surface: Surface | ArrayLike, positions: ArrayLike) -> Welded:
    """Make vertices one that lie at exactly the same place and belong to the same body.

    surface    Surface, or its triangles (F, 3)
    positions  (N, 3)

    Triangles and loose edges of which two corners become one are left out, and so are all but the first of those that
    get the same corners. Raises InputError for a surface with recut faces, whose polygons cannot be kept.
    """
    q = as_floats(positions, "positions", (None, 3))
    before = as_surface(surface, len(q))
    if before.recut_faces:
        raise InputError("a surface with recut faces cannot be welded; weld its mesh before it is cut")
    keyed = np.column_stack([before.vertex_body, q + 0.0])  # + 0.0: -0.0 and 0.0 are one place
    _, first, index = np.unique(keyed, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)  # vertices keep the order in which they come first
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
    """Make vertices one that lie at exactly the same place and belong to the same body; keep all triangles.

    surface    Surface, or its triangles (F, 3)
    positions  (N, 3)

    As `weld`, but triangles and loose edges keep their numbers, doubled ones too, which intersect. Faces that meet only
    in coincident vertices or edges of a body are neighbours on the joined surface: find_intersections does not report
    them, and an EditSession keeps them together.
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
        [sorted({int(index[vertex]) for vertex in face}) for face in before.recut_faces],
    )
    return Welded(after, q[kept], index)


def _distinct(elements: Indices) -> Indices:
    """Rows whose entries all differ, and of those with the same entries the first."""
    proper = elements[(elements != np.roll(elements, 1, axis=1)).all(axis=1)]
    _, first = np.unique(np.sort(proper, axis=1), axis=0, return_index=True)
    return np.ascontiguousarray(proper[np.sort(first)])
