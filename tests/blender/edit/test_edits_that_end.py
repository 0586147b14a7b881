# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits that end from outside, or are restored because Blender shows another state."""

import bpy
import pytest
from building import (
    add_cube,
    cube_above_floor,
    edit_mode,
    select,
    shift,
)

from stiv.blender import BlenderEdit, EditSettings, SceneChangedError


def begin(kind: str = "move", settings: EditSettings | None = None) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, settings or EditSettings(), kind)


@pytest.mark.parametrize("call", ["drag", "write", "restore"])
def test_a_deleted_object_ends_the_edit(call: str) -> None:
    cube = cube_above_floor()
    select(cube)
    edit = begin()
    edit.drag(shift(1))
    bpy.data.objects.remove(cube)
    if call == "drag":
        edit.drag(shift(2))
        call = "write"
    with pytest.raises(SceneChangedError, match="Cübe A is gone"):
        getattr(edit, call)()


def test_a_renamed_object_is_found() -> None:
    cube = cube_above_floor()
    select(cube)
    edit = begin()
    edit.drag(shift(1))
    cube.name = "Renamed"
    add_cube("Cübe A", (50, 0, 0)).hide_set(True)
    assert edit.write().passed
    assert cube.location.x == pytest.approx(1.3)


def test_leaving_the_mode_ends_the_edit() -> None:
    cube = cube_above_floor()
    edit_mode(cube)
    bpy.ops.mesh.select_all(action="SELECT")
    edit = begin()
    edit.drag(shift(1))
    bpy.ops.object.mode_set(mode="OBJECT")
    with pytest.raises(SceneChangedError, match="has left Edit Mode"):
        edit.write()


def test_a_different_evaluation_is_restored() -> None:
    """A constraint added during the edit holds the object: the last state that passed comes back."""
    cube = cube_above_floor()
    select(cube)
    edit = begin()
    edit.drag(shift(x=0.5))
    assert edit.write().passed
    held = cube.constraints.new("LIMIT_LOCATION")
    held.use_max_x, held.max_x = True, 1.0
    edit.drag(shift(x=2))
    report = edit.write()
    assert not report.passed
    assert "Cübe A" in report.message
    assert cube.location.x == pytest.approx(0.8)
    assert edit.drag(shift(x=0.6)).status == "reached"
    assert edit.write().passed


def test_an_intersecting_evaluation_is_restored() -> None:
    """An obstacle driven into the way during the edit is found on Blender's own evaluation."""
    cube = cube_above_floor()
    select(cube)
    edit = begin()
    edit.drag(shift(x=0.5))
    bpy.data.objects["Floor"].location.z = 1.5
    report = edit.write()
    assert not report.passed
    assert cube.location.x == pytest.approx(0.3)
