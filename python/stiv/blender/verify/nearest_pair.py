# SPDX-License-Identifier: GPL-3.0-or-later
"""How near the objects of a scene are to each other, as Blender evaluates it."""

import bpy

import stiv
from stiv.blender.scene.assembly import assemble
from stiv.blender.scene.evaluated_scene import read_scene
from stiv.blender.settings import EditSettings


def nearest_pair(context: bpy.types.Context, settings: EditSettings | None = None) -> stiv.LeastDistance | None:
    """Nearest triangles of different visible objects; None where there are no two.

    settings: objects in the role "ignored" and ignored pairs are left out. Raises InputError for coordinates that are
    not finite.
    """
    settings = settings or EditSettings()
    scene = read_scene(context, settings.takes_part)
    assembly = assemble(scene.meshes, ["deformable"] * len(scene.meshes), (), settings.ignored_pairs)
    return stiv.least_distance(assembly.positions, assembly.surface)
