# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests bent quads with both diagonals, so that Blender's present triangulation need not be read.

Whichever diagonals Blender chooses, the triangles that it shows are among those tested, at the same positions. A flip
of a quad that was included before needs neither another surface nor other trees.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

import stiv
from stiv.blender.scene.arrays import Floats, Indices, Singles
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.quad_diagonals import QuadDiagonals
from stiv.blender.scene.triangulation_flips import BENT

Uncertain = Mapping[int, Indices]  # by number of the mesh, the quads that may not be split as in the assembly


class BothDiagonals:
    """The triangles of an assembly, and those of bent quads along their other diagonal.

    Quads are included when they bend, before Blender may flip them, and remain.
    """

    def __init__(self, assembly: Assembly, threads: int) -> None:
        """Include no quads yet; threads 0 uses all cores."""
        self._assembly, self._threads = assembly, threads
        self._quads: dict[int, QuadDiagonals | None] = {}
        self._included: dict[int, NDArray[np.bool_]] = {}
        self._check: stiv.StepCheck | None = None

    def find_uncertain(self, local: Mapping[int, Singles]) -> Uncertain:
        """Find the quads that Blender may split along another diagonal than the assembly does.

        local: positions of meshes in their own frames, (n, 3), by number. Meshes with larger faces are left out.
        """
        for number in local.keys() - self._quads.keys():
            self._quads[number] = QuadDiagonals.of(self._assembly.meshes[number])
        quads = {number: self._quads[number] for number in local}
        return {number: each.find_uncertain(local[number]) for number, each in quads.items() if each is not None}

    def are_free(self, uncertain: Uncertain, local: Mapping[int, Singles], shown: Floats) -> bool:
        """Is the surface free of intersections whichever diagonals Blender chooses for the uncertain quads?

        False may also mean that a triangle intersects which Blender does not show.

        Args:
            uncertain: result of `find_uncertain`.
            local: as there.
            shown: positions of the surface, (N, 3), free of intersections in the triangulation of the assembly.

        """
        flipping = {number: rows for number, rows in uncertain.items() if len(rows)}
        if not flipping:
            return True
        if self._check is None or not all(self._included[number][rows].all() for number, rows in flipping.items()):
            self._include(flipping, local)
        assert self._check is not None
        corners = np.concatenate([self._corners(number)[:, rows].ravel() for number, rows in flipping.items()])
        before = shown.copy()
        before[corners] = np.nextafter(before[corners], np.inf)  # only pairs with a vertex that moves are tested
        return self._check.is_end_free(before, shown)

    def _include(self, uncertain: Uncertain, local: Mapping[int, Singles]) -> None:
        """Include more quads: those that bend at present, and the uncertain ones."""
        added = [self._assembly.surface.triangles]
        for number, quads in self._quads.items():
            if quads is None:
                continue
            included = self._included.setdefault(number, np.zeros(quads.corners.shape[1], np.bool_))
            if number in local:
                included[quads.find_bent(local[number], BENT)] = True
                included[uncertain.get(number, np.empty(0, np.int32))] = True
            added.append(
                self._assembly.vertices(number)[quads.other_triangles(np.flatnonzero(included).astype(np.int32))]
            )
        self._check = stiv.StepCheck(self._surface(np.concatenate(added)), self._threads)

    def _surface(self, triangles: Indices) -> stiv.Surface:
        """The surface of the assembly with other triangles. A seam may merge corners of a quad: then it has fewer."""
        a, b, c = triangles.T
        old, distinct = self._assembly.surface, (a != b) & (b != c) & (c != a)
        ignored = [(int(first), int(second)) for first, second in old.ignored]
        return stiv.Surface(
            triangles[distinct], old.vertex_count, old.loose_edges, old.vertex_body, old.bodies, ignored
        )

    def _corners(self, number: int) -> Indices:
        """Vertices of the surface at the corners of the quads of a mesh, (4, k)."""
        quads = self._quads[number]
        assert quads is not None
        return np.asarray(self._assembly.vertices(number)[quads.corners])
