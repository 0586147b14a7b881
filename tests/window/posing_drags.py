# SPDX-License-Identifier: GPL-3.0-or-later
"""Drags in Pose Mode: an arm of a character onto a box, by the extension's keys and by Blender's own."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import bmesh
import bpy
import mathutils
import scenes
from playing import click, start
from simulation import Steps, Window

sys.path.append(str(Path(__file__).resolve().parents[2]))

from blend_fixtures.characters import make_character, select_bones

HAND = (1.5, 0.0, 1.35)
BELOW_BOX = (1.1, 0.0, 0.4)


def _prepare(window: Window) -> Steps:
    with window.override():
        scenes.clear()
        rig, _ = make_character(0.07)
        scenes.add_mesh("Box", lambda content: bmesh.ops.create_cube(content, size=0.5), (1.2, 0.0, 0.55))
        rig.show_in_front = True
        select_bones(rig, "Arm.L")
        bpy.context.scene.stiv.separation = 0.01
        scenes.look_from_above(window.area)
        view = window.area.spaces.active.region_3d
        view.view_rotation = mathutils.Euler((math.radians(90.0), 0.0, 0.0)).to_quaternion()
        view.view_location, view.view_distance = (0.0, 0.0, 0.4), 6.0
        view.update()
        bpy.ops.ed.undo_push(message="start")
    yield from window.settle()
    yield from window.rest_at(HAND)


def _arm() -> list[float]:
    return list(bpy.data.objects["Rig"].pose.bones["Arm.L"].rotation_quaternion)


def _angle() -> float:
    return math.degrees(bpy.data.objects["Rig"].pose.bones["Arm.L"].rotation_quaternion.angle)


def posed_arm(window: Window) -> Steps:
    """An arm rotated onto a box stops there: one undo step, and redo reproduces the bits."""
    yield from _prepare(window)
    before = _arm()
    yield from start(window, "R")
    yield from window.glide(window.pixel(BELOW_BOX), 20)
    yield from window.settle(20)
    window.picture("posed_arm")
    assert 15 < _angle() < 40, _angle()
    yield from click(window)
    confirmed = _arm()
    assert bpy.context.mode == "POSE"
    yield from window.undo()
    assert _arm() == before, _arm()
    yield from window.redo()
    assert _arm() == confirmed, _arm()
    yield from start(window, "R")
    yield from window.glide(window.pixel(HAND), 8)
    yield from click(window, "ESC")
    assert _arm() == confirmed, _arm()


def live_keys_in_pose_mode(window: Window) -> Steps:
    """With Live Collisions, Blender's G rotates a connected bone, which stops at the box."""
    yield from _prepare(window)
    select_bones(bpy.data.objects["Rig"], "Forearm.L")
    bpy.context.scene.stiv.live_transforms = True
    yield from window.settle(10)
    window.key("G")
    yield from window.until(window.dragging, "a running transform")
    yield from window.glide(window.pixel((1.0, 0.0, 0.6)), 20)
    yield from window.settle(20)
    yield from click(window)
    bone = bpy.data.objects["Rig"].pose.bones["Forearm.L"]
    assert 15 < math.degrees(bone.rotation_quaternion.angle) < 80, bone.rotation_quaternion
    assert bone.location.length == 0.0
    bpy.context.scene.stiv.live_transforms = bpy.context.scene.stiv.live_guard = False


def guarded_pose(window: Window) -> Steps:
    """Blender's own R through the box: the live guard corrects it in the same undo step, with Auto Keying."""
    yield from _prepare(window)
    bpy.context.scene.stiv.live_guard = True
    bpy.context.scene.tool_settings.use_keyframe_insert_auto = True
    yield from window.settle(20)
    before = _arm()
    window.key("R")
    yield from window.until(lambda: len(window.handle.modal_operators) > 0, "Blender's rotation")
    yield from window.glide(window.pixel(BELOW_BOX), 20)
    through = _angle()
    window.picture("guarded_pose_before")
    window.key("LEFTMOUSE")
    yield from window.until(lambda: 10 < _angle() < through - 5, "a correction")
    yield from window.settle(10)
    window.picture("guarded_pose")
    assert through > 45 and 15 < _angle() < 40, (through, _angle())
    corrected = _arm()
    bpy.context.scene.frame_set(bpy.context.scene.frame_current)
    assert max(abs(a - b) for a, b in zip(_arm(), corrected, strict=True)) < 1e-5, (_arm(), corrected)
    yield from window.undo()
    yield from window.settle(20)
    assert _arm() == before, _arm()
    bpy.context.scene.tool_settings.use_keyframe_insert_auto = False
    bpy.context.scene.stiv.live_guard = False


POSING_DRAGS = {scenario.__name__: scenario for scenario in (posed_arm, live_keys_in_pose_mode, guarded_pose)}
