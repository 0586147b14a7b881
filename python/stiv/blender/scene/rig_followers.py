# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the objects that move with rigs."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from stiv.blender.scene.dependencies import add_dependents, dependencies, referenced_objects
from stiv.blender.scene.evaluations import RENDER, VIEWPORT


def find_followers(scene: bpy.types.Scene, rigs: set[str]) -> set[str]:
    """Names of the rigs, and of all objects that depend on them directly or indirectly."""
    users = {ob.name: set(_used(ob)) for ob in scene.objects}
    return add_dependents(rigs, users)


def _used(ob: bpy.types.Object) -> Iterator[str]:
    """Names of the objects on which an object depends."""
    yield from (each.used for each in dependencies(ob, (VIEWPORT, RENDER)))
    if ob.parent is not None:
        yield ob.parent.name
    for constraint in bone_constraints(ob):
        yield from (other.name for other in referenced_objects(constraint))
    for target in driver_targets(ob):
        if isinstance(target.id, bpy.types.Object):
            yield target.id.name


def bone_constraints(ob: bpy.types.Object) -> Iterator[bpy.types.Constraint]:
    """Active constraints of the bones of an object."""
    if ob.pose is not None:
        yield from (each for bone in ob.pose.bones for each in bone.constraints if not each.mute)


def driver_targets(ob: bpy.types.Object) -> Iterator[bpy.types.DriverTarget]:
    """The targets of all drivers of an object, its data and its shape keys."""
    for owner in (ob, ob.data, getattr(ob.data, "shape_keys", None)):
        yield from find_driver_targets(owner)


def find_driver_targets(owner: bpy.types.ID | None) -> Iterator[bpy.types.DriverTarget]:
    """The targets of the drivers of an ID."""
    animation = getattr(owner, "animation_data", None)
    for curve in () if animation is None else animation.drivers:
        yield from (target for variable in curve.driver.variables for target in variable.targets)
