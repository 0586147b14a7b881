# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the objects that move with others: below rigs, hooks, lattices, constraints and drivers."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

import bpy

from stiv.blender.scene.dependencies import active_owners, add_dependents, is_enabled, referenced_objects
from stiv.blender.scene.evaluations import RENDER, VIEWPORT


def find_followers(scene: bpy.types.Scene, names: Collection[str]) -> set[str]:
    """These names, and those of all objects that depend on them directly or indirectly."""
    return add_dependents(set(names), used_names(scene))


def used_names(scene: bpy.types.Scene) -> dict[str, set[str]]:
    """The names of the objects on which each object of a scene depends directly."""
    return {ob.name: {used.name for used in used_objects(ob)} for ob in scene.objects}


def can_follow(ob: bpy.types.Object) -> bool:
    """Can a copy show how the object follows others? Not with instances, which nodes may show too."""
    has_nodes = any(isinstance(modifier, bpy.types.NodesModifier) for modifier in ob.modifiers)
    return ob.type == "MESH" and ob.instance_type == "NONE" and not has_nodes


def between(ob: bpy.types.Object, used: Collection[int]) -> list[bpy.types.Object]:
    """The objects with these session numbers on which an object depends, and those through which it does."""
    found, used_by = reached([ob])
    chosen = add_dependents(set(used) & found.keys(), used_by)
    return [each for number, each in found.items() if number in chosen and each != ob]


def reached(objects: Sequence[bpy.types.Object]) -> tuple[dict[int, bpy.types.Object], dict[int, set[int]]]:
    """These objects and all on which they depend, by session number, and the numbers of those that each uses."""
    found: dict[int, bpy.types.Object] = {}
    used_by: dict[int, set[int]] = {}
    waiting = list(objects)
    while waiting:
        user = waiting.pop()
        if user.session_uid not in found:
            instanced = () if user.instance_collection is None else user.instance_collection.all_objects
            used = [*used_objects(user), *instanced]
            found[user.session_uid] = user
            used_by[user.session_uid] = {each.session_uid for each in used}
            waiting += used
    return found, used_by


def used_objects(ob: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """Objects on which the shape or the place of an object depends, in the viewport or as rendered."""
    for owner in active_owners(ob, (VIEWPORT, RENDER)):
        yield from referenced_objects(owner)
    if ob.parent is not None:
        yield ob.parent
    yield from posing_objects(ob)
    yield from driving_objects(ob)


def posing_objects(ob: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """Objects that active constraints of an object's bones refer to."""
    for bone in () if ob.pose is None else ob.pose.bones:
        for constraint in bone.constraints:
            yield from referenced_objects(constraint) if is_enabled(constraint) else ()


def driving_objects(ob: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """Objects that the drivers of an object, its data and its shape keys read."""
    for owner in (ob, *data_of(ob)):
        yield from driving(owner)


def data_of(ob: bpy.types.Object) -> list[bpy.types.ID]:
    """The data of an object, and its shape keys."""
    return [each for each in (ob.data, getattr(ob.data, "shape_keys", None)) if each is not None]


def driving(owner: bpy.types.ID) -> Iterator[bpy.types.Object]:
    """Objects that the drivers of a data-block read."""
    yield from (each.id for each in find_driver_targets(owner) if isinstance(each.id, bpy.types.Object))


def find_driver_targets(owner: bpy.types.ID) -> Iterator[bpy.types.DriverTarget]:
    """The targets of the drivers of an ID."""
    animation = getattr(owner, "animation_data", None)
    for curve in () if animation is None else animation.drivers:
        yield from (target for variable in curve.driver.variables for target in variable.targets)
