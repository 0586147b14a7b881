# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the faces at joints, which are not tested, that cut into each other at the end of a pose."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stiv.blender.controls.joint_regions import part_of
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.assembly import Assembly, Part
from stiv.blender.scene.torn_seams import cutting_triangles


def fold_note(
    assembly: Assembly, surfaces: Sequence[int], untested: frozenset[tuple[Part, Part]], q: Floats, threads: int = 0
) -> str:
    """The message on untested faces that cut into each other at positions `q`, (N, 3), and did not at the start.

    "" if there are none. surfaces: numbers of the meshes that bones bend. untested: pairs of their parts.
    """
    for evaluation in dict.fromkeys(assembly.meshes[number].read_from for number in surfaces):
        numbers = [number for number in surfaces if assembly.meshes[number].read_from == evaluation]
        found = _folds(assembly, numbers, untested, q, threads)
        folded = found and found - _folds(assembly, numbers, untested, assembly.positions, threads)
        if folded:
            faces = sorted(frozenset().union(*folded))
            return f"{faces[0][0]}: {len(faces):,} faces at joints cut into each other"
    return ""


_Face = tuple[str, int]  # object and number


def _folds(
    assembly: Assembly, numbers: Sequence[int], untested: frozenset[tuple[Part, Part]], q: Floats, threads: int
) -> set[frozenset[_Face]]:
    """Pairs of faces that intersect at positions `q`, (N, 3), in parts of meshes that are not tested."""
    if not untested:
        return set()
    whole: dict[str, _Whole] = {}
    for number in numbers:
        whole.setdefault(assembly.meshes[number].owner.name, _Whole()).add(assembly, number, q)
    points, corners, faces, first = [], [], [], 0
    for name, each in whole.items():
        points.append(each.points())
        corners.append(np.concatenate(each.corners) + first)
        faces += [(name, part, face) for part, own in each.faces for face in own.tolist()]
        first += len(points[-1])
    pairs = cutting_triangles(np.concatenate(points), np.concatenate(corners).astype(np.int32), threads)
    found = set()
    for i, j in pairs.tolist():
        (name, part, face), (other, other_part, other_face) = faces[i], faces[j]
        both = part, other_part
        if (name, face) != (other, other_face) and (both in untested or both[::-1] in untested):
            found.add(frozenset({(name, face), (other, other_face)}))
    return found


class _Whole:
    """A divided mesh as one again: vertices that parts share are one, as in Blender's mesh."""

    def __init__(self) -> None:
        self.corners: list[Indices] = []
        self.faces: list[tuple[Part, Indices]] = []
        self._rows: list[Indices] = []
        self._points: list[Floats] = []

    def add(self, assembly: Assembly, number: int, q: Floats) -> None:
        """Add a part at positions `q`, (N, 3)."""
        mesh = assembly.meshes[number]
        rows = np.arange(len(mesh.local), dtype=np.int32) if mesh.cropped is None else mesh.cropped.vertices
        self._rows.append(rows)
        self._points.append(q[assembly.vertices(number)])
        self.corners.append(rows[mesh.triangles])
        self.faces.append((part_of(mesh, mesh.part), mesh.faces))

    def points(self) -> Floats:
        """All vertices, (n, 3), also those without faces."""
        rows, points = np.concatenate(self._rows), np.concatenate(self._points)
        found = np.tile(points[:1], (int(rows.max(initial=-1)) + 1, 1))
        found[rows] = points
        return found
