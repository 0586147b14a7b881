# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole edits: what is written is what Blender shows, and restoring leaves no bit changed."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import (
    CUBE,
    CUBE_FACES,
    add,
    add_cube,
    add_grid,
    add_lattice,
    add_modifier,
    edit_mode,
    evaluated,
    mesh,
    moved,
    select,
    shift,
    snapshot,
    stretch,
    turn,
)

import stiv
from stiv.blender import BlenderEdit, EditSettings, SceneChangedError, check_scene

DEFORM = EditSettings(object_response="deform")


def begin(kind: str = "move", settings: EditSettings | None = None) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, settings or EditSettings(), kind)


def cube_above_floor(**properties: Any) -> Any:
    add_grid("Floor", 4, 4.0)
    return add_cube("Cübe A", (0.3, 0, 2), **properties)


def test_a_free_move_ends_at_its_goal() -> None:
    cube = cube_above_floor()
    select(cube)
    before = evaluated(cube)
    edit = begin()
    assert edit.drag(shift(1, 2, 0.5)).status == "reached"
    assert edit.write().passed
    assert evaluated(cube) == pytest.approx(moved(shift(1, 2, 0.5), before), abs=1e-6)
    assert tuple(cube.rotation_euler) == (0, 0, 0)


@pytest.mark.parametrize("settings", [EditSettings(), DEFORM], ids=["rigid", "deform"])
def test_a_move_into_the_floor_stops_above_it(settings: EditSettings) -> None:
    cube = cube_above_floor()
    select(cube)
    edit = begin(settings=settings)
    assert edit.apply(shift(z=-2)).status in ("corrected", "blocked")
    assert edit.write().passed
    assert 0 < evaluated(cube)[:, 2].min() < 0.01
    assert check_scene(bpy.context).pairs == ()


@pytest.mark.parametrize("settings", [EditSettings(), DEFORM], ids=["rigid", "deform"])
def test_restore_changes_no_bit(settings: EditSettings) -> None:
    parent = add("Parent", None, (0.1, 0.2, 0.3), rotation_euler=(0.1, 0.2, 0.3), scale=(1.3, 1.3, 1.3))
    cube = cube_above_floor(parent=parent, rotation_euler=(0.3, 0.7, 0.1), scale=(0.7, -0.9, 1.1))
    select(cube)
    before = snapshot()
    edit = begin(settings=settings)
    assert snapshot() == before
    edit.apply(turn(0.4, "X", (0, 0, 1)) @ shift(z=-1.5))
    assert snapshot() == before
    assert edit.write().passed
    assert snapshot() != before
    edit.restore()
    assert snapshot() == before
    assert edit.drag(shift()).status in ("reached", "unchanged")
    assert edit.write().passed
    assert snapshot() == before


def test_a_drag_back_to_the_start_writes_the_start() -> None:
    cube = cube_above_floor(rotation_euler=(0.3, 0.7, 0.1))
    select(cube)
    before = snapshot()
    for settings in (EditSettings(), DEFORM):
        edit = begin(settings=settings)
        for depth in (0.5, 0.0):
            edit.drag(shift(z=-depth))
            assert edit.write().passed
        assert snapshot() == before


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
    edit.restore()
    assert snapshot() == before
    edit.drag(shift(z=0.5))
    edit.write()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert max(vertex.co.z for vertex in grid.data.vertices) == pytest.approx(0.5)
    assert check_scene(bpy.context).pairs == ()


@pytest.mark.parametrize("responders", ["unselected", "all"])
def test_unselected_vertices_can_give_way(responders: str) -> None:
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


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_lattice_points_press_a_subdivided_mesh_on_the_floor(mode: str) -> None:
    add_grid("Floor", 4, 4.0)
    ob = add_cube("Soft", (0, 0, 2), rotation_euler=(0.2, 0.1, 0.5))
    lattice = add_lattice("Cage", (3, 3, 3), (0, 0, 2), rotation_euler=(0.3, 0, 0), scale=(2, 2, 2.5))
    add_modifier(ob, "LATTICE", object=lattice)
    add_modifier(ob, "SUBSURF", levels=2)
    if mode == "EDIT":
        edit_mode(lattice)
        bpy.ops.lattice.select_all(action="SELECT")
        lattice.data.points[0].select = False
    else:
        select(lattice)
    before = snapshot()
    edit = begin(settings=DEFORM)
    edit.apply(shift(z=-2))
    assert edit.write().passed
    assert 0 < evaluated(ob)[:, 2].min() < 0.05
    assert edit.surface[edit.assembly.vertices(1)] == pytest.approx(evaluated(ob), abs=1e-5)
    assert check_scene(bpy.context).pairs == ()
    edit.restore()
    assert snapshot() == before


def test_one_lattice_of_two_meshes() -> None:
    lattice = add_lattice("Cage", (2, 2, 3), scale=(8, 8, 8))
    for name, x in (("Left", -2), ("Right", 2)):
        add_modifier(add_cube(name, (x, 0, 0)), "LATTICE", object=lattice)
    select(lattice)
    edit = begin(settings=DEFORM)
    edit.drag(turn(0.3, "Y") @ shift(0, 0, 1))
    assert edit.write().passed
    shown = np.concatenate([evaluated(bpy.data.objects[name]) for name in ("Left", "Right")])
    assert edit.surface == pytest.approx(shown, abs=1e-5)


