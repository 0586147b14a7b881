# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole edits: Blender shows the written state, and restoring is exact."""

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
    cube_above_floor,
    edit_mode,
    evaluated,
    mesh,
    moved,
    select,
    shift,
    snapshot,
    turn,
)

import stiv
from stiv.blender import BlenderEdit, EditSettings, check_scene
from stiv.task import run

DEFORM = EditSettings(object_response="deform")


def begin(kind: str = "move", settings: EditSettings | None = None) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, settings or EditSettings(), kind)


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


def test_a_time_budget_ends_a_typed_value_on_its_way() -> None:
    select(cube_above_floor())
    edit = begin(settings=EditSettings(time_budget=1e-9))
    assert edit.apply(shift(5, 0, -2)).status == "budget"
    assert edit.write().passed
    assert check_scene(bpy.context).pairs == ()


def test_a_confirmed_drag_goes_around_a_wall() -> None:
    """Solves within budgets make no detours, and stay in front of it."""
    cube = add_cube("Cube")
    add_cube("Wall", (2.0, 0.3, 0.1), scale=(0.2, 2.0, 2.0))
    select(cube)
    bpy.context.view_layer.update()
    edit = begin(settings=EditSettings(time_budget=1e6))
    for step in range(1, 11):
        edit.drag(shift(0.6 * step))
    edit.settle()
    assert edit.write().passed and cube.location.x < 2.0
    assert run(edit.confirm_steps()).status == "reached"
    assert edit.write().passed
    assert tuple(cube.location) == pytest.approx((6.0, 0.0, 0.0), abs=1e-6)
    assert check_scene(bpy.context).pairs == ()


@pytest.mark.parametrize("settings", [EditSettings(), DEFORM], ids=["rigid", "deform"])
def test_restoring_is_exact(settings: EditSettings) -> None:
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


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_lattice_points_push_a_subdivided_mesh_onto_the_floor(mode: str) -> None:
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


def test_rigid_and_controls_roles_yield() -> None:
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


def test_ignored_objects_and_pairs_may_intersect() -> None:
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
    assert caught.value.short.startswith("Cübe A cuts Floor, ")
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


def test_hidden_objects_are_not_obstacles_but_counted() -> None:
    cube = cube_above_floor()
    bpy.data.objects["Floor"].hide_set(True)
    select(cube)
    edit = begin()
    assert edit.summary.hidden == 1
    assert edit.drag(shift(z=-2)).status == "reached"


def test_matrices_are_checked() -> None:
    select(cube_above_floor())
    edit = begin()
    for bad in (np.eye(3), np.full((4, 4), np.nan)):
        with pytest.raises(stiv.InputError, match="transform"):
            edit.drag(bad)


def test_a_basis_key_alone_is_supported() -> None:
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
def test_more_than_half_a_turn_follows_the_given_path(angle: float) -> None:
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
