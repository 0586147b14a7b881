# SPDX-License-Identifier: GPL-3.0-or-later
"""Splits faces into given triangles, so that Blender cannot flip them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

import bmesh
import bpy
import numpy as np

from stiv.blender.scene.arrays import Indices
from stiv.blender.scene.mesh_reading import read_triangles


def flipped_faces(mesh: bpy.types.Mesh, triangles: Indices) -> Indices:
    """Faces whose present triangulation differs from the given triangles, (f, 3); ascending."""
    present, faces = read_triangles(mesh)
    different = (np.sort(present, axis=1) != np.sort(triangles, axis=1)).any(axis=1)
    return np.unique(faces[different])


def split_faces(mesh: bpy.types.Mesh, faces: Iterable[int], triangles: Indices, face_of: Indices) -> None:
    """Split faces along the diagonals of their triangles; vertices keep their numbers, faces get new ones.

    triangles: (f, 3) of the whole mesh; face_of: face of each, (f,). UVs, materials and attributes stay.
    """
    chosen = list(faces)
    corners: dict[int, list[Indices]] = defaultdict(list)
    for row in np.flatnonzero(np.isin(face_of, chosen)):
        corners[int(face_of[row])].append(triangles[row])
    edited = bmesh.new()
    edited.from_mesh(mesh)
    edited.verts.ensure_lookup_table()
    edited.faces.ensure_lookup_table()
    for face, rows in {edited.faces[number]: corners[number] for number in chosen}.items():
        _split(edited, face, rows)
    edited.to_mesh(mesh)
    edited.free()
    mesh.update()


def _split(edited: bmesh.types.BMesh, face: bmesh.types.BMFace, triangles: list[Indices]) -> None:
    sides = {frozenset(vertex.index for vertex in edge.verts) for edge in face.edges}
    drawn = {frozenset((int(row[k]), int(row[k - 1]))) for row in triangles for k in range(3)}
    pieces = [face]
    for one, other in (sorted(diagonal) for diagonal in sorted(drawn - sides, key=sorted)):
        ends = edited.verts[one], edited.verts[other]
        piece = next(each for each in pieces if all(end in each.verts for end in ends))
        pieces.append(bmesh.utils.face_split(piece, *ends)[0])
