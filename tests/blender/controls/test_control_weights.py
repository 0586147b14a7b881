# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of controls from vertex groups: 0 pins exactly, less yields less, a pinned contact stops the edit."""

from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from building import (
    add_cube,
    add_grid,
    add_lattice,
    add_modifier,
    edit_mode,
    evaluated,
    select,
    shift,
    snapshot,
)

import stiv
from stiv.blender import BlenderEdit, EditSettings, Influence, Motion, WeightGroup, check_scene


def group(ob: Any, name: str, weights: dict[int, float]) -> None:
    made = ob.vertex_groups.new(name=name)
    for number, weight in weights.items():
        made.add([number], weight, "REPLACE")


def points(ob: Any) -> np.ndarray:
    if ob.type == "LATTICE":
        return np.array([tuple(point.co_deform) for point in ob.data.points], np.float32)
    if ob.mode == "EDIT":
        ob.update_from_editmode()
    return np.array([tuple(v.co) for v in ob.data.vertices], np.float32)


def begin(**settings: Any) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, EditSettings(object_response="deform", **settings), "move")


def pinned_half(ob: Any, name: str = "Weights") -> np.ndarray:
    """Weight 1 for controls with x > 0, none for the others; returns which are pinned."""
    free = np.flatnonzero(points(ob)[:, 0] > 0)
    group(ob, name, {int(number): 1.0 for number in free})
    return np.setdiff1d(np.arange(len(points(ob))), free)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("kind", ["cage", "lattice"])
def test_pinned_controls_stay_exactly(kind: str, mode: str) -> None:
    sheet = add_grid("Sheet", 8, location=(0.1, 0.2, 0.7), rotation_euler=(0.02, 0.01, 0.3))
    add_modifier(sheet, "SUBSURF", levels=1)
    ob = sheet
    if kind == "lattice":
        ob = add_lattice("Cage", (4, 3, 2), (0.1, 0.2, 0.7), rotation_euler=(0.02, 0.01, 0.3), scale=(2.5, 2.5, 0.6))
        sheet.modifiers.clear()
        add_modifier(sheet, "LATTICE", object=ob)
    add_grid("Floor", 3, 4.0)
    pinned = pinned_half(ob)
    if mode == "EDIT":
        edit_mode(ob)
        getattr(bpy.ops, "lattice" if kind == "lattice" else "mesh").select_all(action="SELECT")
    else:
        select(ob)
    start, before = snapshot(), points(ob)
    edit = begin(weights={ob.name: WeightGroup("Weights")})
    edit.apply(shift(z=-1.5))
    assert edit.write().passed
    now = points(ob)
    assert (now[pinned] == before[pinned]).all()
    assert not (np.delete(now, pinned, 0) == np.delete(before, pinned, 0)).any(axis=1).all()
    assert check_scene(bpy.context).pairs == ()
    edit.restore()
    assert snapshot() == start


def test_less_weight_yields_less() -> None:
    """Two square cages, pushed equally into a floor, respond by their weights."""
    depths = []
    for weight in (1.0, 0.01):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        add_grid("Floor", 3, 4.0)
        sheet = add_grid("Sheet", 2, location=(0, 0, 0.5))
        group(sheet, "Weights", {number: weight if number % 3 == 1 else 1.0 for number in range(9)})
        add_modifier(sheet, "SUBSURF", levels=2)
        select(sheet)
        edit = begin(weights={"Sheet": WeightGroup("Weights")})
        edit.drag(shift(z=-0.6))
        assert edit.write().passed
        z = points(sheet)[:, 2]
        depths.append(z[1::3].mean() - z[0::3].mean())
    assert depths[1] < depths[0] - 0.005


def test_a_fully_pinned_contact_stops_the_edit_and_is_named() -> None:
    """The pushed vertices reach the pinned ones of another cage: nothing can yield."""
    wall = add_grid("Wand", 4, 3.0, (1.0, 0, 0), rotation_euler=(0, np.pi / 2, 0))
    group(wall, "Weights", {})
    sheet = add_grid("Sheet", 2, rotation_euler=(0, np.pi / 2, 0))
    select(sheet)
    before = points(wall)
    edit = begin(responders="unselected", roles={"Wand": "controls"}, weights={"Wand": WeightGroup("Weights")})
    result = edit.apply(shift(2.0))
    assert result.status == "blocked"
    assert "Wand" in result.blocking
    assert edit.write().passed
    assert (points(wall) == before).all()
    assert evaluated(sheet)[:, 0].max() < 1.0


def test_inverted_weights_pin_the_group() -> None:
    sheet = add_grid("Sheet", 2)
    group(sheet, "Pins", {4: 1.0})
    edit_mode(sheet)
    for vertex in bmesh.from_edit_mesh(sheet.data).verts:
        vertex.select = True
    before = points(sheet)
    edit = begin(weights={"Sheet": WeightGroup("Pins", inverted=True)})
    edit.apply(shift(z=1))
    assert edit.write().passed
    now = points(sheet)
    assert (now[4] == before[4]).all()
    assert np.delete(now, 4, 0) == pytest.approx(np.delete(before, 4, 0) + (0, 0, 1), abs=1e-6)


def test_a_missing_group_is_named() -> None:
    for ob in (add_cube("Cube"), add_lattice("Cage", (2, 2, 2), scale=(3, 3, 3))):
        if ob.type == "LATTICE":
            add_modifier(bpy.data.objects["Cube"], "LATTICE", object=ob)
        select(ob)
        with pytest.raises(stiv.InputError, match=f'{ob.name}: there is no vertex group "No"'):
            begin(weights={ob.name: WeightGroup("No")})
    with pytest.raises(stiv.InputError, match="Nobody: the settings name it"):
        begin(weights={"Nobody": WeightGroup("No")})


def test_point_weights_of_a_lattice_in_edit_mode() -> None:
    """Blender reads these groups from the wrong memory there, and crashed."""
    cube, lattice = add_cube("Cube", size=0.4), add_lattice("Cage", (3, 3, 3), scale=(3, 3, 3))
    group(lattice, "Points", {number: number / 27 for number in range(27)})
    lattice.data.vertex_group = "Points"
    add_modifier(cube, "LATTICE", object=lattice)
    edit_mode(lattice)
    bpy.ops.lattice.select_all(action="SELECT")
    edit = begin()
    edit.drag(shift(0.3))
    assert edit.write().passed
    assert edit.surface == pytest.approx(evaluated(cube), abs=1e-5)


def test_pinned_points_do_not_follow_a_selection_near_them() -> None:
    sheet = add_grid("Sheet", 4)
    group(sheet, "Pins", {6: 1.0, 7: 0.5})
    edit_mode(sheet)
    for vertex in bmesh.from_edit_mesh(sheet.data).verts:
        vertex.select = vertex.index == 12
    before = points(sheet)
    edit = begin(weights={"Sheet": WeightGroup("Pins", inverted=True)})
    edit.apply(Motion(shift(z=0.5), np.zeros(3), influence=Influence(3.0)))
    assert edit.write().passed
    now = points(sheet)
    assert (now[6] == before[6]).all()
    assert (np.delete(now, 6, 0)[:, 2] > 0.05).all()
