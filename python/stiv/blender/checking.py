# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact test of a whole scene, as Blender evaluates it."""

from collections.abc import Callable, Collection
from dataclasses import dataclass

import bpy

from stiv.blender.assembly import Assembly, assemble_joined
from stiv.blender.evaluated_scene import read_scene
from stiv.blender.exclusions import Exclusions
from stiv.blender.loop_objects import cages_shown_by_others
from stiv.blender.settings import EditSettings
from stiv.blender.verification import FacePair, named_pairs


@dataclass(frozen=True)
class SceneCheck:
    """What was found. `pairs` is empty for a scene free of intersections.

    Attributes:
        pairs: faces that meet, each pair once; a loose edge or vertex that meets a face comes with that face as the
            second.
        objects, triangles: how many were tested.
        hidden: objects with a surface that are hidden or excluded, and were not.
    """

    pairs: tuple[FacePair, ...]
    objects: int
    triangles: int
    hidden: int

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
    return SceneCheck(pairs, len(names), len(assembly.surface.triangles), scene.hidden)


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
