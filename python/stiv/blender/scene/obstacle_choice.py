# SPDX-License-Identifier: GPL-3.0-or-later
"""Chooses the objects that an edit reads as obstacles beside its surface."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

import bpy

from stiv.blender.scene.data_users import DataUsers
from stiv.blender.scene.evaluations import RENDER, SHOWN, VIEWPORT, is_visible, rendered_objects, signature
from stiv.blender.scene.followers import data_of
from stiv.blender.scene.guarded_evaluations import choose_guard
from stiv.blender.scene.hidden_dependencies import find_unpredictable
from stiv.blender.scene.open_evaluations import OpenEvaluations
from stiv.blender.settings import EditSettings

MIN_FACES = 50_000  # of all obstacles; in smaller scenes, the surface of the edit includes them


def find_obstacles(
    context: bpy.types.Context, moving: Sequence[bpy.types.Object], reshaped: Collection[str], settings: EditSettings
) -> frozenset[str]:
    """Find the names of the objects that certainly stay as they are, and that no setting names; empty if they are few.

    moving: the objects that an edit writes. reshaped: names of those whose data it writes. Obstacles are meshes and
    instancers that depend on nothing that changes with these objects, through any number of parents, constraints,
    modifiers, drivers and collections. Objects that simulations or scripts may change belong to the surface, and so
    do objects that the guarded evaluations may show differently.
    """
    candidates = [ob for ob in context.view_layer.objects if _may_be_obstacle(ob) and is_visible(context, ob)]
    users = DataUsers()
    start = {*_written(moving, reshaped), *find_unpredictable(users.all)}
    if choose_guard(context, settings).choice != "viewport":
        start.update(_rendered_differently(context.scene))
        rendered = rendered_objects(context.view_layer)
        candidates = [ob for ob in candidates if ob.session_uid in rendered]
    changing = {each.name for each in users.with_dependents(start) if isinstance(each, bpy.types.Object)}
    others = {*settings.named_objects(), *settings.excluded.shapes, *changing}
    names = frozenset(ob.name for ob in candidates if settings.participates(ob.name) and ob.name not in others)
    return names if names and _show_many_faces(context, names) else frozenset()


def _may_be_obstacle(ob: bpy.types.Object) -> bool:
    return bool(ob.type == "MESH" or (ob.type == "EMPTY" and ob.instance_type == "COLLECTION"))


def _written(moving: Sequence[bpy.types.Object], reshaped: Collection[str]) -> Iterator[bpy.types.ID]:
    """The data-blocks that an edit writes: objects, data, and keyframes, which several objects may share."""
    for ob in moving:
        data = data_of(ob) if ob.name in reshaped else []
        for each in (ob, *data):
            yield each
            animation = each.animation_data
            if animation is not None and animation.action is not None:
                yield animation.action


def _rendered_differently(scene: bpy.types.Scene) -> Iterator[bpy.types.ID]:
    """Objects that a render may show with other shapes or instances. Nodes may ask for the evaluation.

    Instancers of a collection show those of its objects that are not hidden.
    """
    for ob in bpy.data.objects:
        nodes = any(modifier.type == "NODES" for modifier in ob.modifiers)
        if nodes or signature(ob, scene, VIEWPORT) != signature(ob, scene, RENDER):
            yield ob
        if ob.hide_viewport != ob.hide_render:
            yield from ob.users_collection
    yield from (each for each in bpy.data.collections if each.hide_viewport != each.hide_render)


def _show_many_faces(context: bpy.types.Context, names: Collection[str]) -> bool:
    """Do these objects show `MIN_FACES` or more? Faces that modifiers add are not counted."""
    meshes = (ob.data for ob in context.view_layer.objects if ob.type == "MESH" and ob.name in names)
    if sum(len(mesh.polygons) for mesh in meshes) >= MIN_FACES:
        return True
    faces = 0
    for instance, owner, source in OpenEvaluations(context).instances(SHOWN, lambda ob: ob.name in names):
        shown = instance.object if source == owner and instance.is_instance else source
        faces += len(shown.data.polygons) if isinstance(shown.data, bpy.types.Mesh) else 0
    return faces >= MIN_FACES
