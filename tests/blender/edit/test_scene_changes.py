# SPDX-License-Identifier: GPL-3.0-or-later
"""Undo, redo, another frame and another file during an edit: it continues, or ends with the scene unchanged."""

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from building import add_cube, add_grid, evaluated, select, shift, snapshot

from stiv.blender import BlenderEdit, EditSettings, SceneChangedError


def cube_above_floor() -> Any:
    add_grid("Floor", 4, 4.0)
    cube = add_cube("Cübe A", (0.3, 0, 2))
    select(cube)
    return cube


def begin() -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, EditSettings(), "move")


def cube() -> Any:
    """Looked up at each use: undo makes new objects."""
    return bpy.data.objects["Cübe A"]


def test_an_edit_continues_after_undo_and_redo() -> None:
    cube_above_floor()
    bpy.ops.ed.undo_push(message="begin")
    add_cube("Other", (9, 9, 9))
    select(cube())
    bpy.ops.ed.undo_push(message="other")
    before = snapshot()
    edit = begin()
    edit.drag(shift(x=1))
    assert edit.write().passed
    for step in (bpy.ops.ed.undo, bpy.ops.ed.redo):
        assert step() == {"FINISHED"}
        edit.drag(shift(x=2))
        if "Other" in bpy.data.objects:
            assert edit.write().passed
            assert cube().location.x == pytest.approx(2.3)
        else:
            with pytest.raises(SceneChangedError, match=r"shown, hidden or changed|is gone"):
                edit.write()
    edit.restore()
    assert snapshot() == before


def test_an_obstacle_moved_by_another_frame_is_found() -> None:
    moving = cube_above_floor()
    floor = bpy.data.objects["Floor"]
    for frame, height in ((1, 0.0), (10, 1.5)):
        floor.location.z = height
        floor.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_set(1)
    select(moving)
    edit = begin()
    edit.drag(shift(x=0.5))
    assert edit.write().passed
    bpy.context.scene.frame_set(10)
    report = edit.write()
    assert not report.passed and "Floor: Blender shows it 1.5 away" in report.message
    assert moving.location.x == pytest.approx(0.8)  # where it was shown last
    bpy.context.scene.frame_set(1)
    edit.drag(shift(x=1))
    assert edit.write().passed
    assert evaluated(moving)[:, 2].min() == pytest.approx(1.0)


@pytest.mark.parametrize("call", ["write", "restore"])
def test_another_file_ends_the_edit_and_is_unchanged(tmp_path: Path, call: str) -> None:
    cube_above_floor()
    path = str(tmp_path / "fremde Datei.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    edit = begin()
    edit.drag(shift(x=1))
    bpy.ops.wm.open_mainfile(filepath=path)
    before = snapshot()
    if call == "write":
        edit.drag(shift(x=2))
    with pytest.raises(SceneChangedError, match="Cübe A is gone"):
        getattr(edit, call)()
    assert snapshot() == before
    assert np.allclose(cube().location, (0.3, 0, 2))
