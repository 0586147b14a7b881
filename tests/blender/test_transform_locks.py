# SPDX-License-Identifier: GPL-3.0-or-later
"""Locked transforms: kept to the bit, or refused by name."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import add_cube, add_grid, evaluated, select, shift, stretch, turn

import stiv
from stiv.blender import BlenderEdit, EditSettings, check_scene

ALL = (True, True, True)


def begin(kind: str = "move", **settings: Any) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, EditSettings(**settings), kind)


def test_what_is_locked_stays_and_the_others_move() -> None:
    locked, other = add_cube("Locked", lock_location=ALL), add_cube("Other", (3, 0, 0))
    select(locked, other)
    edit = begin()
    assert {each.name: each.role for each in edit.summary.participants} == {"Locked": "obstacle", "Other": "rigid"}
    edit.apply(shift(-2))
    assert edit.write().passed
    assert tuple(locked.location) == (0, 0, 0)
    assert 2.0 < other.location.x < 2.01
    assert check_scene(bpy.context).pairs == ()


def test_locked_rotations_are_kept_while_it_gives_way() -> None:
    """A bar that would be turned by a block at one of its ends."""
    bar = add_cube("Bar", scale=(0.2, 2, 0.2), rotation_euler=(0, 0, 0.3))
    add_cube("Block", (1.5, 1.5, 0), 0.5)
    select(bar)
    start = evaluated(bar)
    for locks in ((False, False, False), ALL, (False, False, True)):
        bar.lock_rotation = locks
        edit = begin()
        edit.apply(shift(2.0))
        assert edit.write().passed
        turned = np.abs(evaluated(bar) - evaluated(bar).mean(axis=0) - start + start.mean(axis=0)).max() > 1e-4
        assert turned == (not any(locks))
        assert check_scene(bpy.context).pairs == ()
        edit.restore()


def test_a_locked_rotation_is_moved_about_the_pivot_without_turning() -> None:
    cube = add_cube("Cube", (1, 0, 0), lock_rotation=ALL)
    select(cube)
    edit = begin("rotate")
    edit.apply(turn(np.pi / 2, "Z"))
    assert edit.write().passed
    assert tuple(cube.location) == pytest.approx((0, 1, 0), abs=1e-6)
    assert tuple(cube.rotation_euler) == (0, 0, 0)


@pytest.mark.parametrize(
    ("kind", "locks", "message"),
    [
        ("move", {"lock_location": (True, False, True)}, "its location is locked along X, Z"),
        ("move", {"lock_location": ALL}, "its transform is locked"),
        ("rotate", {"lock_rotation": (False, True, False)}, "its rotation is locked along Y"),
        ("rotate", {"lock_location": ALL}, "its location is locked along X, Y, Z"),
        ("scale", {"lock_scale": (False, False, True)}, "its scale is locked along Z"),
        ("scale", {"lock_scale": ALL, "lock_location": ALL}, "its transform is locked"),
    ],
)
def test_locks_that_cannot_be_kept_are_refused(kind: str, locks: dict, message: str) -> None:
    select(add_cube("Cube", **locks))
    with pytest.raises(stiv.InputError, match=f'object "Cube": {message}'):
        begin(kind)


def test_scaling_needs_no_rotation_and_deforming_no_transform() -> None:
    cube = add_cube("Cube", lock_rotation=ALL)
    select(cube)
    edit = begin("scale")
    assert edit.apply(stretch(1.5)).status == "reached"
    cube.lock_location = cube.lock_scale = ALL
    assert begin(object_response="deform").apply(shift(1)).status == "reached"


def test_a_locked_object_does_not_give_way_by_itself() -> None:
    pusher, locked = add_cube("Pusher"), add_cube("Locked", (2.5, 0, 0), lock_location=(False, True, False))
    add_grid("Floor", 1, 9.0, (0, 0, -4), lock_location=ALL)
    select(pusher)
    edit = begin(responders="all")
    assert {each.name: each.role for each in edit.summary.participants} == {
        "Pusher": "rigid", "Locked": "obstacle", "Floor": "obstacle",
    }  # fmt: skip
    edit.apply(shift(2))
    assert edit.write().passed
    assert tuple(locked.location) == (2.5, 0, 0)
