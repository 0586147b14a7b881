# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact test of a whole scene, as Blender evaluates it."""

from collections.abc import Callable, Collection
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from stiv.blender.controls.loop_objects import cages_shown_by_others
from stiv.blender.scene.arrays import Indices
from stiv.blender.scene.assembly import Assembly, assemble_joined
from stiv.blender.scene.evaluated_scene import read_scene
from stiv.blender.scene.exclusions import Exclusions
from stiv.blender.scene.guarded_evaluations import read_guarded_scene
from stiv.blender.settings import EditSettings
from stiv.blender.verify.left_out import find_left_out
from stiv.blender.verify.verification import FacePair, named_pairs
from stiv.checks.findings import Untested
from stiv.edge_contacts import edge_contacts
from stiv.seams import seam_pairs


@dataclass(frozen=True)
class SceneCheck:
    """What was found. `pairs` is empty for a scene free of intersections.

    Attributes:
        pairs: faces that meet, each pair once; a loose edge or vertex that meets a face comes with that face as the
            second.
        objects, triangles: how many were tested.
        guard: what was tested: the "viewport", the "render" or "both".
        reason: why the render was left out although it differs; empty otherwise.
        hidden: objects with a surface that are hidden or excluded, and were not.
        left_out: objects that were not tested, with the reason.
        seams: pairs of faces of one object that touch in coincident vertices or edges alone: one surface there.
    """

    pairs: tuple[FacePair, ...]
    objects: int
    triangles: int
    hidden: int
    seams: int = 0
    guard: str = "viewport"
    reason: str = ""
    left_out: tuple[Untested, ...] = ()

    @property
    def triangle_pairs(self) -> int:
        """How many pairs of triangles meet; a face may have several."""
        return sum(pair.triangle_pairs for pair in self.pairs)


def read_surface(context: bpy.types.Context, objects: Collection[str] | None = None) -> Assembly:
    """All visible meshes, or those of the objects named, as one surface in world space; every body deformable.

    A cage that another object shows counts only if it is named. Raises InputError naming object and vertex when a
    coordinate is not finite.
    """
    scene = read_scene(context, counted_names(context, EditSettings(), objects))
    return assemble_joined(scene.meshes)


def check_scene(
    context: bpy.types.Context,
    settings: EditSettings | None = None,
    objects: Collection[str] | None = None,
    strands: bool = True,
) -> SceneCheck:
    """Find every intersection of the visible scene, among obstacles and within objects too.

    settings: objects in the role "ignored" and ignored pairs are left out. objects: names to be limited to. A cage that
    another object shows counts only if it is named. strands: also test hair and curves without surface.
    """
    settings = settings or EditSettings()
    scene, guard = read_guarded_scene(context, settings, counted_names(context, settings, objects), strands=strands)
    assembly = assemble_joined(scene.meshes, settings.ignored_pairs)
    pairs, seams = find_pairs_and_seams(assembly, settings.threads)
    names = {mesh.owner.name for mesh in assembly.meshes}
    count = sum(len(faces) for _, faces in seams)
    triangles = sum(len(mesh.triangles) for mesh in assembly.meshes if mesh.strands is None)
    left_out = find_left_out(context, names, objects or ())
    return SceneCheck(pairs, len(names), triangles, scene.hidden, count, guard.choice, guard.reason, left_out)


def exclusions_now(
    context: bpy.types.Context, settings: EditSettings | None = None
) -> tuple[Exclusions, tuple[FacePair, ...]]:
    """All pairs of faces that meet, to be excluded from edits, and the pairs that cannot be: with loose elements."""
    chosen = settings or EditSettings()
    scene, _ = read_guarded_scene(context, chosen, counted_names(context, chosen), strands=True)
    assembly = assemble_joined(scene.meshes, chosen.ignored_pairs)
    pairs = find_pairs(assembly, chosen.threads)
    excluded = Exclusions.of(pairs, scene.meshes)
    return excluded, excluded.others(pairs)


def counted_names(
    context: bpy.types.Context, settings: EditSettings, objects: Collection[str] | None = None
) -> Callable[[str], bool]:
    """Tells by its name whether an object is tested."""
    cages = cages_shown_by_others(context)

    def is_counted(name: str) -> bool:
        return settings.takes_part(name) and (name not in cages if objects is None else name in objects)

    return is_counted


def find_pairs(assembly: Assembly, threads: int = 0) -> tuple[FacePair, ...]:
    """All pairs that meet where bodies of the assembly meet, at the positions it was read in; no seams."""
    return find_pairs_and_seams(assembly, threads)[0]


def find_pairs_and_seams(
    assembly: Assembly, threads: int = 0
) -> tuple[tuple[FacePair, ...], list[tuple[str, Indices]]]:
    """The pairs that meet, and for each mesh its object's name and the pairs of its faces, (k, 2), on seams alone."""
    meeting = stiv.find_intersections(assembly.positions, assembly.surface, threads=threads)
    contacts = _edge_contacts(assembly, meeting)
    pairs = named_pairs(assembly, assembly.positions, threads, meeting[~contacts])
    intersecting = {(pair.first.object, *sorted((pair.first.number, pair.second.number))) for pair in pairs}
    seams = []
    for number, (mesh, joins) in enumerate(zip(assembly.meshes, assembly.seams, strict=True)):
        touching = mesh.faces[_own_triangles(assembly, number, meeting[contacts])]
        touching = np.sort(touching[touching[:, 0] != touching[:, 1]], axis=1)
        faces = np.concatenate([seam_pairs(joins, mesh.triangles, mesh.faces), touching])
        if len(touching):
            faces = np.unique(faces, axis=0)
        if intersecting:
            apart = [(mesh.owner.name, a, b) not in intersecting for a, b in faces.tolist()]
            faces = faces[np.array(apart, np.bool_)]
        seams.append((mesh.owner.name, faces))
    return pairs, seams


def _edge_contacts(assembly: Assembly, meeting: Indices) -> NDArray[np.bool_]:
    """Which pairs of triangles, (k,), are of one mesh and touch in edges alone, in the mesh's own coordinates."""
    contacts = np.zeros(len(meeting), np.bool_)
    for number, mesh in enumerate(assembly.meshes):
        inside = _is_inside(assembly, number, meeting)
        if inside.any():
            own = _own_triangles(assembly, number, meeting[inside])
            contacts[inside] = edge_contacts(mesh.local, mesh.triangles, own)
    return contacts


def _is_inside(assembly: Assembly, mesh: int, pairs: Indices) -> NDArray[np.bool_]:
    first = sum(len(each.triangles) for each in assembly.meshes[:mesh])
    end = first + len(assembly.meshes[mesh].triangles)
    return np.asarray(((pairs >= first) & (pairs < end)).all(axis=1), np.bool_)


def _own_triangles(assembly: Assembly, mesh: int, pairs: Indices) -> Indices:
    """Those among pairs of triangles of the assembly whose both are of a mesh, by their numbers in it."""
    first = sum(len(each.triangles) for each in assembly.meshes[:mesh])
    own: Indices = pairs[_is_inside(assembly, mesh, pairs)] - np.int32(first)
    return own
