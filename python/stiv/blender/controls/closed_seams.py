# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams that stay closed on surfaces that Blender evaluates: all copies of a vertex are one vertex of the surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.evaluated_scene import VisibleMesh, evaluation_tolerance
from stiv.seams import Seams

EQUAL_WEIGHTS = 1e-5  # maximum difference of the weights of copies that move alike


def limit_to_closed(
    seams: Seams | None, mesh: VisibleMesh, states: Sequence[Floats], weights: Floats | None = None
) -> Seams | None:
    """The seams of a mesh whose copies coincide in all states, and have equal weights; None if there are none.

    states: displacements or world positions of the vertices, (n, ...). weights: of bones, (n, g).
    """
    if seams is None:
        return None
    tolerance = evaluation_tolerance(mesh.world())
    tests = [(values, tolerance) for values in states]
    if weights is not None:
        tests.append((weights, EQUAL_WEIGHTS))
    found: Seams | None = seams
    for values, most in tests:
        found = found and found.limited_to_equal(values, most)
    return found


def seams_of_part(seams: Seams | None, part: VisibleMesh) -> Seams | None:
    """The seams of a mesh within one of its parts.

    Blender's evaluation is compared with the part, which is smaller: the copies must be closer to each other.
    """
    if seams is None:
        return None
    vertices = np.arange(len(seams.index)) if part.cropped is None else part.cropped.vertices
    _, first, index = np.unique(seams.index[vertices], return_index=True, return_inverse=True)
    own = Seams.of(first[index.reshape(-1)].astype(np.int32))
    return own and own.limited_to_equal(part.world(), evaluation_tolerance(part.world()) / 2)


@dataclass(frozen=True)
class MergedRows:
    """The vertices that remain of all evaluated ones, and those that coincide with them.

    Attributes:
        rows: numbers of the vertices that remain, (k,).
        copies: numbers of the others, (c,).
        leaders: the vertex with which each copy coincides, (c,).
        tolerances: their maximum distance along an axis, (c,).
    """

    rows: Indices
    copies: Indices
    leaders: Indices
    tolerances: Floats

    @classmethod
    def of(cls, places: Sequence[Indices], seams: Sequence[Seams | None], positions: Floats) -> MergedRows:
        """From the vertices of each part, their seams, and positions of all vertices, (n, 3)."""
        none = np.empty(0, np.int32)
        rows, copies, leaders, tolerances = [none], [none], [none], [np.empty(0)]
        for place, each in zip(places, seams, strict=True):
            rows.append(place if each is None else place[each.first])
            if each is not None:
                own = np.flatnonzero(each.leaders != np.arange(len(place)))
                copies.append(place[own])
                leaders.append(place[each.leaders[own]])
                tolerances.append(np.full(len(own), evaluation_tolerance(positions[place])))
        return cls(np.concatenate(rows), np.concatenate(copies), np.concatenate(leaders), np.concatenate(tolerances))

    def merged(self, positions: Floats) -> Floats | None:
        """Positions of the vertices that remain, (k, 3); None if a seam has opened."""
        apart = np.abs(positions[self.copies] - positions[self.leaders])
        return positions[self.rows] if (apart <= self.tolerances[:, None]).all() else None
