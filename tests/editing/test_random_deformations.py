# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of all edits, for any deformation, mode, weights and separation.

A sample runs by default; STIV_LONG=1 runs 2,000 edits.
"""

from __future__ import annotations

import os
from dataclasses import replace

import numpy as np
import pytest

import stiv
from tests.editing.random_deformations import BUILDERS, Case, random_cases

COUNT = 2000 if "STIV_LONG" in os.environ else 240
CHUNK = 48  # edits per test


def answered(session: stiv.EditSession, how: str, goal: np.ndarray) -> stiv.EditResult:
    """Solve for a goal; a drag takes five moves, and the last result counts."""
    if how == "settle":
        session.edit(goal)
        return session.settle()
    if how == "edit":
        return session.edit(goal)
    start = session.controls
    for share in (0.2, 0.4, 0.6, 0.8):
        session.drag(start + share * (goal - start))
    return session.drag(goal)


def motion_was_possible(case: Case, session: stiv.EditSession, goal: np.ndarray, separation: float) -> bool:
    """Is a hundredth of the straight path to the goal clear, and longer than the rounding of storage?"""
    start = session.controls
    near = (start + 0.01 * (goal - start)).astype(np.float32).astype(float)
    if np.array_equal(near, start):
        return False
    end = case.edit.deformation.surface(near)
    return stiv.is_step_free(case.edit.surface, session.surface, end, separation)


def check(case: Case) -> None:
    edit = case.edit
    session = stiv.EditSession(edit.surface, edit.deformation, edit.controls, case.options)
    widest = max([session.separation, *case.options.pair_separations.values()])
    for how, goal in case.goals:
        before = session.controls
        result = answered(session, how, goal)
        where = f"{case.name}, {how}"
        assert edit.deformation.surface(result.controls).tobytes() == result.surface.tobytes(), where
        stored = result.controls.astype(np.float32).astype(float)
        assert np.allclose(stored, result.controls, rtol=1e-14, atol=0), where
        for controls in (stored, result.controls):
            assert len(stiv.find_intersections(edit.deformation.surface(controls), edit.surface)) == 0, where
        if case.options.weights is not None:
            weights = np.asarray(case.options.weights)
            pinned = np.broadcast_to(weights.reshape(len(goal), -1) == 0, goal.shape)
            still = pinned & ((goal == before) if weights.ndim == 2 else (goal == before).all(axis=1, keepdims=True))
            assert result.controls[still].tobytes() == before[still].tobytes(), where
        if how == "edit" and not result.path and result.status != "unchanged":
            assert not motion_was_possible(case, session, goal, widest), f"{where}: refused"


CASES = list(random_cases(COUNT, seed=11))


@pytest.mark.parametrize("first", range(0, len(CASES), CHUNK // 4))
def test_no_intersections_pins_hold_and_possible_motions_are_accepted(first: int) -> None:
    for case in CASES[first : first + CHUNK // 4]:
        check(case)


def test_all_deformations_participate() -> None:
    assert {case.edit.name for case in CASES} == {build().name for build in BUILDERS}


def test_weights_along_axes_give_the_same_bits_for_any_number_of_threads() -> None:
    by_axis = [case for case in CASES if np.ndim(case.options.weights) == 2]
    assert len(by_axis) >= 3
    for case in by_axis[:6]:
        found = []
        for threads in (1, 3):
            options = replace(case.options, threads=threads)
            session = stiv.EditSession(case.edit.surface, case.edit.deformation, case.edit.controls, options)
            for _, goal in case.goals[:2]:
                session.edit(goal)
            found.append(session.controls.tobytes())
        assert found[0] == found[1], case.name
