# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that touch others at the start: an edit parts them by rounding, and continues as from a clear start."""

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from building import (
    add,
    add_cube,
    add_grid,
    add_modifier,
    deepest,
    evaluated,
    select,
    shift,
    shown_triangles,
    snapshot,
    stretch,
    turn,
)
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import stiv
from stiv.blender import BlenderEdit, EditSettings, Motion, check_scene, separate
from stiv.blender.controls.directions import FreeDirections
from stiv.blender.edit import touching_start
from stiv.blender.scene import obstacle_choice
from stiv.task import Task

ROUNDING = 1e-5
DEEPEST = 64  # roundings of the largest coordinate
SLIDE = EditSettings()


def begin(kind: str = "move", chosen: EditSettings = SLIDE) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, chosen, kind)


def cube_on_floor(faces: int = 1, **properties: Any) -> Any:
    """The default cube, exactly on a floor; selected."""
    add_grid("Floor", faces, 8.0)
    cube = add_cube("Cube", (0, 0, 1), **properties)
    select(cube)
    return cube


def is_clear(*names: str) -> bool:
    """Does nothing intersect these objects, or any without names?"""
    pairs = check_scene(bpy.context).pairs
    return not any(not names or {pair.first.object, pair.second.object} & {*names} for pair in pairs)


def applied(matrix: Any, kind: str = "move", chosen: EditSettings = SLIDE) -> BlenderEdit:
    """An edit of a typed value, written; nothing intersects any more."""
    edit = begin(kind, chosen)
    edit.apply(matrix)
    assert edit.write().passed
    assert is_clear()
    return edit


def check_triangles() -> np.ndarray:
    """Pairs of triangles that intersect, (k, 2)."""
    triangles = [shown_triangles(name) for name in ("Floor", "Cube")]
    corners = np.concatenate(triangles)
    bodies = np.repeat([0, 1], [3 * len(each) for each in triangles])
    numbers = np.arange(len(bodies), dtype=np.int32).reshape(-1, 3)
    names = [stiv.Body("Floor", "fixed"), stiv.Body("Cube", "rigid")]
    return stiv.find_intersections(
        corners.reshape(-1, 3), stiv.Surface(numbers, len(bodies), vertex_body=bodies, bodies=names)
    )


def refused(kind: str = "move", chosen: EditSettings = SLIDE) -> None:
    """An edit cannot begin, and changes nothing."""
    before = snapshot()
    with pytest.raises(stiv.StartIntersectsError, match="already intersects"):
        begin(kind, chosen)
    assert snapshot() == before


@pytest.mark.parametrize(
    ("way", "end"),
    [
        ((1, 0, 0), (1, 0, 1)),
        ((-2, 3, 0), (-2, 3, 1)),
        ((0, 0, 1), (0, 0, 2)),
        ((0, 0, -1), (0, 0, 1)),
        ((2, 0, -1), (2, 0, 1)),
        ((0.5, 0.5, 0.5), (0.5, 0.5, 1.5)),
    ],
)
@pytest.mark.parametrize("drags", [True, False], ids=["drag", "typed"])
@pytest.mark.parametrize("faces", [1, 4, 25])
def test_a_cube_on_the_floor_slides_rises_and_stays_above(way: Any, end: Any, drags: bool, faces: int) -> None:
    cube = cube_on_floor(faces)
    assert not is_clear()
    edit = begin()
    if drags:
        for fraction in np.linspace(0.1, 1, 10):
            edit.drag(shift(*(fraction * np.array(way))))
            assert edit.write().passed and is_clear()
        edit.settle()
    else:
        edit.apply(shift(*way))
    assert edit.write().passed and is_clear()
    assert tuple(cube.location) == pytest.approx(end, abs=ROUNDING)
    assert evaluated(cube)[:, 2].min() > 0


def test_only_the_height_of_a_cube_that_slides_changes_and_that_by_rounding() -> None:
    cube = cube_on_floor(rotation_euler=(0, 0, 0.3))
    applied(shift(1.5))
    assert (cube.location.x, cube.location.y) == (1.5, 0.0)
    assert 1 < cube.location.z < 1 + ROUNDING
    assert cube.rotation_euler.z == np.float32(0.3)


