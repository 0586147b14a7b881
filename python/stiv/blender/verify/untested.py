# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists objects that are not tested, with the reason."""

from __future__ import annotations

from collections.abc import Collection, Iterator

import bpy

from stiv.blender.scene.evaluations import RENDER, SURFACE_TYPES, find_replaced_cages, rendered_objects
from stiv.blender.scene.strand_reading import (
    STRAND_TYPES,
    hair_systems,
    helper_curves,
    why_no_particle_hair,
    why_no_strands,
)
from stiv.checks.findings import Untested, untested_text

WITHOUT_SURFACE = {"POINTCLOUD": "point clouds", "VOLUME": "volumes"}


def find_untested(
    context: bpy.types.Context, tested: Collection[str], named: Collection[str] = ()
) -> tuple[Untested, ...]:
    """Objects of the scene missing from a test of `tested`, by name, each with its reasons.

    named: names to which the test is limited, if any. Objects without surfaces, such as lights, are not listed.
    """
    candidates = [ob for ob in context.scene.objects if ob.type in SURFACE_TYPES | {"VOLUME"} and ob.name not in tested]
    reasons = [
        *((ob.name, "not named") for ob in candidates if named and ob.name not in named),
        *((ob.name, why) for ob in candidates if (not named or ob.name in named) and (why := _reason(context, ob))),
        *(each for each in _without_surface(context) if not named or each[0] in named),
    ]
    return tuple(Untested(name, why) for name, why in dict.fromkeys(reasons))


def unguarded_text(
    context: bpy.types.Context,
    evaluations: Collection[str],
    carried: Collection[str] = (),
    without_surface: Collection[tuple[str, str]] | None = None,
) -> str:
    """Message about objects that are shown but not guarded by edits; "" if there are none.

    These are objects that cannot be tested and, unless the render is guarded, objects that only the render shows.
    carried: names of the objects whose strands move with the edit. without_surface: of `find_without_surface`, if it is
    known.
    """
    shown = find_without_surface(context) if without_surface is None else without_surface
    reasons = [*shown, *((name, "hair and curves that move along") for name in sorted(carried))]
    found = [Untested(name, why) for name, why in dict.fromkeys(reasons)]
    if RENDER not in evaluations:
        found += [Untested(name, "rendered only") for name in _rendered_only(context)]
    return f"Not guarded, {untested_text(found)}" if found else ""


def _reason(context: bpy.types.Context, ob: bpy.types.Object) -> str:
    """Why none of the object's meshes is tested; "" if its geometry decides."""
    if ob.name in find_replaced_cages(context):
        return "cages shown by another object"
    if ob.name not in context.view_layer.objects:
        return "in an excluded collection"
    return "" if ob.visible_get(view_layer=context.view_layer) else "hidden"


def find_without_surface(context: bpy.types.Context) -> tuple[tuple[str, str], ...]:
    """Find visible geometry that cannot be tested as mesh or strands: the owner and the reason."""
    return tuple(_without_surface(context))


def _without_surface(context: bpy.types.Context) -> Iterator[tuple[str, str]]:
    """Visible geometry that cannot be tested as mesh or strands: the owner and the reason."""
    helpers = helper_curves(context)
    graph = context.evaluated_depsgraph_get()
    for instance in graph.object_instances:
        if instance.show_self or instance.is_instance:
            owner = instance.parent.original if instance.is_instance else instance.object.original
            source = instance.instance_object.original if instance.is_instance else owner
            why = _why_untested(instance, source, helpers)
            if why:
                yield owner.name, why
    for ob in context.view_layer.objects:
        if hair_systems(ob) and ob.visible_get(view_layer=context.view_layer):
            why = why_no_particle_hair(ob.evaluated_get(graph))
            if why:
                yield ob.name, why


def _rendered_only(context: bpy.types.Context) -> list[str]:
    rendered = rendered_objects(context.view_layer)
    return [
        ob.name for ob in context.scene.objects
        if ob.session_uid in rendered and ob.type in SURFACE_TYPES
        and not (ob.name in context.view_layer.objects and ob.visible_get(view_layer=context.view_layer))
    ]  # fmt: skip


def _why_untested(
    instance: bpy.types.DepsgraphObjectInstance, source: bpy.types.Object, helpers: frozenset[str]
) -> str:
    shown = instance.object
    if shown.type in STRAND_TYPES:
        return why_no_strands(shown, source, helpers)
    if instance.is_instance and shown.type == "MESH" and hair_systems(source):
        return "particle hair of instances"
    return WITHOUT_SURFACE.get(shown.type, "")
