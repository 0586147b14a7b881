# SPDX-License-Identifier: GPL-3.0-or-later
"""The evaluations of a scene: as shown now, in Object Mode, and as rendered."""

from __future__ import annotations

from typing import Any

import bpy

SURFACE_TYPES = frozenset({"MESH", "CURVE", "SURFACE", "FONT", "META", "CURVES", "POINTCLOUD"})


SHOWN, VIEWPORT, RENDER = "shown", "viewport", "render"
EVALUATIONS = (SHOWN, VIEWPORT, RENDER)
"""As shown now, in Edit Mode too; as Object Mode shows it; as rendered."""

# Change neither positions nor triangles.
WITHOUT_EFFECT = frozenset({"WEIGHTED_NORMAL", "NORMAL_EDIT", "UV_PROJECT", "UV_WARP"})


def is_edited(ob: bpy.types.Object) -> bool:
    """Does Blender show the object as in Edit Mode? Other users of an edited mesh too, whatever their own mode."""
    return ob.mode == "EDIT" or (ob.type == "MESH" and bool(ob.data.is_editmode))


def is_active(modifier: bpy.types.Modifier, ob: bpy.types.Object, evaluation: str = SHOWN) -> bool:
    """Is the modifier switched on in an evaluation?"""
    if evaluation == RENDER:
        return bool(modifier.show_render)
    return bool(modifier.show_viewport and (evaluation == VIEWPORT or not is_edited(ob) or modifier.show_in_editmode))


def subdivision_levels(modifier: Any, scene: bpy.types.Scene, evaluation: str) -> int:
    """Levels of a Subdivision Surface or Multiresolution modifier, limited by Simplify."""
    levels: int = modifier.render_levels if evaluation == RENDER else modifier.levels
    render = scene.render
    if render.use_simplify:
        levels = min(
            levels, render.simplify_subdivision_render if evaluation == RENDER else render.simplify_subdivision
        )
    return levels


def rendered_objects(view_layer: bpy.types.ViewLayer) -> frozenset[int]:
    """Session numbers of the rendered objects of a view layer."""
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
    """All settings on which an evaluation of the object alone depends, for comparison."""
    return (
        *(modifier_signature(modifier, ob, scene, evaluation) for modifier in ob.modifiers),
        *_data_signature(ob, evaluation),
    )


def modifier_signature(
    modifier: Any, ob: bpy.types.Object, scene: bpy.types.Scene, evaluation: str
) -> tuple[Any, ...] | None:
    """Settings of a modifier on which an evaluation depends; None if it has no effect there."""
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
        return (0, 0)  # the render uses the resolution of the viewport
    if ob.type == "META":
        return (data.render_resolution if evaluation == RENDER else data.resolution,)
    return (ob.show_instancer_for_render if evaluation == RENDER else ob.show_instancer_for_viewport,)


def is_visible(context: bpy.types.Context, ob: bpy.types.Object) -> bool:
    """Is the object visible in the context's view layer, and in local view if there is one?"""
    return bool(ob.visible_get(view_layer=context.view_layer, viewport=_local_view(context)))


def _local_view(context: bpy.types.Context) -> bpy.types.SpaceView3D | None:
    space = context.space_data
    return space if isinstance(space, bpy.types.SpaceView3D) and space.local_view is not None else None


SHOWS_PARENT = "stiv_shows_parent"  # custom property that works without the add-on and survives copying


def find_replaced_cages(context: bpy.types.Context) -> frozenset[str]:
    """Names of the cages that a child of theirs replaces in the viewport."""
    return frozenset(ob.parent.name for ob in context.scene.objects if ob.parent and ob.get(SHOWS_PARENT))
