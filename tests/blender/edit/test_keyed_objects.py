# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects whose transform has keyframes move as with Blender's own tools: until the frame changes, or keyed."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import add_modifier, cube_above_floor, evaluated, select, shift, turn

import stiv
from stiv.blender import BlenderEdit, EditSettings, check_scene, drop, separate


def keyed_cube() -> Any:
    """A cube above a floor, with keyframes at frames 1 and 20, at frame 1."""
    cube = cube_above_floor()
    cube.keyframe_insert("location", frame=20)
    cube.keyframe_insert("location", frame=1)
    bpy.context.scene.frame_set(1)
    select(cube)
    return cube


def lowered() -> BlenderEdit:
    """An edit that lowers the selection through the floor."""
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert edit.drag(shift(z=-3.0)).status == "corrected"
    report = edit.write()
    assert report.passed, report.message
    return edit


def lowest(cube: Any) -> float:
    return float(evaluated(cube)[:, 2].min())


@pytest.mark.parametrize("keyed", [False, True])
def test_a_keyed_object_stops_at_contact_and_keeps_its_place_if_keyed(keyed: bool) -> None:
    cube = keyed_cube()
    edit = lowered()
    place = np.array(cube.location)
    assert 0 < lowest(cube) < 0.1 and check_scene(bpy.context).pairs == ()
    assert edit.reset_note == "Cübe A: the next frame resets it to its keyframes; key it"
    if keyed:
        edit.insert_keyframes(bpy.context)
    for frame in (20, 1):
        bpy.context.scene.frame_set(frame)
    np.testing.assert_allclose(cube.location, place if keyed else (0.3, 0, 2), atol=1e-6)
    assert check_scene(bpy.context).pairs == ()


def test_only_changed_properties_are_keyed() -> None:
    cube = keyed_cube()
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "rotate")
    assert edit.drag(turn(0.3, "Z", (0.3, 0, 2))).status == "reached" and edit.write().passed
    edit.insert_keyframes(bpy.context)
    bpy.context.scene.frame_set(20)
    assert cube.rotation_euler.z == pytest.approx(0.3, abs=1e-6)
    np.testing.assert_allclose(cube.location, (0.3, 0, 2), atol=1e-6)
    edit.restore()
    assert tuple(cube.rotation_euler) == (0, 0, 0)


def test_a_keyed_object_that_renders_finer_is_guarded_in_the_viewport() -> None:
    """Its render would show the keyframes, and not what has changed since."""
    cube = keyed_cube()
    add_modifier(cube, "SUBSURF", levels=0, render_levels=1)
    assert lowered().guard.choice == "viewport"


@pytest.mark.parametrize("tool", [drop, lambda context: separate(context, EditSettings())])
def test_tools_that_place_objects_for_good_refuse_keyframes(tool: Any) -> None:
    cube = keyed_cube()
    with pytest.raises(stiv.InputError, match="Cübe A: its transform is animated; clear the animation"):
        tool(bpy.context)
    assert tuple(cube.location) == pytest.approx((0.3, 0, 2))
