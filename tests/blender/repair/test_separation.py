# SPDX-License-Identifier: GPL-3.0-or-later
"""Separation where the objects do not move as they should."""

from math import pi

import bpy
import pytest
from building import add, add_cube, add_modifier, edit_mode, select, snapshot

import stiv
from stiv import deadlines
from stiv.blender import EditSettings, separate


def test_an_object_whose_shape_changes_is_named_with_its_modifiers() -> None:
    rig = add("Rig", bpy.data.armatures.new("Rig"))
    edit_mode(rig)
    bone = rig.data.edit_bones.new("Bone")
    bone.head, bone.tail = (0, 0, 0), (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    rig.pose.bones["Bone"].rotation_mode = "XYZ"
    rig.pose.bones["Bone"].rotation_euler.y = pi  # so the skin moves the other way
    cube = add_cube("Cube", (0, 0, 0.3))
    cube.vertex_groups.new(name="Bone").add(range(8), 1, "REPLACE")
    add_modifier(cube, "ARMATURE", object=rig)
    add_cube("Wall", (1.5, 0.2, 0.1))
    select(cube)
    before = snapshot()
    with pytest.raises(stiv.InputError, match=r"^Cube: its shape changes as it moves; apply its modifiers$"):
        separate(bpy.context, EditSettings())
    assert snapshot() == before


def test_locks_that_hold_an_object_are_named() -> None:
    cube = add_cube("Cube")
    add_cube("Wall", (1.5, 0.2, 0.1))
    cube.lock_location[0] = True
    select(cube)
    with pytest.raises(stiv.InputError, match=r"^Cube: still intersects Wall; clear its locks$"):
        separate(bpy.context, EditSettings())


def test_a_time_limit_without_a_way_changes_nothing_and_names_the_way_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(deadlines, "LEAST_TIME", 1e-9)
    cube = add_cube("Cube")
    add_cube("Wall", (1.5, 0.2, 0.1))
    select(cube)
    before = snapshot()
    with pytest.raises(stiv.InputError, match=r"^time limit reached; raise it, or select fewer objects$"):
        separate(bpy.context, EditSettings(time_budget=1e-9))
    assert snapshot() == before
    assert not separate(bpy.context, EditSettings(time_budget=1000.0)).out_of_time
