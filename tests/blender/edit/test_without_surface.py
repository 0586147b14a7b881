# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects without a mesh: hair, point clouds and volumes beside edited objects."""

import bpy
import pytest
from building import add, add_cube, add_grid, select, shift

from stiv.blender import BlenderEdit, EditSettings

DATA = {
    "hair": lambda: bpy.data.hair_curves.new("Other"),
    "points": lambda: bpy.data.pointclouds.new("Other"),
    "volume": lambda: bpy.data.volumes.new("Other"),
    "curve": lambda: bpy.data.curves.new("Other", "CURVE"),
}


@pytest.mark.parametrize("kind", DATA)
@pytest.mark.parametrize("responders", ["selected", "unselected", "all"])
def test_edits_work_beside_objects_without_a_surface(kind: str, responders: str) -> None:
    add_grid("Floor", 2, 3.0)
    cube, other = add_cube("Cube", (0, 0, 1.5)), add("Other", DATA[kind](), (9, 0, 0))
    select(cube)
    edit = BlenderEdit.begin(bpy.context, EditSettings(responders=responders), "move")
    edit.apply(shift(x=1))
    assert edit.write().passed
    assert cube.location.x == pytest.approx(1) and other.location.x == 9


@pytest.mark.parametrize("kind", DATA)
def test_selected_objects_without_a_surface_move_along(kind: str) -> None:
    add_grid("Floor", 2, 3.0)
    other, cube = add("Other", DATA[kind](), (9, 0, 5)), add_cube("Cube", (0, 0, 1.5))
    select(cube, other)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.apply(shift(z=-2))
    assert edit.write().passed
    assert 1 < cube.location.z < 1.01
    assert other.location.z == pytest.approx(5 + cube.location.z - 1.5, abs=1e-6)
