# SPDX-License-Identifier: GPL-3.0-or-later
"""Jobs: the bits of synchronous calls, sessions in use, cancellation, errors."""

from __future__ import annotations

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes import families, tangled


@pytest.fixture
def edit() -> families.Edit:
    """Two sheets, one pushed through the other."""
    return families.sheets(0.4, cells=8)


def session_of(edit: families.Edit) -> stiv.EditSession:
    return stiv.EditSession(edit.surface, edit.deformation, edit.controls)


@pytest.mark.parametrize("name", ["edit", "drag"])
def test_a_job_gives_the_bits_of_the_synchronous_call(edit: families.Edit, name: str) -> None:
    expected, job_session = session_of(edit), stiv.EditSession.start(edit.surface, edit.deformation, edit.controls)
    session = job_session.result()
    for call in (name, "settle"):
        goal = () if call == "settle" else (edit.goal,)
        result = getattr(expected, call)(*goal)
        job = getattr(session, f"start_{call}")(*goal)
        assert np.array_equal(job.result().controls, result.controls)
        assert job.result().status == result.status
        assert job.result() is job.result()
        assert job.poll().done
        assert job.poll().phase
    assert np.array_equal(session.surface, expected.surface)


def test_a_session_in_use_by_a_job_refuses_calls_until_the_job_is_done(edit: families.Edit) -> None:
    fine = families.sheets(0.4, cells=40)
    session = session_of(fine)
    job = session.start_edit(fine.goal)
    assert not job.poll().done
    for call in (session.settle, session.start_settle, lambda: session.surface, lambda: session.restore(fine.controls)):
        with pytest.raises(stiv.InputError, match="in use by another call"):
            call()
    job.cancel()
    assert job.result().status == "cancelled"
    assert np.array_equal(session.controls, fine.controls)
    assert session.edit(fine.controls).status == "unchanged"


def test_a_job_that_nobody_keeps_is_cancelled() -> None:
    fine = families.sheets(0.4, cells=40)
    session = session_of(fine)
    job = session.start_edit(fine.goal)
    del job
    assert np.array_equal(session.controls, fine.controls)


def test_errors_of_a_job_are_those_of_the_call(edit: families.Edit) -> None:
    flat = edit.controls * (1, 1, 0)
    with pytest.raises(stiv.StartIntersectsError) as caught:
        stiv.EditSession.start(edit.surface, edit.deformation, flat).result()
    assert caught.value.pairs.shape[1] == 2
    with pytest.raises(stiv.InputError, match="goal"):
        session_of(edit).start_edit(edit.goal[:-1]).result()
    assert issubclass(stiv.CancelledError, RuntimeError)


def test_a_cancelled_construction_is_interrupted() -> None:
    fine = families.sheets(0.4, cells=100)
    job = stiv.EditSession.start(fine.surface, fine.deformation, fine.controls)
    job.cancel()
    with pytest.raises(stiv.CancelledError):
        job.result()


@pytest.mark.parametrize("name", ["contract", "repair"])
def test_repairs_run_as_jobs(name: str) -> None:
    tube = tangled.hairpin(0.25, rings=40, sides=8)
    expected = getattr(stiv, name)(tube.surface, tube.positions)
    result = getattr(stiv, f"start_{name}")(tube.surface, tube.positions).result()
    assert np.array_equal(result.positions, expected.positions)
    assert not np.array_equal(result.positions, tube.positions)


def test_expansions_run_as_jobs(edit: families.Edit) -> None:
    given = edit.surface, edit.controls, edit.goal
    expected = stiv.expand(*given, deformation=edit.deformation)
    job = stiv.start_expand(*given, deformation=edit.deformation)
    assert np.array_equal(job.result().controls, expected.controls)
