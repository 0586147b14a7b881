# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the objects that differ between the evaluations of a scene."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass

import bpy

from stiv.blender.scene.dependencies import add_dependents, shape_dependencies
from stiv.blender.scene.evaluations import (
    RENDER,
    SHOWN,
    VIEWPORT,
    WITHOUT_EFFECT,
    is_active,
    is_edited,
    rendered_objects,
    signature,
)

# Evaluated alike in both modes if Edit Mode shows them. Blender may skip other types in Edit Mode.
EDIT_MODE_TYPES = frozenset(
    {
        *("SUBSURF", "LATTICE", "TRIANGULATE", "MIRROR", "ARRAY", "SOLIDIFY", "BEVEL", "ARMATURE", "CAST", "CURVE"),
        *("DISPLACE", "HOOK", "SHRINKWRAP", "SIMPLE_DEFORM", "SMOOTH", "WARP", "WELD"),
    }
)


@dataclass(frozen=True)
class Differences:
    """Session numbers of objects.

    Attributes:
        viewport: Object Mode shows them differently from now.
        render: rendered differently from Object Mode, or rendered but not shown.
        rendered: all objects that are rendered.
    """

    viewport: frozenset[int] = frozenset()
    render: frozenset[int] = frozenset()
    rendered: frozenset[int] = frozenset()


def find_differences(context: bpy.types.Context, evaluations: Collection[str]) -> Differences:
    """Find the objects that need an evaluation of their own."""
    viewport: set[int] = set()
    render: set[int] = set()
    rendered: frozenset[int] = frozenset()
    if context.mode != "OBJECT":
        objects = list(_all_objects(context.view_layer))
        viewport = _with_users({ob.session_uid for ob in objects if _is_edited_otherwise(ob, context.scene)}, objects)
    if RENDER in evaluations:
        rendered = rendered_objects(context.view_layer)
        render = _rendered_otherwise(context, rendered, viewport)
        if VIEWPORT not in evaluations:
            render |= viewport & rendered
    return Differences(frozenset(viewport), frozenset(render), rendered)


def _is_edited_otherwise(ob: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """Is the object in Edit Mode, with a shape that may differ in Object Mode?"""
    if ob.type != "MESH" or not is_edited(ob):
        return False
    if signature(ob, scene, SHOWN) != signature(ob, scene, VIEWPORT):
        return True
    if ob.data.shape_keys is not None and len(ob.data.shape_keys.key_blocks) > 1:
        return True
    active = [modifier for modifier in ob.modifiers if is_active(modifier, ob) and modifier.type not in WITHOUT_EFFECT]
    return any(modifier.type not in EDIT_MODE_TYPES for modifier in active)


def _rendered_otherwise(context: bpy.types.Context, rendered: frozenset[int], viewport: set[int]) -> set[int]:
    scene = context.scene
    objects = list(_all_objects(context.view_layer))
    layer = set(context.view_layer.objects)
    changed = {ob.session_uid for ob in objects if signature(ob, scene, VIEWPORT) != signature(ob, scene, RENDER)}
    changed |= {ob.session_uid for ob in objects if ob not in layer and ob.hide_viewport != ob.hide_render}
    render = _with_users(changed, objects)
    shown = {ob.session_uid for ob in layer if ob.visible_get(view_layer=context.view_layer)}
    render |= rendered - shown
    by_number = {ob.session_uid: ob for ob in objects}
    waiting = list(render) if viewport else []
    while waiting:  # objects that they refer to must not be evaluated as in Edit Mode either
        ob = by_number.get(waiting.pop())
        for used in () if ob is None else shape_dependencies(ob):
            if used.session_uid in viewport and used.session_uid not in render:
                render.add(used.session_uid)
                waiting.append(used.session_uid)
    return render


def _all_objects(view_layer: bpy.types.ViewLayer) -> Iterator[bpy.types.Object]:
    """Objects of a view layer and of the collections that they instance."""
    seen: set[bpy.types.Object] = set()
    waiting = list(view_layer.objects)
    while waiting:
        ob = waiting.pop(0)
        if ob in seen:
            continue
        seen.add(ob)
        yield ob
        if ob.instance_type == "COLLECTION" and ob.instance_collection is not None:
            waiting += ob.instance_collection.all_objects


def _with_users(numbers: set[int], objects: Iterable[bpy.types.Object]) -> set[int]:
    """The objects, and all that depend on them directly or indirectly."""
    if not numbers:
        return numbers
    users = {ob.session_uid: {used.session_uid for used in shape_dependencies(ob)} for ob in objects}
    return add_dependents(numbers, users)
