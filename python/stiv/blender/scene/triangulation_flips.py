# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that Blender cuts into other triangles as they bend, and surfaces that hold more than one cut of them.

Blender cuts a quad along its first diagonal unless the halves would face away from each other, and polygons as their
shape wants it. A surface that is free in the cut of the start can therefore meet something in the one that Blender
shows. Quads that are near that point keep both cuts free from the start; others get their second cut when it is seen.
"""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from stiv.blender.scene.arrays import Indices
from stiv.blender.scene.assembly import Assembly, Element
from stiv.blender.scene.evaluated_scene import Opened, VisibleMesh
from stiv.blender.scene.mesh_reading import evaluated_mesh, read_triangles

BENT = 0.7  # cosine of the angle between the halves of a quad from which both cuts are kept free


@dataclass(frozen=True)
class Cut:
    """More triangles of faces of one mesh.

    Attributes:
        mesh: number of the mesh in the assembly.
        triangles: (f, 3) vertices of the mesh.
        faces: the face that each cuts, (f,).
    """

    mesh: int
    triangles: Indices
    faces: Indices

    def limited_to(self, rows: NDArray[np.bool_]) -> "Cut":
        """Some of the triangles, (f,)."""
        return Cut(self.mesh, self.triangles[rows], self.faces[rows])


@dataclass(frozen=True)
class PresentCut:
    """Blender's present triangles of one mesh of an assembly, and those of them that the assembly does not hold."""

    all: Cut
    fresh: Cut


def fresh_cuts(context: bpy.types.Context, assembly: Assembly, opened: Opened | None = None) -> tuple[PresentCut, ...]:
    """Blender's present triangles of the meshes that show some which the assembly does not hold.

    opened: the evaluations that its meshes were read from; None: what is shown now.

    Only deformable bodies change their shape, and so their cuts.
    """
    source = opened or Opened(context)
    cuts = []
    for number, mesh in enumerate(assembly.meshes):
        if not _is_deformable(assembly, number):
            continue
        with evaluated_mesh(source.evaluated(mesh.read_in, mesh.owner)) as evaluated:
            triangles, faces = read_triangles(evaluated)
        cut = Cut(number, triangles, faces)
        fresh = _fresh_rows(triangles, mesh.triangles)
        if fresh.any():
            cuts.append(PresentCut(cut, cut.limited_to(fresh)))
    return tuple(cuts)


def as_shown(assembly: Assembly, cuts: Sequence[PresentCut]) -> Assembly:
    """The assembly as Blender cuts it now; meshes without a cut of their own stay as they are."""
    meshes = list(assembly.meshes)
    for cut in cuts:
        meshes[cut.all.mesh] = replace(meshes[cut.all.mesh], triangles=cut.all.triangles, faces=cut.all.faces)
    return _recut(assembly, meshes, [])


def with_cuts(assembly: Assembly, cuts: Sequence[Cut]) -> Assembly:
    """The assembly with more triangles besides those it holds."""
    meshes, recut_faces = list(assembly.meshes), []
    for cut in cuts:
        meshes[cut.mesh] = _extended(meshes[cut.mesh], cut)
        place = assembly.vertices(cut.mesh)
        recut_faces += [np.unique(place[corners]).tolist() for corners in _corners(meshes[cut.mesh], cut)]
    return _recut(assembly, meshes, recut_faces)


def with_bent_quads(assembly: Assembly, threads: int = 0) -> Assembly:
    """The assembly with both cuts of the quads of deformable meshes that are bent far, where both are free now."""
    cuts = [cut for number in range(len(assembly.meshes)) if (cut := _bent_quads(assembly, number)) is not None]
    while cuts:
        extended = with_cuts(assembly, cuts)
        pairs = stiv.find_intersections(assembly.positions, extended.surface, threads=threads)
        if len(pairs) == 0:
            return extended
        meeting = {each for pair in pairs for each in map(extended.face, pair.tolist())}
        left = [cut for each in cuts if len((cut := _without(each, meeting, assembly)).faces)]
        if sum(len(cut.faces) for cut in left) == sum(len(cut.faces) for cut in cuts):
            return extended  # others meet, which is for the session to refuse
        cuts = left
    return assembly


def _bent_quads(assembly: Assembly, number: int) -> Cut | None:
    """The other cut of each bent quad of a mesh."""
    if not _is_deformable(assembly, number):
        return None
    mesh, q = assembly.meshes[number], assembly.positions[assembly.vertices(number)]
    first = np.flatnonzero(mesh.faces[:-1] == mesh.faces[1:])
    counts = np.bincount(mesh.faces) if len(mesh.faces) else np.empty(0, int)
    first = first[counts[mesh.faces[first]] == 2]
    a, b, c = (q[mesh.triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    length = np.linalg.norm(normals, axis=1)
    dots = (normals[first] * normals[first + 1]).sum(axis=1)
    first = first[dots < BENT * length[first] * length[first + 1]]
    if len(first) == 0:
        return None
    other = np.concatenate([_other_cut(mesh.triangles[row], mesh.triangles[row + 1]) for row in first])
    return Cut(number, other, np.repeat(mesh.faces[first], 2))


def _other_cut(one: Indices, two: Indices) -> Indices:
    """The two triangles, (2, 3), of a quad that is cut into these two."""
    tip = next(k for k in range(3) if one[k] not in two)
    far = next(vertex for vertex in two if vertex not in one)
    a, b, c = np.roll(one, -tip)
    return np.array([[a, b, far], [a, far, c]], np.int32)


def _without(cut: Cut, meeting: Collection[Element], assembly: Assembly) -> Cut:
    mesh = assembly.meshes[cut.mesh]
    return cut.limited_to(
        np.array([Element(mesh.owner.name, "face", int(face), mesh.read_in) not in meeting for face in cut.faces])
    )


def _recut(assembly: Assembly, meshes: Sequence[VisibleMesh], recut_faces: Sequence[Sequence[int]]) -> Assembly:
    old = assembly.surface
    triangles = assembly.shifted_triangles(meshes)
    ignored = [(int(a), int(b)) for a, b in old.ignored]
    surface = stiv.Surface(
        triangles, old.vertex_count, old.loose_edges, old.vertex_body, old.bodies, ignored,
        [*old.recut_faces, *recut_faces],
    )  # fmt: skip
    return replace(assembly, meshes=tuple(meshes), surface=surface)


def _extended(mesh: VisibleMesh, cut: Cut) -> VisibleMesh:
    return replace(
        mesh,
        triangles=np.concatenate([mesh.triangles, cut.triangles]),
        faces=np.concatenate([mesh.faces, cut.faces]),
    )


def _corners(mesh: VisibleMesh, cut: Cut) -> Iterator[Indices]:
    for face in np.unique(cut.faces):
        yield np.unique(mesh.triangles[mesh.faces == face])


def _is_deformable(assembly: Assembly, mesh: int) -> bool:
    surface, start = assembly.surface, int(assembly.starts[mesh])
    return start < surface.vertex_count and surface.bodies[surface.vertex_body[start]].mobility == "deformable"


def _fresh_rows(present: Indices, held: Indices) -> NDArray[np.bool_]:
    """Which present triangles are not held. Those held begin with the start's, in the same order of faces."""
    start, added = held[: len(present)], held[len(present) :]
    fresh = np.array((present != start).any(axis=1), np.bool_)
    known = {tuple(row) for row in np.sort(np.concatenate([start[fresh], added])).tolist()}
    fresh[fresh] = [tuple(row) not in known for row in np.sort(present[fresh]).tolist()]
    return fresh
