# SPDX-License-Identifier: GPL-3.0-or-later
"""Locks of location, rotation and scale: locked properties keep their values, or the edit is refused.

Location locks leave the other directions free. Rigid groups rotate and scale freely or not at all, so that locks of
single axes are refused.
"""

from collections.abc import Sequence

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.controls.control_set import Participant
from stiv.blender.controls.directions import FreeDirections
from stiv.blender.controls.object_transform import ObjectTransform
from stiv.blender.scene.arrays import invert

AXES = "XYZ"


def drop_locked(participants: Sequence[Participant], kind: str) -> list[Participant]:
    """Drop rigid participants that are fixed by their locks; they become obstacles.

    kind: kind of the edit; unselected objects yield by moving. Raises InputError for locks that cannot be respected,
    and if nothing selected can move.
    """
    left = []
    for participant in participants:
        ob = participant.reference.find()
        if participant.role != "rigid" or not _is_held(ob, kind if participant.selected else "move"):
            left.append(participant)
    for participant in left:
        if participant.role == "rigid":
            _check(participant.reference.find(), kind if participant.selected else "move")
    if any(each.selected for each in participants) and not any(participant.selected for participant in left):
        name = next(each.reference.name for each in participants if each.selected)
        raise InputError(f"{name}: its transform is locked; unlock it")
    return left


def is_location_locked(ob: bpy.types.Object) -> bool:
    """Is the location locked along all axes, so that the object cannot yield rigidly?"""
    return all(ob.lock_location)


def can_rotate(ob: bpy.types.Object) -> bool:
    """Is the rotation free of locks?"""
    return not any(ob.lock_rotation) and not (ob.lock_rotations_4d and ob.lock_rotation_w)


def _is_held(ob: bpy.types.Object, kind: str) -> bool:
    if not all(ob.lock_location):
        return False
    return kind == "move" or (kind == "rotate" and all(ob.lock_rotation)) or (kind == "scale" and all(ob.lock_scale))


def _check(ob: bpy.types.Object, kind: str) -> None:
    locked = [] if kind == "move" else [("location", ob.lock_location)]
    if kind == "rotate" and not all(ob.lock_rotation):
        locked.append(("rotation", ob.lock_rotation))
    if kind == "scale":
        locked.append(("scale", ob.lock_scale))
    for what, axes in locked:
        if any(axes):
            raise InputError(_lock_text(ob, what, axes))


def location_lock_text(ob: bpy.types.Object) -> str:
    """The message on the locks of an object's location."""
    return _lock_text(ob, "location", ob.lock_location)


def _lock_text(ob: bpy.types.Object, what: str, axes: Sequence[bool]) -> str:
    names = ", ".join(axis for axis, lock in zip(AXES, axes, strict=True) if lock)
    return f"{ob.name}: its {what} is locked along {names}; unlock it"


def find_free_directions(
    objects: Sequence[bpy.types.Object], starts: Sequence[ObjectTransform]
) -> FreeDirections | None:
    """Directions in which objects can move together while each keeps its locked location channels.

    Channels are along the axes of the parent. None: no channel is locked.
    """
    rows = [
        invert(start.parent_matrix[:3, :3])[list(ob.lock_location)] for ob, start in zip(objects, starts, strict=True)
    ]
    normals = np.concatenate(rows)
    if len(normals) == 0:
        return None
    return FreeDirections.of_normals(normals)


def restore_locked(ob: bpy.types.Object, start: ObjectTransform) -> None:
    """Restore the locked location channels exactly, because conversion through world space rounds them."""
    for axis in np.flatnonzero(ob.lock_location):
        ob.location[axis] = start.location[axis]
