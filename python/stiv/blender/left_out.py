# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of a scene that no test sees, each with the reason."""

from __future__ import annotations

from collections.abc import Collection, Iterator

import bpy

from stiv.blender.evaluated_scene import SURFACE_TYPES
from stiv.blender.evaluations import RENDER, rendered_objects
from stiv.blender.loop_objects import cages_shown_by_others
from stiv.checks.findings import LeftOut, left_out_text

WITHOUT_SURFACE = {
    "CURVES": "hair curves",
    "CURVE": "curves without surface",
    "POINTCLOUD": "point clouds",
    "VOLUME": "volumes",
}


def find_left_out(
    context: bpy.types.Context, tested: Collection[str], named: Collection[str] = ()
) -> tuple[LeftOut, ...]:
    """What of the scene is not in a test of these objects, by name; each object once for a reason.

    named: names that the test is limited to, if any. Objects that never have a surface, such as lights, do not come.
    """
    candidates = [ob for ob in context.scene.objects if ob.type in SURFACE_TYPES | {"VOLUME"} and ob.name not in tested]
    reasons = [
        *((ob.name, "not named") for ob in candidates if named and ob.name not in named),
        *((ob.name, why) for ob in candidates if (not named or ob.name in named) and (why := _reason(context, ob))),
        *(each for each in _without_surface(context) if not named or each[0] in named),
    ]
    return tuple(LeftOut(name, why) for name, why in dict.fromkeys(reasons))


def text_not_guarded(context: bpy.types.Context, evaluations: Collection[str]) -> str:
    """What edits that guard these evaluations pass through, though the viewport or the render shows it; "" for nothing.

    That is what has no surface and, unless the render is guarded, what is hidden in the viewport and rendered.
    """
    found = [LeftOut(name, why) for name, why in dict.fromkeys(_without_surface(context))]
    if RENDER not in evaluations:
        found += [LeftOut(name, "rendered only") for name in _rendered_only(context)]
    return f"Not guarded, {left_out_text(found)}" if found else ""


def _reason(context: bpy.types.Context, ob: bpy.types.Object) -> str:
    """Why an object shows nothing that is tested; "" where its geometry says why."""
    if ob.name in cages_shown_by_others(context):
        return "cages shown by another object"
    if ob.name not in context.view_layer.objects:
        return "in an excluded collection"
    return "" if ob.visible_get(view_layer=context.view_layer) else "hidden"


def _without_surface(context: bpy.types.Context) -> Iterator[tuple[str, str]]:
    """What is shown and is no mesh: of objects of such a kind, and made by modifiers."""
    for instance in context.evaluated_depsgraph_get().object_instances:
        if instance.object.type in WITHOUT_SURFACE and (instance.show_self or instance.is_instance):
            owner = instance.parent.original if instance.is_instance else instance.object.original
            yield owner.name, WITHOUT_SURFACE[instance.object.type]
    for ob in context.view_layer.objects:
        if ob.visible_get(view_layer=context.view_layer) and any(_is_hair(modifier) for modifier in ob.modifiers):
            yield ob.name, "particle hair"


def _rendered_only(context: bpy.types.Context) -> list[str]:
    rendered = rendered_objects(context.view_layer)
    return [
        ob.name for ob in context.scene.objects
        if ob.session_uid in rendered and ob.type in SURFACE_TYPES
        and not (ob.name in context.view_layer.objects and ob.visible_get(view_layer=context.view_layer))
    ]  # fmt: skip


def _is_hair(modifier: bpy.types.Modifier) -> bool:
    return (
        isinstance(modifier, bpy.types.ParticleSystemModifier)
        and modifier.show_viewport
        and modifier.particle_system.settings.type == "HAIR"
    )
