# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits in Edit Mode: the selected vertices and points alone, of several objects too."""

import bpy
import numpy as np
import pytest
from building import (
    add_cube,
    add_grid,
    add_modifier,
    cube_above_floor,
    edit_mode,
    evaluated,
    moved,
    select,
    shift,
    snapshot,
    stretch,
    turn,
)

from stiv.blender import BlenderEdit, EditSettings, check_scene

DEFORM = EditSettings(object_response="deform")


def begin(kind: str = "move", settings: EditSettings | None = None) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, settings or EditSettings(), kind)


def test_edit_mode_moves_the_selected_vertices_alone() -> None:
    grid = add_grid("Grid", 4, location=(0, 0, 1), scale=(1, -2, 1))
    add_modifier(grid, "SUBSURF", levels=2)
    add_cube("Ceiling", (0, 0, 4))
    edit_mode(grid)
    bpy.ops.mesh.select_all(action="DESELECT")
    grid.update_from_editmode()
    chosen = [vertex.index for vertex in grid.data.vertices if abs(vertex.co.x) < 0.1 and abs(vertex.co.y) < 0.1]
    import bmesh

    edit_mesh = bmesh.from_edit_mesh(grid.data)
    for vertex in edit_mesh.verts:
        vertex.select = vertex.index in chosen
    before = snapshot()
    edit = begin()
    assert snapshot() == before
    edit.apply(shift(z=4))
    assert edit.write().passed
    top = evaluated(grid)[:, 2].max()
    assert 2 < top < 3
    grid.update_from_editmode()
    still = [index for index in range(25) if index not in chosen]
    assert all(tuple(grid.data.vertices[index].co)[2] == 0 for index in still)
    assert bpy.context.mode == "EDIT_MESH"
    after, shown = snapshot(), evaluated(grid)
    with edit.start_shown():
        assert snapshot() == before and evaluated(grid)[:, 2].max() == 1
    assert snapshot() == after and np.array_equal(evaluated(grid), shown) and edit.is_shown()
    edit.restore()
    assert snapshot() == before
    edit.drag(shift(z=0.5))
    edit.write()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert max(vertex.co.z for vertex in grid.data.vertices) == pytest.approx(0.5)
    assert check_scene(bpy.context).pairs == ()


@pytest.mark.parametrize("responders", ["unselected", "all"])
def test_unselected_vertices_can_yield(responders: str) -> None:
    sheet = add_grid("Sheet", 6)
    add_cube("Block", (0, 0, 0.6), 0.5)
    edit_mode(sheet)
    bpy.ops.mesh.select_all(action="DESELECT")
    import bmesh

    edit_mesh = bmesh.from_edit_mesh(sheet.data)
    for vertex in edit_mesh.verts:
        vertex.select = abs(vertex.co.x) > 0.9
    edit = begin(settings=EditSettings(responders=responders))
    edit.apply(shift(z=0.5))
    assert edit.write().passed
    sheet.update_from_editmode()
    z = np.array([vertex.co.z for vertex in sheet.data.vertices])
    x = np.array([vertex.co.x for vertex in sheet.data.vertices])
    if responders == "unselected":
        assert z[np.abs(x) > 0.9] == pytest.approx(0.5)


def test_several_meshes_in_edit_mode() -> None:
    first, second = add_cube("First"), add_cube("Second", (0, 0, 4))
    edit_mode(first, second)
    bpy.ops.mesh.select_all(action="SELECT")
    before = [evaluated(ob) for ob in (first, second)]
    edit = begin()
    edit.drag(turn(0.5, "Z") @ shift(1))
    assert edit.write().passed
    for ob, start in zip((first, second), before, strict=True):
        assert evaluated(ob) == pytest.approx(moved(turn(0.5, "Z") @ shift(1), start), abs=1e-6)


def test_scaling_in_edit_mode_and_by_cage() -> None:
    cube = cube_above_floor(rotation_euler=(0.1, 0.2, 0.3))
    select(cube)
    start = evaluated(cube)
    edit = begin("scale", DEFORM)
    goal = stretch((1.5, 0.5, 1.2), (0, 0, 2))
    assert edit.apply(goal).status == "reached"
    assert edit.write().passed
    assert evaluated(cube) == pytest.approx(moved(goal, start), abs=1e-6)
