# SPDX-License-Identifier: GPL-3.0-or-later
"""Chooses the objects that an edit reads as obstacles beside its surface."""

from __future__ import annotations

from collections.abc import Collection

import bpy

from stiv.blender.scene.dependencies import dependencies, find_dependents
from stiv.blender.scene.evaluations import RENDER, VIEWPORT, is_edited, is_visible, rendered_objects, signature
from stiv.blender.scene.guarded_evaluations import choose_guard
from stiv.blender.settings import EditSettings

MIN_FACES = 50_000  # of all obstacles; in smaller scenes, the surface of the edit includes them


def find_obstacles(context: bpy.types.Context, moving_names: Collection[str], settings: EditSettings) -> frozenset[str]:
    """Find the names of the objects that certainly stay as they are, and that no setting names; empty if they are few.

    moving_names: of the objects that move. Only independent meshes are obstacles. Objects with parents, children,
    modifiers or constraints that refer to others, and instancers belong to the surface, and so do objects that the
    guarded evaluations may show differently.
    """
    objects = [ob for ob in context.view_layer.objects if is_visible(context, ob)]
    parents = {ob.parent.session_uid for ob in bpy.data.objects if ob.parent is not None}  # `children` searches all
    candidates = [ob for ob in objects if ob.session_uid not in parents and _is_independent(ob)]
    if choose_guard(context, settings).choice != "viewport":
        rendered = rendered_objects(context.view_layer)
        candidates = [ob for ob in candidates if ob.session_uid in rendered and _is_rendered_alike(ob, context.scene)]
    if sum(len(ob.data.polygons) for ob in candidates) < MIN_FACES:
        return frozenset()
    others = {*settings.named_objects(), *settings.excluded.shapes, *find_dependents(objects, set(moving_names))}
    return frozenset(ob.name for ob in candidates if settings.participates(ob.name) and ob.name not in others)


def _is_independent(ob: bpy.types.Object) -> bool:
    """Does nothing but its own data place and shape the mesh?"""
    alone = ob.type == "MESH" and ob.mode == "OBJECT" and not is_edited(ob) and ob.instance_type == "NONE"
    return bool(alone and ob.parent is None and not any(dependencies(ob)))


def _is_rendered_alike(ob: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """Nodes may ask for the evaluation."""
    nodes = any(modifier.type == "NODES" for modifier in ob.modifiers)
    return not nodes and signature(ob, scene, VIEWPORT) == signature(ob, scene, RENDER)
