# SPDX-License-Identifier: GPL-3.0-or-later
"""Locks of an object's location, rotation and scale: what is locked keeps its value, or the edit is refused.

Locked axes of the location leave the other directions to move in. A rigid part turns and grows freely or not at all,
so that locks of some axes alone cannot be kept while it does.
"""

from collections.abc import Sequence

import bpy

from stiv import InputError
from stiv.blender.controls.movers import Mover

AXES = "XYZ"


def without_held(movers: Sequence[Mover], kind: str) -> list[Mover]:
    """The movers but those rigid ones that their locks hold in place, which stay in the way.

    kind: of the edit; what is not selected gives way by moving. Raises InputError for locks that cannot be kept, and
    where nothing of what is selected is left to move.
    """
    left = []
    for mover in movers:
        ob = mover.reference.find()
        if mover.role != "rigid" or not _is_held(ob, kind if mover.selected else "move"):
            left.append(mover)
    for mover in left:
        if mover.role == "rigid":
            _check(mover.reference.find(), kind if mover.selected else "move")
    if any(mover.selected for mover in movers) and not any(mover.selected for mover in left):
        name = next(mover.reference.name for mover in movers if mover.selected)
        raise InputError(f'object "{name}": its transform is locked; unlock it, or deform the object instead')
    return left


def is_locked(ob: bpy.types.Object) -> bool:
    """Is all of the object's location locked, so that it cannot give way as a whole?"""
    return all(ob.lock_location)


def may_turn(ob: bpy.types.Object) -> bool:
    """Is none of the object's rotation locked?"""
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
            names = ", ".join(axis for axis, lock in zip(AXES, axes, strict=True) if lock)
            raise InputError(
                f'object "{ob.name}": its {what} is locked along {names}, which cannot be kept while the rest gives '
                "way; unlock it, lock all of it, or make the object an obstacle"
            )
