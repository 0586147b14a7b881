# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard's correction in steps: the same result as at once, and the tool's own if they are closed."""

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from building import add_cube, add_grid, add_modifier, evaluated, snapshot

import stiv.task
from stiv.blender import AcceptedScene, EditSettings, Task, check_scene, guard_result, guard_result_steps, revert
from tests.stepping import take_steps

MOMENTS = (1, 2, 3, 5, 8, 13, 34, 89, 1000)  # numbers of steps
WALL = 3.0  # where its face is, along x


def scene() -> Any:
    add_cube("Wall", (WALL + 0.5, 0, 0), 1.0, scale=(0.5, 4, 4))
    grid = add_grid("Grid", 8)
    return grid


def place(grid: Any) -> None:
    grid.location.x = 9.0


def stroke(grid: Any) -> None:
    for vertex in grid.data.vertices:
        vertex.co.x += 6.0 if vertex.co.x > 0 else 0.0


def duplicate(grid: Any) -> None:
    copy = grid.copy()
    bpy.context.collection.objects.link(copy)
    copy.location.x = 3.5


def accepted_then_changed(change: Callable[[Any], None]) -> tuple[AcceptedScene, list[Any]]:
    grid = scene()
    bpy.context.view_layer.update()
    accepted = AcceptedScene.read(bpy.context, ())
    change(grid)
    bpy.context.view_layer.update()
    return accepted, snapshot()


def task_of(accepted: AcceptedScene) -> Task[Any]:
    return Task(guard_result_steps(bpy.context, EditSettings(), accepted))


def finish(task: Task[Any]) -> Any:
    while not task.advance(0.02):
        pass
    return task.result


@pytest.mark.parametrize("change", [place, stroke, duplicate])
def test_steps_give_the_result_of_the_synchronous_call(change: Callable[[Any], None]) -> None:
    accepted, _ = accepted_then_changed(change)
    outcome = finish(task_of(accepted))
    state = snapshot()
    assert outcome.wrote and check_scene(bpy.context).pairs == ()
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    accepted, _ = accepted_then_changed(change)
    assert guard_result(bpy.context, EditSettings(), accepted) == outcome
    assert snapshot() == state


@pytest.mark.parametrize("change", [place, stroke, duplicate])
def test_closed_steps_leave_the_tools_result_exactly(change: Callable[[Any], None]) -> None:
    """Wherever they are."""
    for steps in MOMENTS:
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        accepted, changed = accepted_then_changed(change)
        task = task_of(accepted)
        if take_steps(task, steps):
            break
        task.abandon()
        bpy.context.view_layer.update()
        assert snapshot() == changed
    assert steps > 5


def test_steps_that_are_left_write_nothing_more() -> None:
    """The caller restores the accepted state, once: each state of a large mesh takes a while to write."""
    accepted, _ = accepted_then_changed(stroke)
    task = task_of(accepted)
    assert not take_steps(task, 3)
    shown = snapshot()
    task.leave()
    assert snapshot() == shown
    revert(bpy.context, accepted.state)
    assert evaluated(bpy.data.objects["Grid"])[:, 0].max() < WALL
    grid = next(state for state in accepted.state.values() if state.reference.name == "Grid")
    assert np.array_equal(evaluated(bpy.data.objects["Grid"]), grid.points)


def test_a_new_object_stays_where_the_tool_put_it_if_steps_are_left() -> None:
    accepted, changed = accepted_then_changed(duplicate)
    for steps in MOMENTS:
        task = task_of(accepted)
        if take_steps(task, steps):
            break
        task.leave()
        bpy.context.view_layer.update()
        assert snapshot() == changed
    assert steps > 5


def test_a_scene_shows_the_accepted_state_while_a_correction_solves() -> None:
    accepted, _ = accepted_then_changed(stroke)
    before = [state.points for state in accepted.state.values() if state.reference.name == "Grid"]
    task = task_of(accepted)
    seen = 0
    while not take_steps(task, 1):
        if evaluated(bpy.data.objects["Grid"])[:, 0].max() < WALL:
            seen += 1
    assert seen and len(before) == 1


def changed_users() -> AcceptedScene:
    """A stroke on a mesh with users of different modifiers, each of which Blender evaluates on a copy."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    add_cube("Wall", (WALL + 0.5, 0, 0), 1.0, scale=(0.5, 4, 4))
    grid = add_grid("Grid", 4)
    for number in range(1, 5):
        user = bpy.data.objects.new(f"Grid {number}", grid.data)
        user.location.z, user.rotation_euler.x = 3.0 * number, 0.1 * number
        bpy.context.collection.objects.link(user)
        add_modifier(user, "DISPLACE", strength=0.1 * number)
    bpy.context.view_layer.update()
    accepted = AcceptedScene.read(bpy.context, ())
    stroke(grid)
    grid.data.update()
    bpy.context.view_layer.update()
    return accepted


def stored() -> list[str]:
    """Names of all that a file would store."""
    return sorted(
        each.name for kind in ("scenes", "objects", "meshes", "collections") for each in getattr(bpy.data, kind)
    )


def test_reading_many_users_takes_turns_and_leaves_nothing_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stiv.task, "TURN", 0.0)
    outcome = guard_result(bpy.context, EditSettings(), changed_users())
    state, names = snapshot(), stored()
    assert outcome.wrote and check_scene(bpy.context).pairs == ()
    phases = set()
    for turns in (1, 2, 3, 5, 8, 12):
        task, changed = task_of(changed_users()), snapshot()
        for _ in range(turns):
            assert not take_steps(task, 1)
            phases.add(task.progress.phase)
        task.abandon()
        assert snapshot() == changed and stored() == names
    assert "" in phases  # before the first job of the core, while it reads
    assert finish(task_of(changed_users())) == outcome and snapshot() == state and stored() == names
