# SPDX-License-Identifier: GPL-3.0-or-later
"""The evaluations of a scene: as shown now, in Object Mode, as rendered; and which objects differ between them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import bpy

SHOWN, VIEWPORT, RENDER = "shown", "viewport", "render"
EVALUATIONS = (SHOWN, VIEWPORT, RENDER)
"""What Blender shows now, in Edit Mode too; what Object Mode shows; what is rendered."""

# Evaluated alike in both modes where Edit Mode shows them. Others may be left out there by Blender itself.
EDIT_MODE_TYPES = frozenset(
    {
        *("SUBSURF", "LATTICE", "TRIANGULATE", "MIRROR", "ARRAY", "SOLIDIFY", "BEVEL", "ARMATURE", "CAST", "CURVE"),
        *("DISPLACE", "HOOK", "SHRINKWRAP", "SIMPLE_DEFORM", "SMOOTH", "WARP", "WELD"),
    }
)
# Leave all positions and triangles as they are.
WITHOUT_EFFECT = frozenset({"WEIGHTED_NORMAL", "NORMAL_EDIT", "UV_PROJECT", "UV_WARP"})


@dataclass(frozen=True)
class Differences:
    """Objects by session number.

    Attributes:
        viewport: those that Object Mode shows otherwise than they are shown now.
        render: those that are rendered otherwise than Object Mode shows them, or rendered and not shown.
        rendered: all that are rendered.
    """

    viewport: frozenset[int] = frozenset()
    render: frozenset[int] = frozenset()
    rendered: frozenset[int] = frozenset()


def is_active(modifier: bpy.types.Modifier, ob: bpy.types.Object, evaluation: str = SHOWN) -> bool:
    """Does the modifier act in an evaluation, as far as its switches say?"""
    if evaluation == RENDER:
        return bool(modifier.show_render)
    return bool(modifier.show_viewport and (evaluation == VIEWPORT or ob.mode != "EDIT" or modifier.show_in_editmode))


def subdivision_levels(modifier: Any, scene: bpy.types.Scene, evaluation: str) -> int:
    """Levels of a Subdivision Surface or Multiresolution modifier, Simplify included."""
    levels: int = modifier.render_levels if evaluation == RENDER else modifier.levels
    render = scene.render
    if render.use_simplify:
        levels = min(
            levels, render.simplify_subdivision_render if evaluation == RENDER else render.simplify_subdivision
        )
    return levels


def find_differences(context: bpy.types.Context, evaluations: Collection[str]) -> Differences:
    """What must be evaluated apart for these evaluations."""
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


def rendered_objects(view_layer: bpy.types.ViewLayer) -> frozenset[int]:
    """Session numbers of the objects of a view layer that are rendered."""
    found: set[int] = set()
    waiting = [view_layer.layer_collection]
    while waiting:
        layer = waiting.pop()
        if layer.exclude or layer.collection.hide_render:
            continue
        found |= {ob.session_uid for ob in layer.collection.objects if not ob.hide_render}
        waiting += layer.children
    return frozenset(found)


def signature(ob: bpy.types.Object, scene: bpy.types.Scene, evaluation: str) -> tuple[Any, ...]:
    """Of what an evaluation of the object alone depends on; equal for evaluations that are alike."""
    return (
        *(_modifier_signature(modifier, ob, scene, evaluation) for modifier in ob.modifiers),
        *_data_signature(ob, evaluation),
    )


def _modifier_signature(
    modifier: Any, ob: bpy.types.Object, scene: bpy.types.Scene, evaluation: str
) -> tuple[Any, ...] | None:
    if modifier.type in WITHOUT_EFFECT or not is_active(modifier, ob, evaluation):
        return None
    rendered = evaluation == RENDER
    if modifier.type == "SUBSURF":
        levels = subdivision_levels(modifier, scene, evaluation)
        return (levels,) if levels else None
    if modifier.type == "MULTIRES":
        return (subdivision_levels(modifier, scene, evaluation),)
    if modifier.type == "SCREW":
        return (modifier.render_steps if rendered else modifier.steps,)
    if modifier.type == "OCEAN":
        return (modifier.resolution if rendered else modifier.viewport_resolution,)
    return ()


def _data_signature(ob: bpy.types.Object, evaluation: str) -> tuple[Any, ...]:
    data = ob.data
    if ob.type in ("CURVE", "SURFACE", "FONT"):
        if evaluation == RENDER:
            return (data.render_resolution_u, data.render_resolution_v)
        return (0, 0)  # for the render: as in the viewport
    if ob.type == "META":
        return (data.render_resolution if evaluation == RENDER else data.resolution,)
    return (ob.show_instancer_for_render if evaluation == RENDER else ob.show_instancer_for_viewport,)


def _is_edited_otherwise(ob: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """Is the object in Edit Mode, and Object Mode may show it otherwise?"""
    if ob.mode != "EDIT" or ob.type != "MESH":
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
    while waiting:  # what they look at must not be as in Edit Mode either
        ob = by_number.get(waiting.pop())
        for used in () if ob is None else objects_used(ob):
            if used.session_uid in viewport and used.session_uid not in render:
                render.add(used.session_uid)
                waiting.append(used.session_uid)
    return render


def _all_objects(view_layer: bpy.types.ViewLayer) -> Iterator[bpy.types.Object]:
    """Those of a view layer, and those of the collections that they show as instances."""
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


def objects_used(ob: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """Objects that the shape of an object, or what it shows as instances, depends on in any evaluation."""
    from stiv.blender.scene.dependencies import looked_at  # which asks here what is active

    for modifier in ob.modifiers:
        yield from looked_at(modifier)
    if ob.instance_type == "COLLECTION" and ob.instance_collection is not None:
        yield from ob.instance_collection.all_objects
    elif ob.instance_type in ("VERTS", "FACES"):
        yield from ob.children
    if ob.parent is not None and (ob.parent_type.startswith("VERTEX") or ob.parent.instance_type != "NONE"):
        yield ob.parent


def _with_users(numbers: set[int], objects: Iterable[bpy.types.Object]) -> set[int]:
    """The objects, and all that look at them, directly or not."""
    if not numbers:
        return numbers
    users = {ob.session_uid: {used.session_uid for used in objects_used(ob)} for ob in objects}
    found, before = set(numbers), -1
    while len(found) != before:
        before = len(found)
        found |= {number for number, used in users.items() if used & found}
    return found
