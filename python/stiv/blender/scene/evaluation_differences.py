# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the objects that differ between the evaluations of a scene."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass

import bpy

from stiv.blender.scene.dependencies import add_dependents, is_enabled, referenced_objects, shape_dependencies
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
from stiv.blender.scene.followers import driving_objects, posing_objects

# Evaluated alike in both modes if Edit Mode shows them. Blender may skip other types in Edit Mode.
EDIT_MODE_TYPES = frozenset(
    {
        *("SUBSURF", "LATTICE", "TRIANGULATE", "MIRROR", "ARRAY", "SOLIDIFY", "BEVEL", "ARMATURE", "CAST", "CURVE"),
        *("DISPLACE", "HOOK", "SHRINKWRAP", "SIMPLE_DEFORM", "SMOOTH", "WARP", "WELD"),
    }
)


SHAPE, PLACE = True, False  # of an object; a pose counts as a shape
SHAPE_PARENTS = ("VERTEX", "VERTEX_3", "BONE")
SHAPE_CONSTRAINTS = ("SHRINKWRAP", "FOLLOW_PATH", "CLAMP_TO", "ARMATURE")


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
        alike = frozenset() if VIEWPORT in evaluations else viewport & rendered
        render = _rendered_otherwise(context, rendered, viewport, alike)
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


def _rendered_otherwise(
    context: bpy.types.Context, rendered: frozenset[int], viewport: set[int], alike: Collection[int]
) -> set[int]:
    """alike: objects of Object Mode that are rendered, and not read from there."""
    scene = context.scene
    objects = list(_all_objects(context.view_layer))
    layer = set(context.view_layer.objects)
    changed = {ob.session_uid for ob in objects if signature(ob, scene, VIEWPORT) != signature(ob, scene, RENDER)}
    changed |= {ob.session_uid for ob in objects if ob not in layer and ob.hide_viewport != ob.hide_render}
    render = _with_users(changed, objects)
    shown = {ob.session_uid for ob in layer if ob.visible_get(view_layer=context.view_layer)}
    render |= (rendered - shown).union(alike)
    by_number = {ob.session_uid: ob for ob in objects}
    waiting = list(render) if viewport else []
    while waiting:  # objects that they refer to must not be evaluated as in Edit Mode either
        ob = by_number.get(waiting.pop())
        used = set() if ob is None else {number for number, _ in (*_shaping(ob), *_placing(ob))}
        new = used & viewport - render
        render |= new
        waiting += new
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
    """The objects, whose shapes differ, and all whose shape or placement therefore differs, directly or indirectly."""
    if not numbers:
        return numbers
    users: dict[tuple[int, bool], set[tuple[int, bool]]] = {}
    for ob in objects:
        users[ob.session_uid, SHAPE] = set(_shaping(ob))
        users[ob.session_uid, PLACE] = set(_placing(ob))
    return {number for number, _ in add_dependents({(number, SHAPE) for number in numbers}, users)}


def _shaping(ob: bpy.types.Object) -> Iterator[tuple[int, bool]]:
    """Shapes and placements on which the shape, the pose or the instances of an object depend."""
    for used in (*shape_dependencies(ob), *posing_objects(ob), *driving_objects(ob)):
        yield from _both(used)


def _placing(ob: bpy.types.Object) -> Iterator[tuple[int, bool]]:
    """Shapes and placements on which the placement of an object depends."""
    if ob.parent is not None:
        yield ob.parent.session_uid, PLACE
        if ob.parent_type in SHAPE_PARENTS or ob.parent.type == "CURVE":
            yield ob.parent.session_uid, SHAPE
    for constraint in ob.constraints:
        for used in referenced_objects(constraint) if is_enabled(constraint) else ():
            yield used.session_uid, PLACE
            if constraint.type in SHAPE_CONSTRAINTS or getattr(constraint, "subtarget", False):
                yield used.session_uid, SHAPE
    for used in driving_objects(ob):
        yield from _both(used)


def _both(ob: bpy.types.Object) -> Iterator[tuple[int, bool]]:
    yield ob.session_uid, SHAPE
    yield ob.session_uid, PLACE
