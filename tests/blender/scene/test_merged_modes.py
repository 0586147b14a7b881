# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that Edit Mode and Object Mode show alike are solved for once, and both are tested after each write."""

from dataclasses import replace
from typing import Any

import bpy
import pytest
from building import add_modifier, edit_mode, shift
from stacks import add_body, posed, pushed_and_smooth

from stiv.blender import BlenderEdit, EditSettings
from stiv.blender.scene import merged_modes

SETTINGS = EditSettings(object_response="deform", guard="both")


def begin(ob: Any) -> BlenderEdit:
    add_body()
    edit_mode(ob)
    bpy.ops.mesh.select_all(action="SELECT")
    return BlenderEdit.begin(bpy.context, SETTINGS, "move")


def shown_in(edit: BlenderEdit) -> list[set[str]]:
    return [set(mesh.shown_in) for mesh in edit.assembly.meshes if mesh.owner.name == "Piece"]


def test_equal_modes_are_one_mesh_until_object_mode_shows_another(monkeypatch: pytest.MonkeyPatch) -> None:
    edit = begin(pushed_and_smooth())
    assert shown_in(edit) == [{"shown", "viewport", "render"}]
    edit.drag(shift(0, 0, -0.1))
    assert edit.write().passed
    read = merged_modes.read_positions_of

    def lower(*given: Any) -> Any:
        return [replace(each, local=each.local - [0, 0, 0.3]) for each in read(*given)]

    edit.drag(shift(0, 0, -0.15))
    monkeypatch.setattr(merged_modes, "read_positions_of", lower)
    report = edit.write()
    assert not report.passed and "Piece: its modifiers cannot be followed (0.3)" in report.message
    monkeypatch.undo()
    edit.drag(shift(0, 0, -0.6))
    assert edit.write().passed


@pytest.mark.parametrize("make", [posed, lambda: hidden_in_edit_mode(), lambda: with_an_empty_key()])
def test_what_only_one_mode_shows_stays_guarded(make: Any) -> None:
    edit = begin(make())
    assert shown_in(edit) == [{"shown"}, {"viewport", "render"}]
    edit.drag(shift(0, 0, -0.6))
    assert edit.write().passed


def with_an_empty_key() -> Any:
    """A piece with a new shape key at half its value: Object Mode shows half of each edit."""
    ob = pushed_and_smooth()
    ob.shape_key_add(name="Basis")
    ob.shape_key_add(name="New").value = 0.5
    ob.active_shape_key_index = 1
    return ob


def hidden_in_edit_mode() -> Any:
    """A piece with a modifier that does nothing at the start; Edit Mode does not show it."""
    ob = pushed_and_smooth()
    add_modifier(ob, "WELD", merge_threshold=1e-4, show_in_editmode=False)
    return ob
