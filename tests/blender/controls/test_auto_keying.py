# SPDX-License-Identifier: GPL-3.0-or-later
"""Auto Keying inserts the same keyframes as after Blender's own move."""

from typing import Any

import bpy
import pytest
from building import add_cube, select

from blend_fixtures.characters import select_bones
from stiv.blender.controls.auto_keying import insert_auto_keyframes
from stiv.blender.scene.animation_curves import own_curves

SHIFT = (0.2, 0.1, 0.3)
CHOICES = {
    "needed": {"needed": True},
    "all": {"needed": False},
    "keying set": {"needed": True, "keying_set": "Rotation"},
    "larger keying set": {"needed": True, "keying_set": "Location & Rotation"},
    "no keying set": {"needed": False, "keying_set": None},
    "available": {"needed": True, "available": True},
}


def choose(needed: bool, available: bool = False, **chosen: str | None) -> None:
    tools, sets = bpy.context.scene.tool_settings, bpy.context.scene.keying_sets_all
    tools.use_keyframe_insert_auto = True
    bpy.context.preferences.edit.use_auto_keyframe_insert_needed = needed
    bpy.context.preferences.edit.use_keyframe_insert_available = available
    if "keying_set" in chosen:
        tools.use_keyframe_insert_keyingset = True
        sets.active = sets.get(chosen["keying_set"] or "")


def make_cube() -> Any:
    cube = add_cube("Cube")
    select(cube)
    return cube


def make_bone() -> Any:
    bpy.ops.object.armature_add()
    rig = bpy.context.object
    bpy.ops.object.mode_set(mode="POSE")
    select_bones(rig, "Bone")
    return rig.pose.bones[0]


def keyed(owner: Any) -> set[tuple[str, int]]:
    return {(curve.data_path, curve.array_index) for curve in own_curves(owner.id_data)}


@pytest.mark.parametrize("make", [make_cube, make_bone])
@pytest.mark.parametrize("choice", CHOICES)
def test_the_same_properties_are_keyed_as_by_blender(choice: str, make: Any) -> None:
    found = []
    for move in (lambda owner: bpy.ops.transform.translate(value=SHIFT), move_and_key):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        owner = make()
        choose(**CHOICES[choice])
        move(owner)
        found.append(keyed(owner))
    assert found[0] == found[1]
    assert bool(found[0]) != (choice == "available")


def move_and_key(owner: Any) -> None:
    owner.location = SHIFT
    insert_auto_keyframes(bpy.context, [(owner, {"location"})])


def test_what_has_not_changed_is_not_keyed() -> None:
    cube, other = make_cube(), add_cube("Other", (5, 0, 0))
    choose(needed=False)
    insert_auto_keyframes(bpy.context, [(cube, {"location"}), (other, ())])
    assert keyed(cube) and not keyed(other)
    choose(needed=False, keying_set="Scale")
    select(other)
    insert_auto_keyframes(bpy.context, [(cube, {"location"}), (other, ())])
    assert ("scale", 0) in keyed(cube) and not keyed(other)
