# SPDX-License-Identifier: GPL-3.0-or-later
"""Selected objects that nothing can collide with, such as lights and cameras: they move along with the others."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import cache

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.controls.control_set import ControlSet, Participant, UnlimitedGoal
from stiv.blender.controls.editable import check_placement, check_unconstrained
from stiv.blender.controls.motion import Motion
from stiv.blender.controls.object_transform import are_parallel, read_transform
from stiv.blender.controls.participants import followed_objects, may_have_surface
from stiv.blender.controls.placement_goals import PlacementGoal
from stiv.blender.controls.rigid_groups import RigidGroup, join_groups
from stiv.blender.controls.rigid_placement import make_rigid_set
from stiv.blender.controls.transform_locks import can_rotate, is_location_locked
from stiv.blender.scene.arrays import Floats, as_matrix
from stiv.blender.scene.message_fitting import first_and_others, fit_message
from stiv.blender.settings import EditSettings


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
    first = next((each.reference.find() for each in moving if each.role == "rigid" and each not in passengers), None)
    held = [each for each in passengers if not _moves_along(each.reference.find(), first, kind)]
    named = [each.reference.name for each in held if not is_location_locked(each.reference.find())]
    return [each for each in participants if each not in held], _held_note(named)


def _held_note(names: Sequence[str]) -> str:
    """The note on passengers that are left out; "" without any."""
    if not names:
        return ""
    return fit_message("{}{}: cannot move along; use Blender's own transform", *first_and_others(names))


def _moves_along(ob: bpy.types.Object, first: bpy.types.Object | None, kind: str) -> bool:
    """Can the object participate in any motion of this kind? `first` is the rigid object with which it is scaled."""
    try:
        check_placement(ob, may_be_keyed=True)
        for child in ob.children_recursive:
            check_unconstrained(child)
    except InputError:
        return False
    if kind == "rotate" and not (can_rotate(ob) and read_transform(ob).can_hold_rotations()):
        return False
    if kind == "scale" and any(ob.lock_scale):
        return False
    if kind == "scale" and first is not None and not are_parallel(*map(_unit_axes, (ob, first))):
        return False
    return not any(ob.lock_location)


def _unit_axes(ob: bpy.types.Object) -> Floats:
    """World directions of an object's axes as columns, (3, 3)."""
    return as_matrix(ob.matrix_world.normalized())[:3, :3]


def attach_passengers(groups: list[RigidGroup], shown: Collection[str]) -> tuple[list[RigidGroup], list[RigidGroup]]:
    """Attach selected groups without a surface to the first selected group with one.

    Returns the groups with a surface, and those that remain without one. shown: names of the objects with a surface.
    """
    solid = [group for group in groups if not group.surfaces.isdisjoint(shown)]
    passengers = [group for group in groups if group not in solid and group.roots[0].selected]
    first = next((group for group in solid if group.roots[0].selected), None)
    if first is None:
        return solid, passengers
    whole = join_groups([first, *passengers])
    return [whole if group is first else group for group in solid], []


@dataclass(frozen=True)
class PassengerGoal(UnlimitedGoal):
    """Takes a group without a surface to its goal, whatever contact does to the others."""

    rule: PlacementGoal

    @property
    def moves(self) -> bool:
        """The motion moves the group."""
        return True

    def goal(self, controls: Floats, last: Floats, motion: Motion) -> Floats:
        """Goal of centre and second row, (2, 3)."""
        return self.rule.goal(controls, last, motion)


def make_passenger_set(group: RigidGroup, settings: EditSettings, kind: str) -> ControlSet:
    """Control set of a group without a surface: it does not respond."""
    made = make_rigid_set(group, (), [], settings, kind)
    assert isinstance(made.rule, PlacementGoal)
    pinned = np.zeros_like(made.weights)
    return replace(
        made, deformation=_without_surface(), weights=pinned, max_weights=pinned, rule=PassengerGoal(made.rule)
    )


@cache
def _without_surface() -> stiv.Deformation:
    """From two controls to no vertices; always the same, so that the next edit can use the same session."""
    return stiv.linear(stiv.Weights(np.zeros(1, np.int32), np.empty(0, np.int32), np.empty(0), (0, 2)))
