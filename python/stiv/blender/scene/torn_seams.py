# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces of one object that cut each other at the end of an edit, although they only touched along a seam at its start.

Edits do not test such faces, because they touch, unless the seam stays closed.
"""

from __future__ import annotations

import numpy as np

import stiv
from stiv.blender.excluded_faces import Exclusions
from stiv.blender.scene.arrays import Floats, Indices, pair_codes
from stiv.blender.scene.assembly import ROUNDING, Assembly
from stiv.blender.scene.elements import Element, FacePair, count_faces
from stiv.blender.scene.exclusions import excluded_within
from stiv.blender.scene.message_fitting import fit_message
from stiv.blender.scene.triangulation_flips import is_deformable
from stiv.seams import find_seams, seam_pairs

_Faces = frozenset[int]


def torn_seam_note(assembly: Assembly, excluded: Exclusions, q: Floats, threads: int = 0) -> str:
    """The message on excluded faces at seams that cut each other at positions `q`, (N, 3), and did not at the start.

    "" if there are none.
    """
    found: dict[str, list[FacePair]] = {}
    for number, mesh in enumerate(assembly.meshes):
        for faces in _cuts_at_seams(assembly, number, excluded, q, threads):
            first, second = (Element(mesh.owner.name, "face", face, mesh.read_from, mesh.part) for face in faces)
            found.setdefault(mesh.owner.name, []).append(FacePair(first, second))
    return next((_message(name, count_faces(pairs)) for name, pairs in found.items()), "")


def _message(name: str, count: int) -> str:
    return fit_message("{}" + f": {count:,} faces at torn seams cut each other; use Merge by Distance", name)


def self_cuts(points: Floats, corners: Indices, faces: Indices, threads: int = 0) -> set[_Faces]:
    """Pairs of faces that intersect. Vertices that coincide count as one, as in checks.

    points: (n, 3). corners: of triangles, (f, 3). faces: of the triangles, (f,).
    """
    found = faces[cutting_triangles(points, corners, threads)]
    return {frozenset((a, b)) for a, b in found.tolist() if a != b}


def cutting_triangles(points: Floats, corners: Indices, threads: int = 0) -> Indices:
    """Pairs of triangles that intersect, (k, 2). Vertices that coincide count as one, as in checks.

    points: (n, 3). corners: of triangles, (f, 3).
    """
    seams = find_seams(points, corners, ROUNDING)
    joined = corners if seams is None else seams.leaders[corners]
    proper = np.flatnonzero((joined != np.roll(joined, 1, axis=1)).all(axis=1)).astype(np.int32)
    found: Indices = proper[stiv.find_intersections(points, joined[proper], threads=threads).reshape(-1, 2)]
    return found


def _cuts_at_seams(assembly: Assembly, number: int, excluded: Exclusions, q: Floats, threads: int) -> set[_Faces]:
    """Pairs of excluded faces of a mesh that touch along a seam at the start, and newly cut each other."""
    mesh = assembly.meshes[number]
    if not is_deformable(assembly, number) or not len(pairs := excluded_within(excluded, mesh)):
        return set()
    rows = np.isin(mesh.faces, pairs)
    first, last = assembly.starts[number : number + 2].tolist()
    corners, faces = assembly.vertices(number)[mesh.triangles[rows]] - np.int32(first), mesh.faces[rows]
    start = assembly.positions[first:last]
    touching = seam_pairs(find_seams(start, corners, ROUNDING), corners, faces)
    at_seams = set(map(frozenset, touching[np.isin(pair_codes(touching), pair_codes(pairs))].tolist()))
    cut = at_seams & self_cuts(q[first:last], corners, faces, threads) if at_seams else set()
    return cut - self_cuts(start, corners, faces, threads) if cut else set()
