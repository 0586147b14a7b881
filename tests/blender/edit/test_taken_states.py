# SPDX-License-Identifier: GPL-3.0-or-later
"""States that are written while a job already solves for the next goal."""

import math
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from building import cube_above_floor, select, shift

import stiv
from benchmarks.sessions import in_blender
from stiv.blender import BlenderEdit, EditSettings
from stiv.blender.edit import state_writer
from stiv.blender.verify.scene_check import find_pairs, read_surface
from stiv.task import Task

BLEND = Path(__file__).resolve().parents[3] / "blend_fixtures/sphere_along_wall.blend"
MOST_MOTIONS = 50_000  #: a drag that never writes beside a solve must end too


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


def test_the_last_state_comes_back_while_the_session_solves_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is tested again; a scene that someone changed is refused."""
    verdicts = iter([True, True, False, False, False, True])
    monkeypatch.setattr(stiv.DeviationTest, "is_free", lambda *_: next(verdicts, True))
    cube = cube_above_floor()
    select(cube)
    edit = begin()
    shown = []
    for x in (0.5, 1.0):
        edit.drag(shift(x=x))
        taken = edit.take_state()
        task = busy(edit, shift(x=1.5))
        passed = edit.write_taken(taken) is not None
        shown.append((passed, edit.write_shown(), round(cube.location.x, 6)))
        end(task)
    assert shown[1:] == [(False, True, 0.8)] and not list(verdicts)
    bpy.data.objects["Floor"].location.z = 1.5
    assert not edit.write_shown()
    bpy.data.objects["Floor"].location.z = 0.0
    assert edit.write().passed and cube.location.x == pytest.approx(1.8)
    edit.restore()
    assert not edit.write_shown() and cube.location.x == pytest.approx(0.3)


def test_a_state_that_fails_by_rounding_is_written_a_few_roundings_nearer_to_the_last_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    cube = cube_above_floor()
    select(cube)
    edit = begin()
    edit.drag(shift(x=1.0))
    accepted = edit.controls
    verdicts = iter([False, True])
    monkeypatch.setattr(stiv.DeviationTest, "is_free", lambda *_: next(verdicts))
    assert edit.write_taken(edit.take_state()) is not None and not list(verdicts)
    assert 0 < 1.3 - cube.location.x < 1e-5 and np.array_equal(edit.controls, accepted)
    verdicts = iter([True])
    assert edit.write_shown() and 0 < 1.3 - cube.location.x < 1e-5
    assert edit.write().passed and cube.location.x == pytest.approx(1.3, abs=1e-7)


def test_a_complete_test_that_fails_by_rounding_accepts_a_state_that_passes(monkeypatch: pytest.MonkeyPatch) -> None:
    """The edit does not stop early for it."""
    cube = cube_above_floor()
    select(cube)
    edit = begin()
    edit.drag(shift(x=1.0))
    verdicts = iter([False, False, True])
    monkeypatch.setattr(stiv.EditSession, "is_step_free", lambda *_: next(verdicts))
    report = edit.write()
    assert report.passed and not report.message and not list(verdicts)
    assert 0 < 1.3 - cube.location.x < 2e-5
    assert edit.moving_points(edit.controls)[:, 0].max() == pytest.approx(cube.location.x + 1, abs=1e-6)
    monkeypatch.undo()
    assert edit.drag(shift(x=2.0)).status == "reached" and edit.write().passed


def test_a_search_decides_only_if_blender_shows_more_than_rounding(monkeypatch: pytest.MonkeyPatch) -> None:
    searches: list[bool] = []
    is_end_free = stiv.StepCheck.is_end_free

    def watched(check: stiv.StepCheck, start: np.ndarray, end: np.ndarray) -> bool:
        searches.append(is_end_free(check, start, end))
        return searches[-1]

    monkeypatch.setattr(stiv.StepCheck, "is_end_free", watched)
    select(cube_above_floor())
    edit = begin()
    for x, expected in ((0.5, []), (1.0, [True])):
        edit.drag(shift(x=x))
        taken = edit.take_state()
        assert taken is not None and taken.deviations is not None
        if expected:
            monkeypatch.setattr(stiv.DeviationTest, "is_free", lambda *_: None)
        assert edit.write_taken(taken) is not None and searches == expected
    edit.restore()


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
    """After each writing, the whole scene is checked again. The mouse moves until three states were written so."""
    from stiv_addon.modal import drag_loop

    begun = in_blender.ScriptedDrag.begun

    def moving_on(*arguments: Any) -> in_blender.ScriptedDrag:
        drag, enough = begun(*arguments), watch.beside + 3
        for motion in range(MOST_MOTIONS):
            if watch.beside >= enough:
                break
            drag.point(1.0 + 0.5 * math.sin(motion / 100))
            drag.tick()
            time.sleep(0.001)
        return drag

    monkeypatch.setattr(in_blender.ScriptedDrag, "begun", moving_on)
    monkeypatch.setattr(drag_loop, "FRAME", 0.0)  # no solve ends in the tick that began it, so another goal waits
    monkeypatch.setattr(drag_loop, "FITTING", 0.0)  # also of short solves
    stages = in_blender.drags_in_blender(BLEND, 2)
    assert watch.beside >= 3 * len(stages) and watch.threads == {threading.get_ident()}
    assert all(tick.passed for stage in stages for tick in stage.ticks)
    assert find_pairs(read_surface(bpy.context)) == ()
