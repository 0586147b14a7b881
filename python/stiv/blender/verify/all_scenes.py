# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes every scene and object of an open file visible to a test. Do not save the file afterwards."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager

import bpy

from stiv import InputError

ALL = "all"


def scene_names(name: str) -> list[str]:
    """Names of the scenes selected by `name` or "all", the open one first. Raises InputError."""
    names = [bpy.context.scene.name, *(scene.name for scene in bpy.data.scenes if scene != bpy.context.scene)]
    if name in names:
        return [name]
    if name != ALL:
        raise InputError(f'there is no scene "{name}" in it; there are {", ".join(names)}')
    return names


def check_names(scene: str, objects: Collection[str]) -> None:
    """Refuse objects that none of the selected scenes contains. Raises InputError."""
    known = {ob.name for name in scene_names(scene) for ob in bpy.data.scenes[name].objects}
    unknown = sorted(set(objects) - known)
    if unknown:
        where = "any scene" if scene == ALL else f'scene "{scene}"'
        raise InputError(f'there is no object "{unknown[0]}" in {where}')


@contextmanager
def opened_scene(name: str) -> Iterator[bpy.types.Context]:
    """Blender's context with another scene, inside the `with` statement.

    The window keeps its scene: if it is changed, Blender 4.2 crashes when the next file is opened.
    """
    scene = bpy.data.scenes[name]
    if scene == bpy.context.scene:
        yield bpy.context
        return
    with bpy.context.temp_override(scene=scene, view_layer=scene.view_layers[0]):
        yield bpy.context


def unhide_all(context: bpy.types.Context) -> None:
    """Show every object and collection of the open scene, in the viewport and in the render."""
    for collection in (context.scene.collection, *context.scene.collection.children_recursive):
        collection.hide_viewport = collection.hide_render = False
    waiting = [context.view_layer.layer_collection]
    while waiting:
        layer = waiting.pop()
        layer.exclude = layer.hide_viewport = False
        waiting += layer.children
    for ob in context.view_layer.objects:
        ob.hide_viewport = ob.hide_render = False
        ob.hide_set(False)
    context.view_layer.update()
