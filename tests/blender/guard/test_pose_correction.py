# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses and values of shape keys after any tool: corrected from the accepted state, exact if free, named if not."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any

import bpy
import mathutils
import numpy as np
import pytest
from building import add_cube, evaluated
from torn_sheets import CROSSING, add_key, cutting_faces, named, torn_sheet

from blend_fixtures.characters import make_character, select_bones
from stiv.blender import AcceptedScene, EditSettings, check_scene, find_intersections, guard_result

SETTINGS = EditSettings(separation=0.01)


@pytest.fixture
def arm() -> Any:
    """The upper arm of a character in the T-pose, above a box below its hand."""
    rig, _ = make_character(0.1)
    add_cube("Box", (1.3, 0, 0.6), 0.3)
    select_bones(rig, "Arm.L")
    bpy.context.view_layer.update()
    return rig.pose.bones["Arm.L"]


def guarded(change: Callable[[], Any]) -> Any:
    accepted = AcceptedScene.read(bpy.context, find_intersections(bpy.context, SETTINGS))
    change()
    bpy.context.view_layer.update()
    return guard_result(bpy.context, SETTINGS, accepted)


def box_pairs() -> list[Any]:
    """Intersections with the box; skin at joints may fold."""
    return [pair for pair in check_scene(bpy.context).pairs if "Box" in (pair.first.object, pair.second.object)]


def lower(bone: Any, degrees: float) -> None:
    """Rotate a bone about the world's Y, which is one of its own axes."""
    axis = bone.bone.matrix_local.to_3x3().inverted() @ mathutils.Vector((0, 1, 0))
    if bone.rotation_mode == "QUATERNION":
        bone.rotation_quaternion = mathutils.Quaternion(axis, math.radians(degrees))
    else:
        bone.rotation_euler = math.radians(degrees) * np.round(axis)


def angle(arm: Any) -> float:
    return math.degrees(arm.matrix_basis.to_quaternion().angle)


@pytest.mark.parametrize("mode", ["XYZ", "QUATERNION"])
def test_a_pose_into_a_box_is_corrected(arm: Any, mode: str) -> None:
    arm.rotation_mode = mode
    outcome = guarded(lambda: lower(arm, 60))
    assert outcome.wrote and outcome.corrected == ["Rig"] and outcome.reason == ""
    assert 15 < angle(arm) < 40 and box_pairs() == []
    if mode == "XYZ":
        assert sum(each != 0 for each in arm.rotation_euler) == 1  # only the changed angle responds


@pytest.mark.parametrize("degrees", [20, 120])
def test_folded_joints_are_named_as_in_edits(arm: Any, degrees: float) -> None:
    """They are not tested, so that a result with such faces is not called free in silence."""
    bpy.data.objects["Box"].hide_set(True)
    bpy.context.view_layer.update()
    forearm = arm.children[0]
    axis = forearm.bone.matrix_local.to_3x3().inverted() @ mathutils.Vector((0, 0, -1))
    turned = mathutils.Quaternion(axis, math.radians(degrees))
    outcome = guarded(lambda: setattr(forearm, "rotation_quaternion", turned))
    folded = len({each for pair in check_scene(bpy.context).pairs for each in (pair.first, pair.second)})
    if degrees < 90:
        assert outcome.notes == [] and folded == 0
        return
    found = re.fullmatch(r"Body: (\d+) faces at joints cut into each other", *outcome.notes)
    assert found and 0 < int(found[1]) == pytest.approx(folded, abs=4)


def test_faces_that_a_shape_key_cuts_at_a_torn_seam_are_named() -> None:
    sheet = torn_sheet()
    key = add_key(sheet, "Cross", CROSSING)
    for value, count in ((0.0, 0), (1.0, 2)):
        outcome = guarded(lambda value=value: setattr(key, "value", value))
        assert cutting_faces(sheet) == count
        assert [named(note) for note in outcome.notes] == ([count] if count else [])


def test_a_free_pose_stays_to_the_last_bit(arm: Any) -> None:
    arm.rotation_mode = "QUATERNION"
    outcome = guarded(lambda: lower(arm, -30))
    corrected = tuple(arm.rotation_quaternion)
    lower(arm, -30)
    assert not outcome.wrote and corrected == tuple(arm.rotation_quaternion)


def test_a_pasted_pose_of_several_bones_and_a_locked_typed_channel(arm: Any) -> None:
    rig = arm.id_data
    arm.rotation_mode, arm.lock_rotation = "XYZ", (True, True, True)
    forearm = rig.pose.bones["Forearm.L"]
    forearm.rotation_mode = "XYZ"

    def paste() -> None:
        lower(arm, 25)
        lower(forearm, 80)
        rig.pose.bones["Head"].scale = (1.1, 1.1, 1.1)

    outcome = guarded(paste)
    assert outcome.wrote and box_pairs() == []
    assert angle(arm) + angle(forearm) > 20 and rig.pose.bones["Head"].scale.x == pytest.approx(1.1, abs=0.01)


