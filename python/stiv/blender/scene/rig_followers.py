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
    yield from (other.name for other in (*posing_objects(ob), *driving_objects(ob)))


def posing_objects(ob: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """Objects that active constraints of an object's bones refer to."""
    for bone in () if ob.pose is None else ob.pose.bones:
        for constraint in bone.constraints:
            yield from () if constraint.mute else referenced_objects(constraint)


def driving_objects(ob: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """Objects that the drivers of an object, its data and its shape keys read."""
    for owner in (ob, ob.data, getattr(ob.data, "shape_keys", None)):
        yield from (each.id for each in find_driver_targets(owner) if isinstance(each.id, bpy.types.Object))


def find_driver_targets(owner: bpy.types.ID | None) -> Iterator[bpy.types.DriverTarget]:
    """The targets of the drivers of an ID."""
    animation = getattr(owner, "animation_data", None)
    for curve in () if animation is None else animation.drivers:
        yield from (target for variable in curve.driver.variables for target in variable.targets)
