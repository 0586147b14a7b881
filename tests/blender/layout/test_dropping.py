# SPDX-License-Identifier: GPL-3.0-or-later
"""Drop and Settle into Contact: against closed forms, Blender's own ray casts and the exact test of the scene."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from building import add, add_bowl, add_cube, add_grid, mesh, select
from hypothesis import given, settings
from hypothesis import strategies as st
from mathutils import Euler

import stiv
from stiv.blender import (
    Drop,
    DropSettings,
    EditSettings,
    SettleSettings,
    Task,
    check_scene,
    drop,
    nearest_pair,
    settle_into_contact,
)

FIXTURES = Path(__file__).resolve().parents[3] / "blend_fixtures"
H = 0.01
EDIT = EditSettings(separation=H)


def clear() -> None:
    for ob in list(bpy.data.objects):
        bpy.data.objects.remove(ob)


def lowest(ob: bpy.types.Object) -> float:
    bpy.context.view_layer.update()
    return min((ob.matrix_world @ vertex.co).z for vertex in ob.data.vertices)


@pytest.mark.parametrize(("segments", "seed"), [(16, 0), (64, 1), (64, 2)])
@pytest.mark.parametrize("half", [(0.35, 0.35, 0.35), (0.875, 0.175, 0.175)])
def test_in_a_smooth_bowl_boxes_end_level_on_its_floor(segments: int, seed: int, half: tuple[float, ...]) -> None:
    """Supported by their lower corners, which are then on the sphere, as low as a level box can be."""
    random = np.random.default_rng(seed)
    add_bowl(2.0, 0.05, segments)
    place = (*random.uniform(-0.9, 0.9, 2), 1.5)
    box = add_cube("Box", place, 1.0, scale=half, rotation_euler=tuple(random.uniform(-3, 3, 3)))
    select(box)
    report = drop(bpy.context, DropSettings(EDIT))
    assert report.status == "done" and report.contacts[0] >= 3
    bpy.context.view_layer.update()
    across = [np.hypot(half[k], half[(k + 1) % 3]) for k in range(3)]
    heights = [half[k - 1] - np.sqrt(4 - across[k] ** 2) for k in range(3)]
    assert min(abs(box.location.z - height) for height in heights) < 0.06
    assert check_scene(bpy.context).pairs == ()


@settings(max_examples=12, deadline=None)
@given(st.floats(1.5, 40), st.tuples(*[st.floats(-3, 3)] * 3))
def test_a_cube_rests_on_a_face_at_half_its_size_and_the_separation(height: float, angles: tuple[float, ...]) -> None:
    clear()
    add_grid("Floor", 4, 60.0)
    cube = add_cube("Cube", (0.3, 0.2, height + 0.5), rotation_euler=angles)
    select(cube)
    report = drop(bpy.context, DropSettings(EDIT))
    assert report.status == "done" and report.contacts[0] >= 3
    bpy.context.view_layer.update()
    assert cube.matrix_world.translation.z == pytest.approx(1 + H, abs=0.1 * H)
    assert max(abs(row) for row in cube.matrix_world.to_3x3()[2]) == pytest.approx(1, abs=1e-4)  # a face is down
    assert not check_scene(bpy.context).pairs and nearest_pair(bpy.context).distance >= H * (1 - 1e-4)


def test_without_turning_it_stops_on_the_line() -> None:
    add_grid("Floor", 4, 8.0)
    cube = add_cube("Cube", (0.3, 0.2, 5), rotation_euler=(0.4, 0.7, 0.1))
    select(cube)
    before = cube.matrix_world.copy()
    drop(bpy.context, DropSettings(EDIT, turn=False))
    assert lowest(cube) == pytest.approx(H, abs=2e-4 * H + 1e-6)
    assert cube.location[:2] == before.translation[:2] and cube.rotation_euler == Euler((0.4, 0.7, 0.1))


def test_selected_objects_fall_onto_each_other() -> None:
    add_grid("Floor", 4, 8.0)
    upper, lower = add_cube("A", (0.2, 0, 9)), add_cube("B", (0, 0, 4))
    select(upper, lower)
    assert drop(bpy.context, DropSettings(EDIT)).changed == ("B", "A")  # the lower one first
    assert lower.location.z == pytest.approx(1 + H, abs=1e-3) and upper.location.z == pytest.approx(3 + 2 * H, abs=1e-3)


def test_a_single_vertex_rests_on_the_floor() -> None:
    add_grid("Floor", 4, 8.0)
    point = add("Point", mesh("Point", [(0, 0, 0)], []), (0.1, 0.2, 3))
    select(point)
    assert drop(bpy.context, DropSettings(EDIT)).status == "done"
    assert tuple(point.location) == pytest.approx((0.1, 0.2, H), abs=1e-3)


def test_with_nothing_below_it_stays_or_falls_on_the_ground() -> None:
    cube = add_cube("Cübe", (0, 0, 5))
    select(cube)
    report = drop(bpy.context, DropSettings(EDIT))
    assert report.status == "unchanged" and report.left == (("Cübe", "nothing below"),)
    assert tuple(cube.location) == (0, 0, 5)
    drop(bpy.context, DropSettings(EDIT, ground=True))
    assert lowest(cube) == pytest.approx(H, abs=1e-3)


def test_dropping_again_changes_nothing() -> None:
    add_grid("Floor", 4, 8.0)
    cube = add_cube("Cube", (0.3, 0.2, 5), rotation_euler=(0.4, 0.7, 0.1))
    select(cube)
    drop(bpy.context, DropSettings(EDIT, turn=False))
    before = cube.matrix_world.copy()
    assert drop(bpy.context, DropSettings(EDIT, turn=False)).status == "unchanged"
    assert cube.matrix_world == before


@pytest.mark.parametrize("turn", [False, True])
def test_locks_are_respected(turn: bool) -> None:
    add_grid("Floor", 4, 8.0)
    cube = add_cube("Cube", (0, 0, 5), rotation_euler=(0.4, 0.7, 0.1), lock_rotation=(True, True, True))
    select(cube)
    drop(bpy.context, DropSettings(EDIT, turn=turn))
    assert cube.rotation_euler == Euler((0.4, 0.7, 0.1)) and lowest(cube) == pytest.approx(H, abs=1e-4)
    cube.lock_location[2] = True
    cube.location.z += 1
    assert drop(bpy.context, DropSettings(EDIT, turn=turn)).left == (("Cube", "locked"),)


def test_an_intersecting_start_is_refused_by_name() -> None:
    add_grid("Floor", 4, 8.0)
    select(add_cube("Cube", (0, 0, 0.5)))
    with pytest.raises(stiv.InputError, match="Cube: intersects Floor"):
        drop(bpy.context, DropSettings(EDIT))
    assert tuple(bpy.data.objects["Cube"].location) == (0, 0, 0.5)


def test_cancelled_or_late_nothing_changes() -> None:
    add_grid("Floor", 4, 8.0)
    cube = add_cube("Cube", (0, 0, 5), rotation_euler=(0.4, 0.7, 0.1))
    select(cube)
    token = stiv.CancelToken()
    report = drop(bpy.context, DropSettings(EDIT), cancel=token, progress=lambda *_: token.cancel())
    assert report.status == "cancelled" and tuple(cube.location) == (0, 0, 5)
    late = EditSettings(separation=H, time_budget=1e-9)
    assert drop(bpy.context, DropSettings(late)).status == "budget" and tuple(cube.location) == (0, 0, 5)


def test_in_turns_it_ends_as_at_once_and_stopped_it_changes_nothing() -> None:
    add_grid("Floor", 4, 8.0)
    cube = add_cube("Cube", (0, 0, 5), rotation_euler=(0.4, 0.7, 0.1))
    select(cube)
    start, turns = (cube.location.copy(), cube.rotation_euler.copy()), 0
    drop(bpy.context, DropSettings(EDIT))
    expected = cube.location.copy(), cube.rotation_euler.copy()
    cube.location, cube.rotation_euler = start
    bpy.context.view_layer.update()
    stopped, left, whole = (Drop(bpy.context, DropSettings(EDIT)) for _ in range(3))
    cancelled, abandoned, task = (Task(each.solve_steps()) for each in (stopped, left, whole))
    for _ in range(8):
        cancelled.advance(1.0)
        abandoned.advance(1.0)
    cancelled.cancel()
    while not cancelled.advance(1.0):
        pass
    abandoned.abandon()
    left.restore()
    assert stopped.write().status == "cancelled" and (cube.location, cube.rotation_euler) == start
    while not task.advance(1.0):
        turns += 1
    whole.write()
    assert turns > 20 and (cube.location, cube.rotation_euler) == expected


def test_settling_presses_a_tilted_cube_against_the_nearest_wall() -> None:
    wall = add_grid("Wall", 4, 8.0, rotation_euler=(0, np.pi / 2, 0))
    cube = add_cube("Cube", (2.0, 0, 0), rotation_euler=(0.1, 0.2, 0.3))
    select(cube)
    report = settle_into_contact(bpy.context, SettleSettings(EDIT))
    bpy.context.view_layer.update()
    assert report.contacts[0] >= 3 and wall.location.x == 0
    assert cube.matrix_world.translation.x == pytest.approx(1 + H, abs=0.1 * H)
    cube.location.x += 20
    assert settle_into_contact(bpy.context, SettleSettings(EDIT)).left == (("Cube", "nothing near"),)


def test_organs_fall_into_the_bowl_of_the_fixture() -> None:
    bpy.ops.wm.open_mainfile(filepath=str(FIXTURES / "figures/organs_in_bowl.blend"))
    organs = [bpy.data.objects[name] for name in ("Heart", "Left kidney", "Spleen")]
    for ob in [ob for ob in bpy.data.objects if ob.type == "MESH" and ob.name != "Bowl" and ob not in organs]:
        bpy.data.objects.remove(ob)
    for number, organ in enumerate(organs):
        organ.location.z += number
    select(*organs)
    report = drop(bpy.context, DropSettings(EditSettings(separation=0.002)))
    assert len(report.changed) == 3 and min(report.contacts) >= 3
    between = [pair for pair in check_scene(bpy.context).pairs if pair.first.object != pair.second.object]
    assert not between and nearest_pair(bpy.context).distance >= 0.002 * (1 - 1e-3)
