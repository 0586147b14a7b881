# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangulation flips of bent faces, and surfaces with several triangulations of a face.

Blender splits a quad along its first diagonal unless the halves would face away from each other; polygons depend on
their shape. A surface free of intersections in its first triangulation may therefore intersect in the one that Blender
shows. Quads close to a flip keep both triangulations free from the start; others from the first flip on.
"""

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.elements import Element
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.mesh_reading import evaluated_mesh, read_triangles
from stiv.blender.scene.near_assembly import near_assembly
from stiv.blender.scene.open_evaluations import OpenEvaluations

BENT = 0.7  # cosine of the angle between the halves of a quad; below it both triangulations are kept free


@dataclass(frozen=True)
class FaceTriangles:
    """Additional triangles of faces of one mesh.

    Attributes:
        mesh: number of the mesh in the assembly.
        triangles: vertices of the mesh, (f, 3).
        faces: face of each triangle, (f,).
    """

    mesh: int
    triangles: Indices
    faces: Indices

    def limited_to(self, rows: NDArray[np.bool_]) -> "FaceTriangles":
        """Some of the triangles, (f,)."""
        return FaceTriangles(self.mesh, self.triangles[rows], self.faces[rows])


@dataclass(frozen=True)
class CurrentTriangulation:
    """All present triangles of one mesh, and those that the assembly does not include."""

    all: FaceTriangles
    new: FaceTriangles


def find_flips(
    context: bpy.types.Context,
    assembly: Assembly,
    opened: OpenEvaluations | None = None,
    certain: Callable[[int], bool] = lambda number: False,
) -> tuple[CurrentTriangulation, ...]:
    """Find the meshes whose present triangulation has triangles that the assembly does not include.

    opened: the evaluations from which the meshes were read; None for the one shown now. certain: whether the mesh with
    a number certainly has its first triangulation, so that it is not read.

    Only deformable bodies change their shape, and thus their triangulation.
    """
    source = opened or OpenEvaluations(context)
    flips = []
    for number, mesh in enumerate(assembly.meshes):
        if not is_deformable(assembly, number) or certain(number):
            continue
        with evaluated_mesh(source.evaluated(mesh.read_from, mesh.owner)) as evaluated:
            triangles, faces = mesh.own_triangles(*read_triangles(evaluated))
        flip = FaceTriangles(number, triangles, faces)
        new = _new_rows(triangles, mesh.triangles)
        if new.any():
            flips.append(CurrentTriangulation(flip, flip.limited_to(new)))
    return tuple(flips)


def with_current_triangulation(assembly: Assembly, flips: Sequence[CurrentTriangulation]) -> Assembly:
    """The assembly with Blender's present triangulation; meshes without one given are unchanged."""
    meshes = list(assembly.meshes)
    for flip in flips:
        meshes[flip.all.mesh] = replace(meshes[flip.all.mesh], triangles=flip.all.triangles, faces=flip.all.faces)
    return _retriangulated(assembly, meshes, [])


def add_triangles(assembly: Assembly, flips: Sequence[FaceTriangles]) -> Assembly:
    """The assembly with additional triangles."""
    meshes, flip_faces = list(assembly.meshes), []
    for flip in flips:
        meshes[flip.mesh] = _extend(meshes[flip.mesh], flip)
        place = assembly.vertices(flip.mesh)
        flip_faces += [np.unique(place[corners]).tolist() for corners in _corners(meshes[flip.mesh], flip)]
    return _retriangulated(assembly, meshes, flip_faces)


def guard_bent_quads(assembly: Assembly, threads: int = 0) -> Assembly:
    """Add the second triangulation of strongly bent quads of deformable meshes, if it is free of intersections now."""
    flips = [flip for number in range(len(assembly.meshes)) if (flip := _bent_quads(assembly, number)) is not None]
    while flips:
        extended = add_triangles(assembly, flips)
        near = near_assembly(extended, extended.positions)
        pairs = stiv.find_intersections(near.assembly.positions, near.assembly.surface, threads=threads)
        if len(pairs) == 0:
            return extended
        intersecting = {face for pair in near.assembly.face_pairs(pairs)[0] for face in (pair.first, pair.second)}
        left = [flip for each in flips if len((flip := _drop_intersecting(each, intersecting, assembly)).faces)]
        if sum(len(flip.faces) for flip in left) == sum(len(flip.faces) for flip in flips):
            return extended  # other faces intersect; the session reports them
        flips = left
    return assembly


