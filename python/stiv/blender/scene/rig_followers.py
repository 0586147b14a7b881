# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the objects that move with rigs."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from stiv.blender.scene.dependencies import active_owners, add_dependents, is_enabled, referenced_objects
from stiv.blender.scene.evaluations import RENDER, VIEWPORT


def find_followers(scene: bpy.types.Scene, rigs: set[str]) -> set[str]:
    """Names of the rigs, and of all objects that depend on them directly or indirectly."""
    users = {ob.name: {used.name for used in used_objects(ob)} for ob in scene.objects}
    return add_dependents(rigs, users)


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