def test_rigid_and_controls_roles_give_way() -> None:
    add_grid("Wall", 2, 3.0, rotation_euler=(0, np.pi / 2, 0), location=(6, 0, 0))
    pusher, ball, sheet = (
        add_cube("Pusher"),
        add_cube("Ball", (2.5, 0.2, 0.3)),
        add_grid("Sheet", 4, location=(0, 0, 3)),
    )
    select(pusher)
    settings = EditSettings(roles={"Ball": "rigid", "Sheet": "controls", "Wall": "obstacle"}, responders="unselected")
    edit = begin(settings=settings)
    roles = {each.name: each.role for each in edit.summary.participants}
    assert roles == {"Wall": "obstacle", "Pusher": "rigid", "Ball": "rigid", "Sheet": "cage"}
    edit.apply(shift(1, 0, 0))
    assert edit.write().passed
    assert tuple(pusher.location) == pytest.approx((1, 0, 0), abs=1e-6)
    assert ball.location.x > 2.9
    assert evaluated(sheet)[:, 2] == pytest.approx(3)


def test_ignored_objects_and_pairs_let_through() -> None:
    cube = cube_above_floor()
    select(cube)
    for settings in (EditSettings(roles={"Floor": "ignored"}), EditSettings(ignored_pairs=(("Cübe A", "Floor"),))):
        edit = begin(settings=settings)
        assert edit.drag(shift(z=-2)).status == "reached"
        assert edit.write().passed
        edit.restore()


def test_start_that_intersects_is_refused() -> None:
    cube = cube_above_floor()
    cube.location.z = 0.5
    select(cube)
    before = snapshot()
    with pytest.raises(stiv.StartIntersectsError, match="Cübe A") as caught:
        begin()
    assert len(caught.value.pairs) > 0
    assert snapshot() == before


def test_instances_are_obstacles() -> None:
    collection = bpy.data.collections.new("Inner")
    collection.objects.link(
        bpy.data.objects.new("Inner", mesh("Inner", [(-3, -3, 0), (3, -3, 0), (0, 3, 0)], [(0, 1, 2)]))
    )
    add("Instancer", None, (0, 0, -2), instance_type="COLLECTION", instance_collection=collection)
    cube = add_cube("Cube")
    select(cube)
    edit = begin()
    assert edit.apply(shift(z=-3)).status == "corrected"
    assert edit.write().passed
    assert -2 < evaluated(cube)[:, 2].min() < -1.98


def test_hidden_objects_are_no_obstacle_but_counted() -> None:
    cube = cube_above_floor()
    bpy.data.objects["Floor"].hide_set(True)
    select(cube)
    edit = begin()
    assert edit.summary.hidden == 1
    assert edit.drag(shift(z=-2)).status == "reached"


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
    with pytest.raises(SceneChangedError, match='object "Cübe A" is gone'):
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


def test_what_blender_shows_otherwise_is_put_back() -> None:
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
    assert 'object "Cübe A"' in report.message
    assert cube.location.x == pytest.approx(0.8)
    assert edit.drag(shift(x=0.6)).status == "reached"
    assert edit.write().passed


def test_what_blender_shows_meeting_is_put_back() -> None:
    """An obstacle driven into the way during the edit is found on Blender's own evaluation."""
    cube = cube_above_floor()
    select(cube)
    edit = begin()
    edit.drag(shift(x=0.5))
    bpy.data.objects["Floor"].location.z = 1.5
    report = edit.write()
    assert not report.passed
    assert cube.location.x == pytest.approx(0.3)


def test_matrices_are_checked() -> None:
    select(cube_above_floor())
    edit = begin()
    for bad in (np.eye(3), np.full((4, 4), np.nan)):
        with pytest.raises(stiv.InputError, match="transform"):
            edit.drag(bad)


def test_scaling_in_edit_mode_and_by_cage() -> None:
    cube = cube_above_floor(rotation_euler=(0.1, 0.2, 0.3))
    select(cube)
    start = evaluated(cube)
    edit = begin("scale", DEFORM)
    goal = stretch((1.5, 0.5, 1.2), (0, 0, 2))
    assert edit.apply(goal).status == "reached"
    assert edit.write().passed
    assert evaluated(cube) == pytest.approx(moved(goal, start), abs=1e-6)


def test_with_a_basis_key_alone_the_cage_is_still_seen() -> None:
    cube = cube_above_floor()
    cube.shape_key_add(name="Basis")
    select(cube)
    before = snapshot()
    start = evaluated(cube)
    edit = begin(settings=DEFORM)
    edit.drag(shift(z=1))
    assert edit.write().passed
    assert evaluated(cube) == pytest.approx(moved(shift(z=1), start), abs=1e-6)
    edit.restore()
    assert snapshot() == before


@pytest.mark.parametrize("angle", [1.5 * np.pi, 2 * np.pi])
def test_more_than_half_a_turn_goes_the_way_it_was_given(angle: float) -> None:
    """A bar that points along x, and a wall in the way at half a turn: the short way back would not meet it."""
    bar = add("Bar", mesh("Bar", np.array(CUBE) * (1, 0.1, 0.1) + (1.5, 0, 0), CUBE_FACES))
    add_cube("Wall", (-1.5, 0, 0), 0.5)
    select(bar)
    short = begin("rotate").apply(turn(angle, "Z"))
    assert short.rounds == 0
    edit = begin("rotate")
    assert edit.apply(turn(angle, "Z"), path=lambda fraction: turn(fraction * angle, "Z")).rounds > 0
    assert edit.write().passed
    assert check_scene(bpy.context).pairs == ()
