# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact test of a whole scene, as Blender evaluates it."""

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass

import bpy
import numpy as np

from stiv.blender.arrays import Indices
from stiv.blender.assembly import Assembly, assemble_joined
from stiv.blender.evaluated_scene import read_scene
from stiv.blender.exclusions import Exclusions
from stiv.blender.loop_objects import cages_shown_by_others
from stiv.blender.settings import EditSettings
from stiv.blender.verification import FacePair, named_pairs
from stiv.seams import seam_pairs


@dataclass(frozen=True)
class SceneCheck:
    """What was found. `pairs` is empty for a scene free of intersections.

    Attributes:
        pairs: faces that meet, each pair once; a loose edge or vertex that meets a face comes with that face as the
            second.
        objects, triangles: how many were tested.
        hidden: objects with a surface that are hidden or excluded, and were not.
        seams: pairs of faces of one object that touch in coincident vertices alone: they are one surface there.
    """

    pairs: tuple[FacePair, ...]
    objects: int
    triangles: int
    hidden: int
    seams: int = 0

    @property
    def triangle_pairs(self) -> int:
        """How many pairs of triangles meet; a face may have several."""
        return sum(pair.triangle_pairs for pair in self.pairs)


def read_surface(context: bpy.types.Context, objects: Collection[str] | None = None) -> Assembly:
    """All visible meshes, or those of the objects named, as one surface in world space; every body deformable.

    A cage that another object shows counts only if it is named. Raises InputError naming object and vertex when a
    coordinate is not finite.
    """
    scene = read_scene(context, _counted(context, EditSettings(), objects))
    return assemble_joined(scene.meshes)


def check_scene(
    context: bpy.types.Context, settings: EditSettings | None = None, objects: Collection[str] | None = None
) -> SceneCheck:
    """Find every intersection of the visible scene, among obstacles and within objects too.

    settings: objects in the role "ignored" and ignored pairs are left out. objects: names to be limited to. A cage that
    another object shows counts only if it is named.
    """
    settings = settings or EditSettings()
    scene = read_scene(context, _counted(context, settings, objects))
    assembly = assemble_joined(scene.meshes, settings.ignored_pairs)
    pairs = find_pairs(assembly, settings.threads)
    names = {mesh.owner.name for mesh in assembly.meshes}
    seams = sum(len(faces) for _, faces in seam_faces(assembly, pairs))
    return SceneCheck(pairs, len(names), len(assembly.surface.triangles), scene.hidden, seams)


def exclusions_now(
    context: bpy.types.Context, settings: EditSettings | None = None
) -> tuple[Exclusions, tuple[FacePair, ...]]:
    """All pairs of faces that meet, to be excluded from edits, and the pairs that cannot be: with loose elements."""
    chosen = settings or EditSettings()
    scene = read_scene(context, _counted(context, chosen))
    assembly = assemble_joined(scene.meshes, chosen.ignored_pairs)
    pairs = find_pairs(assembly, chosen.threads)
    excluded = Exclusions.of(pairs, scene.meshes)
    return excluded, excluded.others(pairs)


def _counted(
    context: bpy.types.Context, settings: EditSettings, objects: Collection[str] | None = None
) -> Callable[[str], bool]:
    """Tells by its name whether an object is tested."""
    cages = cages_shown_by_others(context)

    def is_counted(name: str) -> bool:
        return settings.takes_part(name) and (name not in cages if objects is None else name in objects)

    return is_counted


def find_pairs(assembly: Assembly, threads: int = 0) -> tuple[FacePair, ...]:
    """All pairs that meet where bodies of the assembly meet, at the positions it was read in."""
    return named_pairs(assembly, assembly.positions, threads)


def seam_faces(assembly: Assembly, pairs: Collection[FacePair]) -> Iterator[tuple[str, Indices]]:
    """For each mesh its object's name and the pairs of its faces, (k, 2), that touch along seams.

    Those among `pairs`, which intersect, are left out.
    """
    meeting = {(pair.first.object, *sorted((pair.first.number, pair.second.number))) for pair in pairs}
    for mesh, seams in zip(assembly.meshes, assembly.seams, strict=True):
        faces = seam_pairs(seams, mesh.triangles, mesh.faces)
        if meeting:
            apart = [(mesh.owner.name, a, b) not in meeting for a, b in faces.tolist()]
            faces = faces[np.array(apart, np.bool_)]
        yield mesh.owner.name, faces
