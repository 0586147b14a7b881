# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact test of a whole scene as Blender evaluates it."""

from collections.abc import Callable, Collection
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from stiv.blender.excluded_faces import Exclusions
from stiv.blender.scene.arrays import Indices, pair_codes
from stiv.blender.scene.assembly import Assembly, assemble, assemble_with_seams
from stiv.blender.scene.elements import FacePairs
from stiv.blender.scene.evaluated_scene import read_scene
from stiv.blender.scene.evaluations import find_replaced_cages
from stiv.blender.scene.exclusions import exclude, without_excluded
from stiv.blender.scene.face_pairs import find_face_pairs
from stiv.blender.scene.guarded_evaluations import read_guarded_scene
from stiv.blender.settings import EditSettings
from stiv.blender.verify.untested import find_untested
from stiv.checks.findings import Untested
from stiv.edge_contacts import edge_contacts
from stiv.seams import seam_pairs


@dataclass(frozen=True)
class SceneCheck:
    """The result of the test. `pairs` is empty if the scene is free of intersections.

    Attributes:
        pairs: intersecting pairs of faces without duplicates; of a loose edge or vertex and a face, the face is second.
        objects, triangles: numbers of tested objects and triangles.
        guard: the tested evaluations: "viewport", "render" or "both".
        reason: why a render that differs was left out; "" otherwise.
        hidden: number of hidden or excluded objects with a surface, which were not tested.
        untested: objects that were not tested, with the reason.
        seams: number of pairs of faces of one object that touch only in coincident vertices or edges.
    """

    pairs: FacePairs
    objects: int
    triangles: int
    hidden: int
    seams: int = 0
    guard: str = "viewport"
    reason: str = ""
    untested: tuple[Untested, ...] = ()

    @property
    def triangle_pairs(self) -> int:
        """Number of intersecting pairs of triangles; a pair of faces may have several."""
        return int(self.pairs.triangle_pairs.sum())


def read_surface(context: bpy.types.Context, objects: Collection[str] | None = None) -> Assembly:
    """Read all visible meshes, or those of the named objects, as one surface in world space; all bodies are deformable.

    A cage that another object shows is read only if it is named. Raises InputError naming object and vertex if a
    coordinate is not finite.
    """
    scene = read_scene(context, tested_names(context, EditSettings(), objects))
    return assemble_with_seams(scene.meshes)


def check_scene(
    context: bpy.types.Context,
    settings: EditSettings | None = None,
    objects: Collection[str] | None = None,
    strands: bool = True,
) -> SceneCheck:
    """Find every intersection of the visible scene, also between obstacles and within objects.

    settings: objects with the role "ignored" and ignored pairs are left out. objects: names to test. A cage that
    another object shows is tested only if it is named. strands: also test hair and curves without surface.
    """
    settings = settings or EditSettings()
    scene, guard = read_guarded_scene(context, settings, tested_names(context, settings, objects), strands=strands)
    assembly = assemble_with_seams(scene.meshes, settings.ignored_pairs)
    pairs, seams = find_pairs_and_seams(assembly, settings.threads)
    names = {mesh.owner.name for mesh in assembly.meshes}
    count = sum(len(faces) for _, faces in seams)
    triangles = sum(len(mesh.triangles) for mesh in assembly.meshes if mesh.strands is None)
    untested = find_untested(context, names, objects or ())
    return SceneCheck(pairs, len(names), triangles, scene.hidden, count, guard.choice, guard.reason, untested)


def find_exclusions(context: bpy.types.Context, settings: EditSettings | None = None) -> tuple[Exclusions, FacePairs]:
    """All intersecting pairs of faces as exclusions, and the pairs that cannot be excluded."""
    chosen = settings or EditSettings()
    scene, _ = read_guarded_scene(context, chosen, tested_names(context, chosen), strands=True)
    assembly = assemble_with_seams(scene.meshes, chosen.ignored_pairs)
    pairs = find_pairs(assembly, chosen.threads)
    excluded = exclude(pairs, scene.meshes)
    return excluded, without_excluded(pairs, excluded)


def tested_names(
    context: bpy.types.Context, settings: EditSettings, objects: Collection[str] | None = None
) -> Callable[[str], bool]:
    """A predicate for the names of tested objects."""
    cages = find_replaced_cages(context)

    def is_counted(name: str) -> bool:
        return settings.participates(name) and (name not in cages if objects is None else name in objects)

    return is_counted


def find_pairs(assembly: Assembly, threads: int = 0, most: int = 0) -> FacePairs:
    """All intersecting pairs between bodies of the assembly, without seams.

    most: number of triangle pairs to name for each two meshes; 0: all.
    """
    return name_pairs(assembly, find_triangle_pairs(assembly, threads), threads, most)


