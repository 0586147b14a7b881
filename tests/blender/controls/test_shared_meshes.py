# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits of meshes that several objects share: all their surfaces move, and all stay free."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import (
    add,
    add_grid,
    add_modifier,
    edit_mode,
    evaluated,
    moved,
    select,
    shift,
    snapshot,
    stretch,
)

import stiv
from stiv.blender import BlenderEdit, EditSettings, Handles, check_scene, compare, correct_after_tool, read_state

DEFORM = EditSettings(object_response="deform")
PLACES = {
    "moved": {"location": (4, 0, 1.0), "scale": (1.5, 1.5, 1.5)},
    "turned": {"location": (4, 0, 1.0), "rotation_euler": (0.5, 0, 0.3)},
}


def add_twins(place: str) -> tuple[Any, Any]:
    """Two objects with one mesh, modifiers of their own, above a floor."""
    add_grid("Floor", 3, 9.0, (0, 0, -2))
    first = add_grid("First", 3, location=(-2, 0, 0.5))
    other = add("Öther", first.data, **PLACES[place])
    add_modifier(first, "SUBSURF", levels=1, render_levels=2)
    add_modifier(other, "SUBSURF", levels=2, render_levels=1, show_in_editmode=False)
    bpy.context.view_layer.update()
    return first, other


def begin(settings: EditSettings = DEFORM, kind: str = "move") -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, settings, kind)


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_every_user_stays_free(mode: str, place: str) -> None:
    """The other user meets the floor first, and stops the edit."""
    first, other = add_twins(place)
    select(first) if mode == "OBJECT" else edit_mode(first)
    before, start = snapshot(), evaluated(other)
    edit = begin()
    assert snapshot() == before
    assert "First: also moves 1 object that shares its mesh" in edit.summary.warnings
    edit.apply(shift(0.2, 0, -6))
    assert edit.write().passed
    assert np.abs(evaluated(other) - start).max() > 0.5
    for settings in (DEFORM, EditSettings(guard="render")):
        assert check_scene(bpy.context, settings).pairs == ()
    assert evaluated(first)[:, 2].min() > -2
    assert evaluated(other)[:, 2].min() > -2
    if mode == "EDIT":
        bpy.ops.object.mode_set(mode="OBJECT")
        assert evaluated(other)[:, 2].min() > -2
        assert check_scene(bpy.context, DEFORM).pairs == ()
        bpy.ops.object.mode_set(mode="EDIT")
    edit.restore()
    assert snapshot() == before


@pytest.mark.parametrize("place", PLACES)
def test_without_contact_the_vertices_follow_the_selected_object(place: str) -> None:
    first, other = add_twins(place)
    select(first)
    start, local = evaluated(first), np.array([vertex.co for vertex in first.data.vertices])
    edit = begin(kind="scale")
    edit.apply(stretch((1.2, 1.1, 1.0), first.location))
    assert edit.write().passed
    assert evaluated(first) == pytest.approx(moved(stretch((1.2, 1.1, 1.0), first.location), start), abs=1e-5)
    assert np.abs(np.array([vertex.co for vertex in first.data.vertices]) - local).max() > 0.1
    assert other.data == first.data


def test_both_users_selected_are_one_participant() -> None:
    first, other = add_twins("moved")
    select(other, first)
    edit = begin()
    assert [each.role for each in edit.control_sets] == ["cage"]
    edit.apply(shift(z=0.5))
    assert edit.write().passed


def test_a_user_that_moves_rigidly_is_refused() -> None:
    first, other = add_twins("moved")
    select(first, other)
    with pytest.raises(stiv.InputError, match="Öther: is deformed, and its parent moves; deselect one"):
        begin(EditSettings(object_response="deform", roles={"Öther": "rigid"}))


@pytest.mark.parametrize("place", PLACES)
def test_handles_move_all_users(place: str) -> None:
    first, _ = add_twins(place)
    group = first.vertex_groups.new(name="Handle")
    group.add([0, 1, 2, 3], 1.0, "REPLACE")
    select(first)
    settings = EditSettings(deformations={"First": "arap"}, handles={"First": Handles(groups=("Handle",))})
    edit = begin(settings)
    edit.apply(shift(z=-4))
    assert edit.write().passed
    assert check_scene(bpy.context, settings).pairs == ()


def test_the_live_guard_corrects_a_shared_mesh() -> None:
    first, other = add_twins("moved")
    select(first)
    accepted = read_state(bpy.context)
    for vertex in first.data.vertices:
        vertex.co.z -= 3
    first.data.update()
    changes = compare(accepted, read_state(bpy.context))
    assert correct_after_tool(bpy.context, DEFORM, accepted, changes).corrected
    assert evaluated(first)[:, 2].min() > -2
    assert evaluated(other)[:, 2].min() > -2
    assert check_scene(bpy.context, DEFORM).pairs == ()
