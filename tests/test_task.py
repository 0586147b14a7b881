# SPDX-License-Identifier: GPL-3.0-or-later
"""Tasks: the same steps at once or with jobs, turns, cancellation, errors."""

from __future__ import annotations

import gc
import weakref

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes import families
from stiv.task import Call, Steps, Task, run


@pytest.fixture
def edit() -> families.Edit:
    """Two sheets, one pushed through the other."""
    return families.sheets(0.4, cells=8)


def session_of(edit: families.Edit) -> stiv.EditSession:
    return stiv.EditSession(edit.surface, edit.deformation, edit.controls)


def halfway_and_back(session: stiv.EditSession, edit: families.Edit) -> Steps[list[str]]:
    """Two drags with a turn between them, each shorter if it is cancelled."""
    statuses = []
    for goal in ((edit.controls + edit.goal) / 2, edit.goal):
        result = yield Call(session.drag, session.start_drag, goal)
        statuses.append(result.status)
        yield None
    return statuses


def test_steps_give_the_same_bits_at_once_and_as_jobs(edit: families.Edit) -> None:
    at_once, in_jobs = session_of(edit), session_of(edit)
    expected = run(halfway_and_back(at_once, edit))
    task, turns = Task(halfway_and_back(in_jobs, edit)), 0
    while not task.advance(10.0):
        turns += 1
    assert task.result == expected
    assert turns == 2
    assert task.progress.done
    assert np.array_equal(in_jobs.surface, at_once.surface)


def test_a_task_that_is_done_is_freed_without_a_collection(edit: families.Edit) -> None:
    """Freeing the results of many solves at once would take as long as a frame."""
    task = Task(halfway_and_back(session_of(edit), edit))
    freed = weakref.ref(task)
    gc.disable()
    try:
        while not task.advance(1.0):
            pass
        del task
        assert freed() is None
    finally:
        gc.enable()


def test_a_task_without_time_never_waits_and_ends_nevertheless(edit: families.Edit) -> None:
    task = Task(halfway_and_back(session_of(edit), edit))
    assert not task.advance()
    while not task.advance():
        pass
    assert len(task.result) == 2


@pytest.mark.parametrize("starts_before", [True, False])
def test_cancelling_reaches_the_present_and_all_later_jobs(edit: families.Edit, starts_before: bool) -> None:
    """Each job waits for a call in this thread, so that none ends before it is cancelled."""
    rows = np.arange(edit.deformation.control_count)
    unit = np.tile(np.eye(3), (len(rows), 1, 1))
    free = stiv.observed(lambda p: p, (np.arange(len(rows) + 1), rows, unit, (len(rows), len(rows))))
    session = stiv.EditSession(edit.surface, free, edit.controls)
    task = Task(halfway_and_back(session, edit))
    if starts_before:
        task.start()
    task.cancel()
    while not task.advance(1.0):
        pass
    assert task.result == ["cancelled", "cancelled"]
    assert np.array_equal(session.controls, edit.controls)


@pytest.mark.parametrize("as_jobs", [False, True])
def test_a_turn_receives_whether_the_work_is_cancelled(as_jobs: bool) -> None:
    heard = []

    def steps() -> Steps[None]:
        heard.append((yield None))
        token.cancel()
        task.cancel()
        yield 0.5
        heard.append((yield None))

    token, task = stiv.CancelToken(), Task(steps())
    if not as_jobs:
        run(steps(), cancel=token)
    while as_jobs and not task.advance():
        pass
    assert heard == [False, True]


def test_a_closed_task_leaves_the_session_free(edit: families.Edit) -> None:
    fine = families.sheets(0.4, cells=40)
    session = session_of(fine)
    task = Task(halfway_and_back(session, fine))
    task.advance()
    task.close()
    assert np.array_equal(session.controls, fine.controls)


@pytest.mark.parametrize("as_jobs", [False, True])
def test_errors_reach_the_steps_and_then_the_caller(edit: families.Edit, as_jobs: bool) -> None:
    caught = []

    def steps() -> Steps[None]:
        for controls in (edit.controls * (1, 1, 0), edit.controls[:-1]):
            given = edit.surface, edit.deformation, controls
            try:
                yield Call(stiv.EditSession, stiv.EditSession.start, *given)
            except stiv.StartIntersectsError as error:
                caught.append(error)

    with pytest.raises(stiv.InputError, match="controls"):
        if as_jobs:
            task = Task(steps())
            while not task.advance(1.0):
                pass
        else:
            run(steps())
    assert len(caught) == 1