@pytest.mark.parametrize(
    ("kind", "motion"),
    [("move", shift(1, 0, -1)), ("rotate", turn(0.4, "Z", (0, 0, 1))), ("scale", stretch(0.5, (0, 0, 1)))],
)
def test_every_kind_begins_and_restores_to_the_last_bit(kind: str, motion: Any) -> None:
    cube_on_floor(rotation_euler=(0, 0, 0.7))
    before = snapshot()
    edit = begin(kind)
    edit.apply(motion)
    assert edit.write().passed and is_clear()
    assert snapshot() != before
    edit.restore()
    assert snapshot() == before
    edit.apply(motion)
    assert edit.write().passed and is_clear()
    with edit.start_shown():
        assert snapshot() == before
    assert is_clear()
    edit.restore()
    assert snapshot() == before


def test_an_axis_keeps_the_others() -> None:
    cube = cube_on_floor()
    edit = begin()
    edit.drag(Motion(shift(1), np.zeros(3), free=FreeDirections.line(np.array([1.0, 0, 0]))))
    assert edit.write().passed and is_clear()
    assert tuple(cube.location) == pytest.approx((1, 0, 1), abs=ROUNDING)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=15)
@given(st.integers(0, 2**32 - 1))
def test_crates_flush_with_each_other_in_any_direction(seed: int) -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    chance = np.random.default_rng(seed)
    angles, place, (x, y) = chance.uniform(-3, 3, 3), chance.uniform(-5, 5, 3), chance.uniform(-0.9, 0.9, 2)
    rest = add_cube("Rest", place, rotation_euler=angles)
    across = np.array(rest.matrix_world)[:3, :3]
    crate = add_cube("Crate", place + across @ (x, y, 2), rotation_euler=angles)
    select(crate)
    start = np.array(crate.location)
    edit = begin()
    way = across @ (1, -1, -0.5)
    edit.apply(shift(*way))
    assert edit.write().passed and is_clear()
    slid = across.T @ (np.array(crate.location) - start)
    assert slid == pytest.approx((1, -1, 0), abs=2 * ROUNDING)


def stack() -> tuple[Any, Any, Any]:
    """A floor, and two crates of the same size on each other."""
    return add_grid("Floor", 1, 8.0), add_cube("Lower", (0, 0, 1)), add_cube("Upper", (0, 0, 3))


def test_the_upper_one_of_two_crates_slides() -> None:
    _, lower, upper = stack()
    select(upper)
    edit = begin()
    edit.apply(shift(1, 0.5, -0.2))
    assert edit.write().passed and is_clear("Upper")
    assert tuple(upper.location) == pytest.approx((1, 0.5, 3), abs=ROUNDING)
    assert tuple(lower.location) == (0, 0, 1)
    assert edit.start_notes == ()


def test_a_stack_slides_together_and_stays_as_it_is() -> None:
    _, lower, upper = stack()
    select(lower, upper)
    edit = begin()
    edit.apply(shift(0.3, 0.2, 0.1))
    assert edit.write().passed and is_clear("Floor")
    assert np.array(upper.location) - lower.location == pytest.approx((0, 0, 2), abs=1e-6)
    assert tuple(lower.location) == pytest.approx((0.3, 0.2, 1.1), abs=ROUNDING)


def test_resting_objects_that_touch_each_other_need_nothing() -> None:
    stack()
    free = add_cube("Free", (5, 0, 2))
    select(free)
    edit = begin()
    assert tuple(free.location) == (5, 0, 2)
    edit.apply(shift(-2.5))
    assert edit.write().passed
    assert free.location.x == pytest.approx(2.5, abs=ROUNDING)


def held_between_walls() -> Any:
    add_cube("Left", (-2, 0, 0))
    add_cube("Right", (2, 0, 0))
    return add_cube("Cube", (0, 0.3, 0))


def held_in_a_stack() -> Any:
    return stack()[1]


def cutting() -> Any:
    add_grid("Floor", 4, 8.0)
    return add_cube("Cube", (0, 0, 1 - 1e-3))


def cutting_beside_contact() -> Any:
    add_grid("Floor", 4, 8.0)
    add_cube("Wall", (1.9, 0.3, 1.2))
    return add_cube("Cube", (0, 0, 1))


def duplicate() -> Any:
    add_cube("Cube")
    return add_cube("Copy")


def keyed() -> Any:
    cube = cube_on_floor()
    cube.keyframe_insert("location", frame=1)
    return cube


def locked() -> Any:
    return cube_on_floor(lock_location=(False, False, True))