def test_a_moved_target_of_inverse_kinematics_is_corrected(arm: Any) -> None:
    rig = arm.id_data
    bpy.ops.object.mode_set(mode="EDIT")
    target = rig.data.edit_bones.new("Target")
    target.head, target.tail = (1.5, 0, 1.35), (1.7, 0, 1.35)
    bpy.ops.object.mode_set(mode="POSE")
    constraint = rig.pose.bones["Forearm.L"].constraints.new("IK")
    constraint.target, constraint.subtarget, constraint.chain_count = rig, "Target", 2
    bpy.context.view_layer.update()
    target = rig.pose.bones["Target"]
    down = target.bone.matrix_local.to_3x3().inverted() @ mathutils.Vector((-0.2, 0, -0.9))
    outcome = guarded(lambda: setattr(target, "location", down))
    assert outcome.wrote and box_pairs() == []
    assert (target.location - down).length > 0.02


def test_keyframes_follow_the_correction_with_auto_keying(arm: Any) -> None:
    arm.rotation_mode = "XYZ"
    bpy.context.scene.tool_settings.use_keyframe_insert_auto = True

    def rotate() -> None:
        lower(arm, 60)
        arm.keyframe_insert("rotation_euler")

    guarded(rotate)
    corrected = angle(arm)
    bpy.context.scene.frame_set(bpy.context.scene.frame_current)
    assert angle(arm) == pytest.approx(corrected, abs=1e-4) and corrected < 40 and box_pairs() == []


def test_a_pose_that_cannot_be_followed_is_named(arm: Any) -> None:
    rig = arm.id_data
    arm.rotation_mode = "XYZ"
    assert guarded(lambda: lower(arm, 5)).reason == ""
    driver = rig.pose.bones["Head"].driver_add("location", 0).driver
    variable = driver.variables.new()
    variable.targets[0].id, variable.targets[0].data_path = rig, 'pose.bones["Head"].location[0]'
    driver.expression = variable.name
    outcome = guarded(lambda: lower(arm, 60))
    assert not outcome.wrote and "depends on itself" in outcome.reason and outcome.pairs
    assert angle(arm) == pytest.approx(60, abs=0.1)


def test_a_pose_and_a_moved_object_at_once(arm: Any) -> None:
    arm.rotation_mode = "XYZ"
    box = bpy.data.objects["Box"]

    def change() -> None:
        lower(arm, 30)
        box.location.z = 1.0

    outcome = guarded(change)
    assert outcome.wrote and box_pairs() == [] and box.location.z < 0.96


@pytest.fixture
def ball() -> Any:
    add_cube("Wall", (2.5, 0, 0), 0.5, scale=(1, 4, 4))
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1, segments=16, ring_count=8)
    ball = bpy.context.object
    ball.shape_key_add(name="Basis")
    for name, factor in (("Wide", 3), ("Shift", 1)):
        key = ball.shape_key_add(name=name)
        key.value = 0.0
        for point in key.data:
            point.co = (point.co.x * factor + (0.5 if factor == 1 else 0), point.co.y, point.co.z)
    return ball


def values(ball: Any) -> list[float]:
    return [block.value for block in ball.data.shape_keys.key_blocks[1:]]


def test_values_of_shape_keys_are_corrected_and_free_ones_stay(ball: Any) -> None:
    blocks = ball.data.shape_keys.key_blocks
    assert not guarded(lambda: setattr(blocks["Wide"], "value", 0.3)).wrote
    assert blocks["Wide"].value == np.float32(0.3)
    outcome = guarded(lambda: setattr(blocks["Wide"], "value", 1.0))
    assert outcome.wrote and outcome.corrected == [ball.name] and check_scene(bpy.context).pairs == ()
    assert 0.45 < blocks["Wide"].value < 0.55 and blocks["Shift"].value == 0

    def both() -> None:
        blocks["Wide"].value, blocks["Shift"].value = 0.4, 0.9

    outcome = guarded(both)
    assert outcome.wrote and check_scene(bpy.context).pairs == ()
    assert evaluated(ball)[:, 0].max() > 1.9


def test_driven_values_are_left_to_their_drivers(ball: Any) -> None:
    blocks = ball.data.shape_keys.key_blocks
    driver = blocks["Shift"].driver_add("value").driver
    variable = driver.variables.new()
    variable.targets[0].id_type, variable.targets[0].id = "KEY", ball.data.shape_keys
    variable.targets[0].data_path = 'key_blocks["Wide"].value'
    driver.expression = variable.name
    bpy.context.view_layer.update()
    outcome = guarded(lambda: setattr(blocks["Wide"], "value", 1.0))
    assert outcome.wrote and check_scene(bpy.context).pairs == ()
    assert 0.3 < blocks["Wide"].value < 0.45 and blocks["Shift"].value == pytest.approx(blocks["Wide"].value)
