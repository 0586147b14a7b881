# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertex groups whose weights apply to some local axes: pinned coordinates stay exactly, the others respond."""

from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from building import add_cube, add_grid, add_lattice, add_modifier, edit_mode, select, shift, turn
from mathutils import Vector
from test_control_weights import group, points
from test_seams import select_vertices, unwelded

import stiv
from stiv.blender import (
    BlenderEdit,
    ContractionSettings,
    EditSettings,
    Handles,
    Influence,
    Motion,
    WeightGroup,
    check_scene,
    compare,
    contract_scene,
    correct_after_tool,
    read_state,
)

Z = (False, False, True)


def begin(**settings: Any) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, EditSettings(object_response="deform", **settings), "move")


def fresh() -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("kind", ["cage", "lattice"])
def test_controls_pinned_along_z_respond_along_x_and_y(kind: str, mode: str) -> None:
    """A turned, scaled sheet is pushed against a block that presses it aside along all its axes."""
    place = {"location": (0.1, 0.2, 0.8), "rotation_euler": (0.3, -0.2, 0.4)}
    sheet = add_grid("Sheet", 6, **place, scale=(1.2, 0.8, 1.5))
    ob = sheet
    if kind == "lattice":
        ob = add_lattice("Cage", (4, 3, 2), **place, scale=(2.9, 2.2, 0.6))
        add_modifier(sheet, "LATTICE", object=ob)
    else:
        add_modifier(sheet, "SUBSURF", levels=1)
    axes = np.array(sheet.matrix_world.to_3x3().normalized())
    centre = np.array(sheet.location) + axes @ (-2.1, -0.1, 0.05)
    add_cube("Block", centre, 0.5, rotation_euler=(0.4, 0.5, 0.6))
    before = points(ob)
    pinned = np.flatnonzero(before[:, 0] < 0.1)
    group(ob, "Weights", {int(number): 1.0 for number in np.flatnonzero(before[:, 0] >= 0.1)})
    if mode == "EDIT":
        edit_mode(ob)
        getattr(bpy.ops, "lattice" if kind == "lattice" else "mesh").select_all(action="SELECT")
    else:
        select(ob)
    way = axes @ (-1.0, 0.1, 0.2)
    edit = begin(weights={ob.name: WeightGroup("Weights", axes=Z)})
    assert edit.apply(shift(*way)).status == "corrected"
    assert edit.write().passed
    now = points(ob)
    assert (now[pinned, 2] == before[pinned, 2]).all()
    asked = before + np.linalg.solve(np.array(ob.matrix_world)[:3, :3], way)
    assert (np.abs(now[pinned, :2] - asked[pinned, :2]).max(axis=0) > 1e-3).all()
    assert check_scene(bpy.context).pairs == ()


@pytest.mark.parametrize("angle", [0.0, np.pi / 2])
def test_a_weight_along_one_axis_damps_the_response_along_it_alone(angle: float) -> None:
    """A sheet above a blunt spike responds along world Z: the local axis that lies there counts, others hardly."""
    heights = {}
    up = Z if angle == 0 else (False, True, False)
    for weight, axes in ((1.0, Z), (0.3, (True, True, True)), (0.3, up), (0.3, tuple(not each for each in up))):
        fresh()
        add_cube("Spike", (0.1, 0, -0.3), 0.3)
        sheet = add_grid("Sheet", 2, location=(0, 0, 0.5))
        sheet.data.transform(turn(-angle, "X"))  # so that the turned object lies flat
        sheet.rotation_euler.x = angle
        group(sheet, "Weights", {number: weight if number % 3 == 1 else 1.0 for number in range(9)})
        add_modifier(sheet, "SUBSURF", levels=2)
        select(sheet)
        edit = begin(weights={"Sheet": WeightGroup("Weights", axes=axes)})
        edit.drag(shift(z=-0.6))
        assert edit.write().passed
        world = points(sheet) @ np.array(sheet.matrix_world)[:3, :3].T
        heights[weight, axes] = world[:, 2]
    free, everywhere, along, across = heights.values()
    assert along == pytest.approx(everywhere, abs=3e-3)
    assert across == pytest.approx(free, abs=3e-3)
    assert along[4] < free[4] - 0.05


@pytest.mark.parametrize("kind", ["laplacian", "arap"])
def test_handles_pinned_along_an_axis_keep_that_coordinate(kind: str) -> None:
    sheet = add_grid("Sheet", 6, location=(3, 0.1, 0), rotation_euler=(0.2, 0.1, 0.3), scale=(1.1, 1.1, 1.1))
    handles = {number: 1.0 for number in range(49) if number % 7 == 0}
    group(sheet, "Handle", handles)
    add_cube("Block", (1.0, 0, 0), 0.5, scale=(1, 4, 4), rotation_euler=(0.1, 0.2, 0.3))
    select(sheet)
    before, held = points(sheet), list(handles)
    edit = begin(
        deformations={"Sheet": kind}, handles={"Sheet": Handles(("Handle",))},
        weights={"Sheet": WeightGroup("Handle", True, Z)},
    )  # fmt: skip
    way = np.array([-0.9, 0.1, 0.4])
    edit.apply(shift(*way))
    assert edit.write().passed
    now = points(sheet)
    assert (now[held, 2] == before[held, 2]).all()
    wanted = before[held, :2] + np.linalg.solve(np.array(sheet.matrix_world)[:3, :3], way)[:2]
    assert (np.abs(now[held, :2] - wanted).max(axis=0) > 1e-3).all()
    assert check_scene(bpy.context).pairs == ()


