# SPDX-License-Identifier: GPL-3.0-or-later
"""The object that shows a cage's Loop subdivision: made beside the cage, named after it, and taken away again."""

import bpy

from stiv.blender.controls.editable import check_data
from stiv.blender.controls.loop_surfaces import refine, refresh
from stiv.blender.settings import LoopSurface

SHOWS_PARENT = "stiv_shows_parent"  # custom property, so that it is known without the add-on too; copies keep it


def add_refined(context: bpy.types.Context, cage: bpy.types.Object, levels: int, boundary: str) -> bpy.types.Object:
    """Make "<name>.loop", a child of the cage at the same place, in the same collections, with its materials.

    It cannot be selected, so that clicks go to the cage. Raises InputError for a cage with a face that is not a
    triangle, and for one that cannot be changed; nothing is made then.
    """
    check_data(cage)
    refine(cage, LoopSurface("", levels, boundary))  # refuses before anything is made
    name = f"{cage.name}.loop"
    refined = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    refined.parent = cage
    refined[SHOWS_PARENT] = True
    for material in cage.data.materials:
        refined.data.materials.append(material)
    for collection in cage.users_collection:
        collection.objects.link(refined)
    refined.hide_select = True
    context.view_layer.update()
    refresh(cage, refined, LoopSurface(refined.name, levels, boundary))
    return refined


def cages_shown_by_others(context: bpy.types.Context) -> frozenset[str]:
    """Names of the cages that a child of theirs shows in their place."""
    return frozenset(ob.parent.name for ob in context.scene.objects if ob.parent and ob.get(SHOWS_PARENT))


def remove_refined(refined: bpy.types.Object) -> None:
    """Delete the object and its mesh."""
    mesh = refined.data
    bpy.data.objects.remove(refined)
    if mesh.users == 0:
        bpy.data.meshes.remove(mesh)
