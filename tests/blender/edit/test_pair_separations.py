# SPDX-License-Identifier: GPL-3.0-or-later
"""Minimum distances of pairs of objects, measured in Blender."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import add_cube, add_grid, add_modifier, edit_mode, evaluated, select, shift, turn

import stiv
from stiv.blender import BlenderEdit, EditSettings, LoopSurface, add_refined, check_scene


def begin(**settings: Any) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, EditSettings(**settings), "move")


@pytest.mark.parametrize("response", ["rigid", "deform"])
def test_each_pair_respects_its_own_distance(response: str) -> None:
    add_grid("Floor", 3, 4.0, (0, 0, -2))
    add_grid("Wall", 3, 4.0, (2, 0, 0), rotation_euler=(0, np.pi / 2, 0))
    cube = add_cube("Cube")
    if response == "deform":
        add_modifier(cube, "SUBSURF", levels=1)
    select(cube)
    pairs = (("Cube", "Floor", 0.3), ("Wall", "Cube", 0.05))
    edit = begin(separation=0.01, pair_separations=pairs, object_response=response)
    for depth in np.linspace(0.1, 2.0, 12):
        edit.drag(shift(depth, 0, -depth))
        assert edit.write().passed
    shown = evaluated(cube)
    assert 0.3 * (1 - 1e-6) <= shown[:, 2].min() + 2 < 0.7
    assert 0.05 * (1 - 1e-6) <= 2 - shown[:, 0].max() < 0.15


def test_a_sheet_respects_a_distance_from_itself() -> None:
    sheet = add_grid("Sheet", 8)
    select(sheet)
    edit_mode(sheet)
    bpy.ops.mesh.select_all(action="DESELECT")
    import bmesh

    for vertex in bmesh.from_edit_mesh(sheet.data).verts:
        vertex.select = vertex.co.x > 0.1
    edit = BlenderEdit.begin(bpy.context, EditSettings(pair_separations=(("Sheet", "Sheet", 0.1),)), "rotate")
    edit.apply(turn(-3.1, "Y"), path=lambda fraction: turn(-3.1 * fraction, "Y"))
    assert edit.write().passed
    q = edit.surface
    apart = np.linalg.norm(q[:, None] - q[None], axis=2)
    far_on_the_sheet = np.abs(np.arange(81)[:, None] % 9 - np.arange(81)[None] % 9) > 2
    assert apart[far_on_the_sheet].min() >= 0.1 * (1 - 1e-6)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert check_scene(bpy.context).pairs == ()


def test_a_cage_respects_distances_by_its_refined_object() -> None:
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=1, radius=1.0)
    cage = bpy.context.active_object
    cage.name = "Cage"
    refined = add_refined(bpy.context, cage, 1, "all")
    add_grid("Floor", 2, 4.0, (0, 0, -2))
    select(cage)
    edit = begin(loops={"Cage": LoopSurface(refined.name, 1)}, pair_separations=(("Floor", "Cage", 0.25),))
    edit.apply(shift(z=-3))
    assert edit.write().passed
    assert 0.25 * (1 - 1e-6) <= evaluated(refined)[:, 2].min() + 2 < 0.55


def test_values_and_names_are_checked() -> None:
    select(add_cube("Cube"))
    with pytest.raises(stiv.InputError, match="-1 is not a positive number"):
        EditSettings(pair_separations=(("Cube", "Cube", -1),))
    with pytest.raises(stiv.InputError, match="Nobody: the settings name it"):
        begin(pair_separations=(("Cube", "Nobody", 1.0),))