def find_triangle_pairs(assembly: Assembly, threads: int = 0) -> Indices:
    """All intersecting pairs of triangles, (k, 2), without seams."""
    found = stiv.find_intersections(assembly.positions, assembly.surface, threads=threads)
    chosen: Indices = found[~_edge_contacts(assembly, found)]
    return chosen


def name_pairs(assembly: Assembly, triangles: Indices, threads: int = 0, most: int = 0) -> FacePairs:
    """The pairs of elements of those of triangles, (k, 2), and of loose edges and vertices. most: see `find_pairs`."""
    chosen = _first_of_each(assembly, triangles, most) if most else triangles
    return find_face_pairs(assembly, assembly.positions, threads, chosen)


def _first_of_each(assembly: Assembly, pairs: Indices, most: int) -> Indices:
    """The first pairs of triangles, (k, 2), of each two meshes."""
    mesh = meshes_of(assembly, pairs)
    keys = mesh[:, 0] * len(assembly.meshes) + mesh[:, 1]
    order = np.argsort(keys, kind="stable")
    rank = np.arange(len(order)) - np.searchsorted(keys[order], keys[order])
    return np.asarray(pairs[np.sort(order[rank < most])], np.int32)


def find_pairs_and_seams(assembly: Assembly, threads: int = 0) -> tuple[FacePairs, list[tuple[str, Indices]]]:
    """The intersecting pairs; for each mesh, its object and the pairs of faces, (k, 2), that touch only on seams."""
    intersecting_triangles = stiv.find_intersections(assembly.positions, assembly.surface, threads=threads)
    contacts = _edge_contacts(assembly, intersecting_triangles)
    pairs = find_face_pairs(assembly, assembly.positions, threads, intersecting_triangles[~contacts])
    among = pairs.by_objects()
    seams = []
    own, none = _own_triangles(assembly, intersecting_triangles[contacts]), np.empty((0, 2), np.int32)
    for number, (mesh, joins) in enumerate(zip(assembly.meshes, assembly.seams, strict=True)):
        touching = mesh.faces[own.get(number, (none, none))[1]]
        touching = np.sort(touching[touching[:, 0] != touching[:, 1]], axis=1)
        faces = np.concatenate([seam_pairs(joins, mesh.triangles, mesh.faces), touching])
        if len(touching):
            faces = np.unique(faces, axis=0)
        if (cut := among.get((mesh.owner.name, mesh.owner.name))) is not None:
            numbers = cut.number[cut.where(lambda first, second: first.kind == second.kind == "face")]
            faces = faces[~np.isin(pair_codes(faces), pair_codes(numbers))]
        seams.append((mesh.owner.name, faces))
    return pairs, seams


def _edge_contacts(assembly: Assembly, intersecting_triangles: Indices) -> NDArray[np.bool_]:
    """Flags the pairs of triangles, (k,), of one mesh that touch only in edges, in the mesh's own coordinates."""
    contacts = np.zeros(len(intersecting_triangles), np.bool_)
    for number, (rows, own) in _own_triangles(assembly, intersecting_triangles).items():
        mesh = assembly.meshes[number]
        contacts[rows] = edge_contacts(mesh.local, mesh.triangles, own)
    return contacts


def _own_triangles(assembly: Assembly, pairs: Indices) -> dict[int, tuple[Indices, Indices]]:
    """For each mesh with pairs inside it: their rows, and the pairs with triangle numbers of the mesh."""
    mesh = meshes_of(assembly, pairs)
    rows = np.flatnonzero(mesh[:, 0] == mesh[:, 1]).astype(np.int32)
    rows = rows[np.argsort(mesh[rows, 0], kind="stable")]
    numbers, firsts = np.unique(mesh[rows, 0], return_index=True)
    starts = np.cumsum([0, *(len(each.triangles) for each in assembly.meshes)]).astype(np.int32)
    groups = zip(numbers.tolist(), np.split(rows, firsts[1:]), strict=False)
    return {number: (group, pairs[group] - starts[number]) for number, group in groups}


def meshes_of(assembly: Assembly, pairs: Indices) -> NDArray[np.int64]:
    """The number of the mesh of each triangle in pairs, (k, 2)."""
    return np.repeat(np.arange(len(assembly.meshes)), [len(each.triangles) for each in assembly.meshes])[pairs]


def nearest_pair(context: bpy.types.Context, settings: EditSettings | None = None) -> stiv.LeastDistance | None:
    """Nearest triangles of different visible objects; None if there are fewer than two objects.

    settings: objects with the role "ignored" and ignored pairs are left out. Raises InputError for coordinates that are
    not finite.
    """
    settings = settings or EditSettings()
    scene = read_scene(context, settings.participates)
    assembly = assemble(scene.meshes, ["deformable"] * len(scene.meshes), (), settings.ignored_pairs)
    return stiv.least_distance(assembly.positions, assembly.surface)