def _bent_quads(assembly: Assembly, number: int) -> FaceTriangles | None:
    """The second triangulation of each strongly bent quad of a mesh."""
    if not is_deformable(assembly, number):
        return None
    mesh, q = assembly.meshes[number], assembly.positions[assembly.vertices(number)]
    first = np.flatnonzero(mesh.faces[:-1] == mesh.faces[1:])
    if len(first) == 0:
        return None
    counts = np.bincount(mesh.faces) if len(mesh.faces) else np.empty(0, int)
    first = first[counts[mesh.faces[first]] == 2]
    one, two = _normals(q, mesh.triangles[first]), _normals(q, mesh.triangles[first + 1])
    first = first[_dots(one, two) < BENT * np.sqrt(_dots(one, one) * _dots(two, two))]
    if len(first) == 0:
        return None
    other = _other_cuts(mesh.triangles[first], mesh.triangles[first + 1])
    return FaceTriangles(number, other, np.repeat(mesh.faces[first], 2))


def _normals(q: Floats, triangles: Indices) -> Floats:
    """Normals of triangles, (k, 3), twice as long as their areas."""
    a, b, c = (q.take(triangles[:, k], axis=0) for k in range(3))
    return np.asarray(np.cross(b - a, c - a))


def _dots(a: Floats, b: Floats) -> Floats:
    """Dot products of rows."""
    return np.asarray(np.einsum("ij,ij->i", a, b))


def _other_cuts(one: Indices, two: Indices) -> Indices:
    """The triangles, (2 k, 3), of quads split along their other diagonals. one, two: their halves, (k, 3)."""
    rows, equal = np.arange(len(one)), one[:, :, None] == two[:, None, :]
    tip, other = equal.any(axis=2).argmin(axis=1), equal.any(axis=1).argmin(axis=1)
    a, b, c = (one[rows, (tip + k) % 3] for k in range(3))
    far = two[rows, other]
    return np.stack([a, b, far, a, far, c], axis=1).reshape(-1, 3).astype(np.int32)


def _drop_intersecting(flip: FaceTriangles, intersecting: Collection[Element], assembly: Assembly) -> FaceTriangles:
    mesh = assembly.meshes[flip.mesh]
    return flip.limited_to(
        np.array(
            [
                Element(mesh.owner.name, "face", int(face), mesh.read_from, mesh.part) not in intersecting
                for face in flip.faces
            ]
        )
    )


def _retriangulated(assembly: Assembly, meshes: Sequence[VisibleMesh], flip_faces: Sequence[Sequence[int]]) -> Assembly:
    old = assembly.surface
    triangles = assembly.renumbered_triangles(meshes)
    ignored = [(int(a), int(b)) for a, b in old.ignored]
    surface = stiv.Surface(
        triangles, old.vertex_count, old.loose_edges, old.vertex_body, old.bodies, ignored,
        [*old.flip_faces, *flip_faces],
    )  # fmt: skip
    return replace(assembly, meshes=tuple(meshes), surface=surface)


def _extend(mesh: VisibleMesh, flip: FaceTriangles) -> VisibleMesh:
    return replace(
        mesh, triangles=np.concatenate([mesh.triangles, flip.triangles]), faces=np.concatenate([mesh.faces, flip.faces])
    )


def _corners(mesh: VisibleMesh, flip: FaceTriangles) -> Iterator[Indices]:
    rows = np.flatnonzero(np.isin(mesh.faces, flip.faces))
    rows = rows[np.argsort(mesh.faces[rows], kind="stable")]
    if len(rows) == 0:
        return
    _, firsts = np.unique(mesh.faces[rows], return_index=True)
    yield from map(np.unique, np.split(mesh.triangles[rows], firsts[1:]))


def is_deformable(assembly: Assembly, mesh: int) -> bool:
    """Can the mesh change its shape?"""
    surface, start = assembly.surface, int(assembly.starts[mesh])
    return start < surface.vertex_count and surface.bodies[surface.vertex_body[start]].mobility == "deformable"


def _new_rows(present: Indices, held: Indices) -> NDArray[np.bool_]:
    """Flags of the present triangles that are not in `held`, which begins with the first triangulation, in order."""
    start, added = held[: len(present)], held[len(present) :]
    new = np.array((present != start).any(axis=1), np.bool_)
    known = {tuple(row) for row in np.sort(np.concatenate([start[new], added])).tolist()}
    new[new] = [tuple(row) not in known for row in np.sort(present[new]).tolist()]
    return new
