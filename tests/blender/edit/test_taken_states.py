# SPDX-License-Identifier: GPL-3.0-or-later
"""States that are written while a job already solves for the next goal."""

import threading
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np
import pytest
from building import cube_above_floor, select, shift

import stiv
from benchmarks.sessions import dragged_frames
from benchmarks.sessions.in_blender import drags_in_blender
from stiv.blender import BlenderEdit, EditSettings
from stiv.blender.edit import state_writer
from stiv.blender.verify.scene_check import find_pairs, read_surface
from stiv.task import Task

BLEND = Path(__file__).resolve().parents[3] / "blend_fixtures/sphere_along_wall.blend"


def begin(kind: str = "move", settings: EditSettings | None = None) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, settings or EditSettings(), kind)


def busy(edit: BlenderEdit, goal: object) -> Task:
    """A task whose job uses the session."""
    task = Task(edit.drag_steps(goal, time_budget=10.0))
    task.start()
    return task


def end(task: Task) -> stiv.EditResult:
    while not task.advance(1.0):
        pass
    return task.result


def test_a_taken_state_is_written_while_the_session_solves_on() -> None:
    cube = cube_above_floor()
    select(cube)
    edit = begin()
    edit.drag(shift(x=0.5))
    taken = edit.take_state()
    task = busy(edit, shift(x=1.5))
    report = edit.write_taken(taken)
    assert report is not None and report.passed
    assert cube.location.x == pytest.approx(0.8)
    assert end(task).status == "reached" and edit.write().passed
    assert cube.location.x == pytest.approx(1.8)
    edit.restore()
    assert cube.location.x == pytest.approx(0.3)


def test_a_taken_state_that_intersects_is_refused_and_the_last_one_comes_back() -> None:
    """An obstacle driven into the way during the edit is found on Blender's own evaluation."""
    cube = cube_above_floor()
    select(cube)
    edit = begin()
    edit.drag(shift(x=0.5))
    taken = edit.take_state()
    bpy.data.objects["Floor"].location.z = 1.5
    task = busy(edit, shift(x=0.6))
    assert edit.write_taken(taken) is None
    end(task)
    assert not edit.write().passed and cube.location.x == pytest.approx(0.3)


def test_a_state_taken_before_the_edit_was_restored_is_refused() -> None:
    cube = cube_above_floor()
    select(cube)
    edit = begin()
    edit.drag(shift(x=0.5))
    taken = edit.take_state()
    edit.restore()
    assert edit.write_taken(taken) is None and cube.location.x == pytest.approx(0.3)


def test_no_state_is_taken_without_collisions() -> None:
    select(cube_above_floor())
    edit = begin(settings=EditSettings(interference=False))
    edit.drag(shift(x=0.5))
    assert edit.take_state() is None


class Watch:
    """Counts writings and their threads, and tests the scene after each."""

    def __init__(self) -> None:
        self.threads: set[int] = set()
        self.beside = 0


@pytest.fixture
def watch(monkeypatch: pytest.MonkeyPatch) -> Iterator[Watch]:
    found = Watch()
    write, write_taken = state_writer.StateWriter.write, state_writer.StateWriter.write_taken

    def watched(writer: state_writer.StateWriter, controls: np.ndarray) -> None:
        found.threads.add(threading.get_ident())
        write(writer, controls)

    def watched_taken(writer: state_writer.StateWriter, taken: state_writer.TakenState) -> bool:
        passed = write_taken(writer, taken)
        found.beside += passed
        if passed:
            assert find_pairs(read_surface(bpy.context)) == ()
        return passed

    monkeypatch.setattr(state_writer.StateWriter, "write", watched)
    monkeypatch.setattr(state_writer.StateWriter, "write_taken", watched_taken)
    yield found


@pytest.mark.usefixtures("registered")
def test_a_drag_writes_beside_its_solves_from_one_thread_what_passes_the_test(
    watch: Watch, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After each writing, the whole scene is checked again."""
    from stiv_addon.modal import drag_loop

    monkeypatch.setattr(drag_loop, "FITTING", 0.0)  # also of short solves
    monkeypatch.setattr(dragged_frames, "SPEED", 4.0)  # slow enough for several of them
    stages = drags_in_blender(BLEND, 2)
    assert watch.beside > 0 and watch.threads == {threading.get_ident()}
    assert all(tick.passed for stage in stages for tick in stage.ticks)
    assert find_pairs(read_surface(bpy.context)) == ()
