# SPDX-License-Identifier: GPL-3.0-or-later
"""Frame times: where drags of a script go, what is counted, that a script which reshapes runs too."""

from pathlib import Path

import bpy
import numpy as np
import pytest

import stiv
from benchmarks.sessions.blender_profile import shares_with_blender
from benchmarks.sessions.frame_times import frame_times, goal_matrix
from stiv.blender.scripts.blend_files import open_blend
from stiv.blender.verify.scene_check import find_pairs, read_surface
from stiv.edit_scripts import EditScript, EditStep, read_edit_script

pytestmark = pytest.mark.usefixtures("registered")

FIXTURES = Path(__file__).resolve().parents[2] / "blend_fixtures"


def settings_of(scene):
    from stiv_addon.scene.edit_settings import edit_settings

    return edit_settings(scene)


def test_a_drag_continues_from_its_own_start():
    moved = EditStep("move", "OBJECT", ("A",), {"value": (0.5, 0, -1)})
    assert np.array_equal(goal_matrix(moved, 4, np.ones(3))[:3, 3], [2, 0, -4])
    grown = EditStep("scale", "EDIT", ("A",), {"value": (2, 1, 1)})
    assert np.array_equal(goal_matrix(grown, 3, np.array([1, 5, 0])) @ [2, 7, 1, 1], [9, 7, 1, 1])


def test_every_frame_of_a_script_is_timed_and_leaves_the_scene_free():
    open_blend(FIXTURES / "sphere_along_wall.blend")
    script = read_edit_script(FIXTURES / "sphere_along_wall.edits.json")
    before = read_surface(bpy.context).positions
    frames = frame_times(script, settings_of)
    assert len(frames) == len(script) and all(frame.passed for frame in frames)
    assert any(frame.touches for frame in frames)
    assert all(frame.seconds >= frame.evaluation >= 0 for frame in frames) and sum(f.evaluation for f in frames) > 0
    assert abs(read_surface(bpy.context).positions - before).max() > 0.05
    assert find_pairs(read_surface(bpy.context)) == ()
    shares = shares_with_blender(frames, sum(frame.seconds for frame in frames))
    assert sum(shares.values()) == pytest.approx(1) and shares["detection"] > 0 and shares["evaluation"] > 0


def test_operators_that_reshape_are_frames_too():
    open_blend(FIXTURES / "sphere_along_wall.blend")
    name = next(ob.name for ob in bpy.context.scene.objects if ob.type == "MESH")
    (frame,) = frame_times(EditScript((EditStep("contract", "OBJECT", (name,), {"steps": 1}),)), settings_of)
    assert frame.passed and not frame.touches and frame.seconds > 0


def test_rotations_are_refused():
    open_blend(FIXTURES / "sphere_along_wall.blend")
    name = next(ob.name for ob in bpy.context.scene.objects if ob.type == "MESH")
    turned = EditStep("rotate", "OBJECT", (name,), {"angle": 1.0, "axis": (0, 0, 1)})
    with pytest.raises(stiv.InputError, match="rotate"):
        frame_times(EditScript((turned,)), settings_of)
