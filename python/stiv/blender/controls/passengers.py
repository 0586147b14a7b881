# SPDX-License-Identifier: GPL-3.0-or-later
"""Selected objects that nothing can collide with, such as lights and cameras: they move along with the others."""

from collections.abc import Collection, Sequence

import bpy

from stiv import InputError
from stiv.blender.controls.control_set import Participant
from stiv.blender.controls.editable import check_placement, check_unconstrained
from stiv.blender.controls.object_transform import are_parallel, read_transform
from stiv.blender.controls.participants import followed_objects, may_have_surface
from stiv.blender.controls.rigid_groups import RigidGroup, join_groups
from stiv.blender.controls.transform_locks import can_rotate, is_location_locked
from stiv.blender.scene.arrays import Floats, as_matrix
from stiv.blender.scene.message_fitting import first_and_others, fit_message


def leave_held_passengers(
    context: bpy.types.Context, participants: Sequence[Participant], kind: str
) -> tuple[list[Participant], str]:
    """Leave out passengers that cannot move along freely, unless nothing else is selected.

    Returns the others, and a note that names those left out; "" if there are none. Locked locations need no note.
    """
    moving = [each for each in participants if each.selected]
    passengers = [each for each in moving if each.role == "rigid" and not may_have_surface(each.reference.find())]
    if passengers:
        followed = followed_objects(context)
        passengers = [each for each in passengers if each.reference.find() not in followed]
    solid = [each.reference.find() for each in moving if each not in passengers]
    if not solid:
        return list(participants), ""
    held = [each for each in passengers if not _moves_along(each.reference.find(), solid[0], kind)]
    named = [each.reference.name for each in held if not is_location_locked(each.reference.find())]
    return [each for each in participants if each not in held], _held_note(named)


def _held_note(names: Sequence[str]) -> str:
    """The note on passengers that are left out; "" without any."""
    if not names:
        return ""
    return fit_message("{}{}: cannot move along; use Blender's own transform", *first_and_others(names))


def _moves_along(ob: bpy.types.Object, first: bpy.types.Object, kind: str) -> bool:
    """Can the object participate in any motion of this kind? `first` is the object with which it is scaled."""
    try:
        check_placement(ob, may_be_keyed=True)
        for child in ob.children_recursive:
            check_unconstrained(child)
    except InputError:
        return False
    if kind == "rotate" and not (can_rotate(ob) and read_transform(ob).can_hold_rotations()):
        return False
    if kind == "scale" and (any(ob.lock_scale) or not are_parallel(*map(_unit_axes, (ob, first)))):
        return False
    return not any(ob.lock_location)


def _unit_axes(ob: bpy.types.Object) -> Floats:
    """World directions of an object's axes as columns, (3, 3)."""
    return as_matrix(ob.matrix_world.normalized())[:3, :3]


def add_passengers(groups: list[RigidGroup], shown: Collection[str]) -> list[RigidGroup]:
    """Attach selected groups without a surface to the first selected group with one.

    shown: names of the objects with a surface. Groups without one cannot collide, and cannot be solved for.
    """
    solid = [group for group in groups if not group.surfaces.isdisjoint(shown)]
    first = next((group for group in solid if group.roots[0].selected), None)
    if first is None:
        return solid
    passengers = [group for group in groups if group not in solid and group.roots[0].selected]
    whole = join_groups([first, *passengers])
    return [whole if group is first else group for group in solid]