def test_random_pins_keep_their_coordinates_whatever_the_frame_and_the_motion() -> None:
    random = np.random.default_rng(19)
    moved = 0
    for number in range(24):
        fresh()
        parent = bpy.data.objects.new("Parent", None)
        bpy.context.collection.objects.link(parent)
        parent.rotation_euler, parent.scale = random.uniform(-3, 3, 3), random.uniform(0.5, 1.5, 3)
        parent.location = random.uniform(-1, 1, 3) * 10 ** random.uniform(0, 3)
        sheet = add_grid("Sheet", 3)
        sheet.parent = parent  # with the turned sheet: sheared
        sheet.rotation_euler, sheet.scale = random.uniform(-3, 3, 3), random.uniform(0.5, 1.5, 3) * [1, -1, 1]
        for vertex in sheet.data.vertices:
            vertex.co.z = random.choice([0.0, 1e-9, 0.05]) * random.uniform(-1, 1)
        bpy.context.view_layer.update()
        centre = np.array(sheet.matrix_world)[:3, 3]
        way = random.uniform(-1, 1, 3)
        way *= 2 / np.linalg.norm(way)
        add_cube("Block", centre + 1.5 * way, 0.7, rotation_euler=random.uniform(-3, 3, 3))
        weights = random.choice([0.0, 0.3, 1.0], len(sheet.data.vertices))
        group(sheet, "Weights", {k: float(weight) for k, weight in enumerate(weights)})
        axes = [bool(bit) for bit in np.unravel_index(1 + number % 6, (2, 2, 2))]
        select(sheet)
        if check_scene(bpy.context).pairs:
            continue
        before = points(sheet)
        edit = begin(weights={"Sheet": WeightGroup("Weights", axes=tuple(axes))})
        if number % 3 == 0:
            edit.apply(turn(0.7, "Z", centre) @ shift(*way))
        else:
            edit.apply(shift(*way))
        assert edit.write().passed
        now = points(sheet)
        pinned = np.outer(weights == 0, axes)
        assert (now[pinned] == before[pinned]).all()
        assert check_scene(bpy.context).pairs == ()
        others = np.outer(weights == 0, np.logical_not(axes))
        moved += bool((now[others] != before[others]).any())
    assert moved > 15


def test_points_near_a_selection_follow_along_their_free_axes() -> None:
    sheet = add_grid("Sheet", 4)
    group(sheet, "Pins", {6: 1.0})
    edit_mode(sheet)
    bpy.ops.mesh.select_all(action="DESELECT")
    bmesh.from_edit_mesh(sheet.data).verts.ensure_lookup_table()
    bmesh.from_edit_mesh(sheet.data).verts[12].select = True
    before = points(sheet)
    edit = begin(weights={"Sheet": WeightGroup("Pins", True, Z)})
    edit.apply(Motion(shift(0.2, z=0.5), np.zeros(3), influence=Influence(3.0)))
    assert edit.write().passed
    way = points(sheet) - before
    assert way[6, 2] == 0 < way[6, 0]
    assert way[6, 0] == pytest.approx(way[8, 0])
    assert way[8, 2] > 0.05


def test_a_seam_is_pinned_along_an_axis_where_one_of_its_vertices_is() -> None:
    ob = unwelded("Import", 2)
    before = points(ob)
    centre = np.flatnonzero(np.linalg.norm(before, axis=1) < 1e-6)
    group(ob, "Pins", {int(centre[0]): 1.0})
    select_vertices(ob, lambda vertex: True)
    edit = begin(weights={ob.name: WeightGroup("Pins", True, Z)})
    edit.apply(shift(0.25, z=0.5))
    assert edit.write().passed
    now = points(ob)
    assert len(centre) > 1 and (now[centre, 2] == before[centre, 2]).all()
    assert now[centre, 0] == pytest.approx(before[centre, 0] + 0.25)
    assert np.delete(now, centre, 0) == pytest.approx(np.delete(before, centre, 0) + (0.25, 0, 0.5))


def test_the_live_guard_corrects_along_the_free_axes_alone() -> None:
    """The corner that meets the wall; without pins it is pressed aside along Z too."""
    aside = []
    for pins in ({}, {6: 1.0}):
        fresh()
        cube = add_cube("Cube")
        add_cube("Wall", (3.2, 0, 0), 1.0, scale=(1, 4, 4), rotation_euler=(0, 0.2, 0.2))
        group(cube, "Pins", pins)
        select(cube)
        accepted = read_state(bpy.context)
        for vertex in cube.data.vertices:
            vertex.co += Vector((1.2, 0, 0.25))
        cube.data.update()
        asked = points(cube)
        settings = EditSettings(weights={"Cube": WeightGroup("Pins", True, Z)})
        assert correct_after_tool(bpy.context, settings, accepted, compare(accepted, read_state(bpy.context))).corrected
        assert check_scene(bpy.context).pairs == ()
        aside.append(np.abs(points(cube) - asked)[6])
    assert aside[0][2] > 0.01 < aside[1][0]
    assert aside[1][2] < 1e-6


def test_a_contraction_keeps_controls_pinned_along_an_axis() -> None:
    cube = add_cube("Cube")
    group(cube, "Pins", {0: 1.0})
    select(cube)
    before = points(cube)
    contract_scene(bpy.context, ContractionSettings(EditSettings(weights={"Cube": WeightGroup("Pins", True, Z)})))
    now = points(cube)
    assert (now[0] == before[0]).all()
    assert (now[1:] != before[1:]).any(axis=1).all()


def test_axes_are_three_choices() -> None:
    for axes in ((True, True), (True, "X", False)):
        with pytest.raises(stiv.InputError, match="for each of X, Y, Z"):
            WeightGroup("Weights", axes=axes)