def tile_on_floor() -> Any:
    """An open surface on a closed one."""
    add_cube("Floor", (0, 0, -2), 2.0)
    return add_grid("Tile", 2)


def mirrored() -> Any:
    """Its shape depends on its place."""
    cube = cube_on_floor()
    add_modifier(cube, "MIRROR", mirror_object=add("Mirror", None, (3, 0, 0)))
    return cube


@pytest.mark.parametrize("build", [cutting, cutting_beside_contact, duplicate])
def test_what_cuts_deeper_than_rounding_is_refused_as_before(build: Callable[[], Any]) -> None:
    select(build())
    refused()


@pytest.mark.parametrize(
    "build", [held_between_walls, held_in_a_stack, keyed, locked, mirrored, cube_on_floor, tile_on_floor]
)
@pytest.mark.parametrize("way", [(0, 1.3, 0), (0.4, 0.7, -1), (0, 0.2, 0.5)])
def test_what_cannot_be_parted_slides_in_contact(build: Callable[[], Any], way: tuple[float, float, float]) -> None:
    """Nothing cuts deeper than rounding, and nothing rises by more."""
    cube = build()
    select(cube)
    before, start = snapshot(), cube.location.copy()
    edit = begin()
    edit.apply(shift(*way))
    assert edit.write().passed
    moved = cube.location - start
    assert moved.y == pytest.approx(way[1], abs=1e-4)
    assert min(way[2], 0) - ROUNDING < moved.z < max(way[2], 0) + ROUNDING
    assert deepest() < DEEPEST
    edit.restore()
    assert snapshot() == before


def test_without_collisions_nothing_is_parted() -> None:
    cube = cube_on_floor()
    edit = begin("move", EditSettings(interference=False))
    edit.drag(shift(1))
    edit.write()
    assert tuple(cube.location) == (1, 0, 1)


def test_collisions_off_and_on_within_an_edit() -> None:
    cube = cube_on_floor()
    before = snapshot()
    edit = begin()
    edit.set_interference(False)
    edit.drag(shift(0, 0, -0.5))
    edit.write()
    assert "Floor" in edit.set_interference(True)
    edit.drag(shift(1))
    assert edit.write().passed and is_clear()
    assert tuple(cube.location) == pytest.approx((1, 0, 1), abs=ROUNDING)
    edit.restore()
    assert snapshot() == before


def test_locks_that_leave_the_way_free_stay_exact() -> None:
    cube = cube_on_floor(lock_location=(False, True, False))
    cube.location.y = np.float32(0.1)
    select(cube)
    applied(shift(1, 1))
    assert tuple(cube.location) == pytest.approx((1, 0.1, 1), abs=ROUNDING)
    assert cube.location.y == np.float32(0.1)


def test_children_and_lights_move_along() -> None:
    parent = add("Parent", None, (100, 0, 0.25))
    add_grid("Floor", 1, 8.0)
    cube = add_cube("Cube", (-100, 0, 0.75), parent=parent)
    lamp = add("Lamp", bpy.data.lights.new("Lamp", "POINT"), (0, 0, 4))
    select(parent, lamp)
    before = snapshot()
    edit = applied(shift(2))
    assert evaluated(cube).mean(axis=0) == pytest.approx((2, 0, 1), abs=1e-4)
    assert tuple(lamp.location) == pytest.approx((2, 0, 4), abs=1e-4)
    edit.restore()
    assert snapshot() == before


def test_pairs_that_may_pass_stay() -> None:
    cube_on_floor()
    wall = add_cube("Wall", (1.2, 0.3, 1.5))
    passing = EditSettings(ignored_pairs=(("Cube", "Wall"),))
    edit = begin("move", passing)
    edit.apply(shift(0.5))
    assert edit.write().passed
    assert check_scene(bpy.context, EditSettings(ignored_pairs=(("Cube", "Wall"), ("Floor", "Wall")))).pairs == ()
    assert tuple(wall.location) == pytest.approx((1.2, 0.3, 1.5))


def test_beside_obstacles_of_a_large_scene(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obstacle_choice, "MIN_FACES", 0)
    cube = cube_on_floor()
    edit = applied(shift(1, 0, -1))
    assert edit.assembly.obstacles
    assert tuple(cube.location) == pytest.approx((1, 0, 1), abs=ROUNDING)


def test_cutting_obstacles_of_a_large_scene_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obstacle_choice, "MIN_FACES", 0)
    select(cutting())
    refused()


