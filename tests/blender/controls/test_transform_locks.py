# SPDX-License-Identifier: GPL-3.0-or-later
"""Locked transforms: preserved exactly, or refused by name."""

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


def test_locked_objects_stay_and_the_others_move() -> None:
    locked, other = add_cube("Locked", lock_location=ALL), add_cube("Other", (3, 0, 0))
    select(locked, other)
    edit = begin()
    assert {each.name: each.role for each in edit.summary.participants} == {"Locked": "obstacle", "Other": "rigid"}
    edit.apply(shift(-2))
    assert edit.write().passed
    assert tuple(locked.location) == (0, 0, 0)
    assert 2.0 < other.location.x < 2.01
    assert check_scene(bpy.context).pairs == ()


def test_locked_rotations_are_respected_on_contact() -> None:
    """A bar that would be turned by a block at one of its ends."""
    bar = add_cube("Bar", scale=(0.2, 2, 0.2), rotation_euler=(0, 0, 0.3))
    add_cube("Block", (1.5, 1.5, 0), 0.5)
    select(bar)
    start = evaluated(bar)
    for locks in ((False, False, False), ALL, (False, False, True)):
        bar.lock_rotation = locks
        edit = begin(object_response="slide_and_turn")
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
        ("rotate", {"lock_location": (True, False, True)}, "its location is locked along X, Z"),
        ("move", {"lock_location": ALL}, "its transform is locked"),
        ("rotate", {"lock_rotation": (False, True, False)}, "its rotation is locked along Y"),
        ("rotate", {"lock_location": ALL}, "its location is locked along X, Y, Z"),
        ("scale", {"lock_scale": (False, False, True)}, "its scale is locked along Z"),
        ("scale", {"lock_scale": ALL, "lock_location": ALL}, "its transform is locked"),
    ],
)
def test_locks_that_cannot_be_respected_are_refused(kind: str, locks: dict, message: str) -> None:
    select(add_cube("Cube", **locks))
    with pytest.raises(stiv.InputError, match=f"Cube: {message}"):
        begin(kind)


@pytest.mark.parametrize("below_parent", [False, True])
@pytest.mark.parametrize("locks", [(True, False, False), (False, True, True), (False, False, True)])
def test_partly_locked_locations_move_and_yield_along_the_free_axes(
    locks: tuple[bool, bool, bool], below_parent: bool
) -> None:
    """A cube pushed down a slope of another: without locks it would slide aside along every axis."""
    cube = add_cube("Cube", (0.1, -0.2, 0.3), lock_location=locks, delta_location=(0.01, 0.02, 0.03))
    if below_parent:
        cube.parent = bpy.data.objects.new("Parent", None)
        bpy.context.collection.objects.link(cube.parent)
        cube.parent.rotation_euler, cube.parent.location = (0.4, -0.7, 1.1), (0.3, 0.1, -0.2)
        cube.parent.scale = (0.8, 0.8, 0.8)
    add_cube("Block", (2.9, 0.3, -2.4), 2.0, rotation_euler=(0.5, 0.6, 0.2))
    bpy.context.view_layer.update()
    select(cube)
    start = np.array(cube.location)
    edit = begin()
    edit.apply(shift(2.5, z=-2))
    assert edit.write().passed
    moved = np.array(cube.location) != start
    assert not moved[list(locks)].any()
    assert moved.any()
    assert tuple(cube.rotation_euler) == (0, 0, 0)
    assert check_scene(bpy.context).pairs == ()


def test_a_partly_locked_object_yields_along_its_free_axes() -> None:
    pusher = add_cube("Pusher")
    locked = add_cube("Locked", (2.5, 0.7, 0.4), lock_location=(False, True, False), rotation_euler=(0.2, 0.3, 0.4))
    select(pusher)
    edit = begin(responders="all")
    edit.apply(shift(2))
    assert edit.write().passed
    assert locked.location.x > 2.6
    assert locked.location.y == np.float32(0.7)
    assert check_scene(bpy.context).pairs == ()


def test_scaling_needs_no_rotation_and_deforming_no_transform() -> None:
    cube = add_cube("Cube", lock_rotation=ALL)
    select(cube)
    edit = begin("scale")
    assert edit.apply(stretch(1.5)).status == "reached"
    cube.lock_location = cube.lock_scale = ALL
    assert begin(object_response="deform").apply(shift(1)).status == "reached"


def test_a_locked_object_does_not_yield() -> None:
    pusher, locked = add_cube("Pusher"), add_cube("Locked", (2.5, 0, 0), lock_location=ALL)
    add_grid("Floor", 1, 9.0, (0, 0, -4), lock_location=ALL)
    select(pusher)
    edit = begin(responders="all")
    assert {each.name: each.role for each in edit.summary.participants} == {
        "Pusher": "rigid", "Locked": "obstacle", "Floor": "obstacle",
    }  # fmt: skip
    edit.apply(shift(2))
    assert edit.write().passed
    assert tuple(locked.location) == (2.5, 0, 0)