def test_a_second_start_that_fails_restores(monkeypatch: pytest.MonkeyPatch) -> None:
    cube_on_floor()
    before, start, starts = snapshot(), touching_start.start_solver_steps, []

    def failing(parted: Any) -> Any:
        starts.append(snapshot())
        if len(starts) == 2:
            raise MemoryError
        return start(parted)

    monkeypatch.setattr(touching_start, "start_solver_steps", failing)
    with pytest.raises(MemoryError):
        begin()
    assert len(starts) == 2 and starts[0] == before != starts[1]
    assert snapshot() == before


def test_a_parting_that_leaves_contact_restores_and_the_edit_begins_there(monkeypatch: pytest.MonkeyPatch) -> None:
    cube = cube_on_floor()
    monkeypatch.setattr(touching_start, "find_parting", lambda *_: np.array([0, 0, -1e-6]))
    before = snapshot()
    edit = begin()
    assert snapshot() == before
    edit.apply(shift(1, 0.5, -1))
    assert edit.write().passed
    assert tuple(cube.location) == pytest.approx((1, 0.5, 1), abs=ROUNDING)


@pytest.mark.parametrize("end", [Task.close, Task.abandon, Task.leave])
def test_a_start_that_is_cancelled_restores(end: Callable[[Task[Any]], None]) -> None:
    """Whatever step it has reached."""
    cube_on_floor()
    before, ended, reached = snapshot(), 0, set()
    while not ended:
        task = Task(BlenderEdit.begin_steps(bpy.context, SLIDE, "move"))
        for _ in range(len(reached) + 1):
            ended = task._step() is False and task._done
            if ended:
                break
        reached.add((len(reached), snapshot() != before))
        if ended:
            ended[0].restore()
            break
        end(task)
        assert snapshot() == before
    assert snapshot() == before
    assert any(changed for _, changed in reached)


def test_equal_starts_have_equal_digests_and_share_their_results() -> None:
    cube = cube_on_floor()
    first = begin()
    first.apply(shift(1, 0, -1))
    assert first.write().passed
    end, controls, digest = tuple(cube.location), first.controls, first.start_digest
    first.restore()
    first.finish()
    again = begin()
    assert again.start_digest == digest
    assert again.resume_from(controls)
    assert again.write().passed
    assert tuple(cube.location) == end


def test_the_next_edit_starts_clear() -> None:
    cube_on_floor()
    applied(shift(1, 0, -1)).finish()
    before = snapshot()
    begin()
    assert snapshot() == before


def test_a_chosen_minimum_distance_is_approached() -> None:
    """Only the automatic one yields to the gap."""
    cube = cube_on_floor(8)
    applied(shift(3), chosen=EditSettings(separation=0.01))
    assert cube.location.z == pytest.approx(1.01, abs=0.0111)


def test_separate_keeps_its_gap() -> None:
    cube = cube_on_floor()
    separate(bpy.context, EditSettings(separation=0.01))
    assert cube.location.z > 1.009


@pytest.mark.shared
@pytest.mark.parametrize("place", [7.0, np.nextafter(np.float32(7), np.float32(0)), 1023.0, 15.5, -9.0])
@pytest.mark.parametrize("distance", [0.0, 1e-7, 1e-6, 1e-5])
def test_coordinates_at_powers_of_two(place: float, distance: float) -> None:
    """The least distance that single precision can keep doubles there."""
    add_grid("Floor", 3, 8.0, (place, 0, 0))
    cube = add_cube("Cube", (place, 0, 1 + distance))
    select(cube)
    applied(shift(0, 1.5, -0.1))
    assert cube.location.y == pytest.approx(1.5, abs=1e-3)
    assert cube.location.z == pytest.approx(1, abs=1e-3)


@pytest.mark.parametrize("way", [(2.3, -1.2, -0.2), (2.3, -1.2, 0), (-3.1, 1.3, -1)])
def test_a_crate_slides_over_tiles_that_it_did_not_touch(way: tuple[float, float, float]) -> None:
    for x, y in np.ndindex(5, 5):
        add_cube(f"Tile {x} {y}", (2 * x, 2 * y, -1))
    cube = add_cube("Cube", (4, 4, 1))
    select(cube)
    edit = begin()
    edit.apply(shift(*way))
    assert edit.write().passed and is_clear("Cube")
    assert tuple(cube.location) == pytest.approx((4 + way[0], 4 + way[1], 1), abs=ROUNDING)
