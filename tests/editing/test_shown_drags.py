# SPDX-License-Identifier: GPL-3.0-or-later
"""Drags whose calls end at their first acceptance, so that each state can be shown."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

import stiv
from benchmarks.settling import Array
from benchmarks.whole_drags import goals
from blend_fixtures.scenes.sessions.dressing import session as dressing
from blend_fixtures.scenes.sessions.lattice_stage import lattice_stage
from blend_fixtures.scenes.sessions.session import Stage
from blend_fixtures.scenes.sessions.tree_in_corner import tree_in_corner


def shirt() -> Stage:
    """A shirt that shrinks onto a body: more than a hundred contacts at once, through one cage."""
    stages = dressing().stages()
    expanding = next(stages)
    session = stiv.EditSession(expanding.surface, expanding.deformation, expanding.controls)
    session.edit(goals(expanding)[-1])
    return stages.send(session.controls)


@pytest.mark.parametrize(("make", "pace"), [(lambda: lattice_stage(tree_in_corner()), 4), (shirt, 1)])
def test_states_are_free_and_near_their_goals(make: Callable[[], Stage], pace: int) -> None:
    """Calls solve as the last one did where constraints overshoot, and begin with its contacts.

    Each state is free by the exact test, threads change none, and settling ends as near as without showing states.
    """
    stage = make()
    ends = goals(stage)[pace - 1 :: pace]
    surface = stage.deformation.surface

    def missing(controls: Array, goal: Array) -> float:
        return float(np.sum((surface(controls) - surface(goal)) ** 2))

    def dragged(threads: int, hand_over: float | None) -> list[Array]:
        session = stiv.EditSession(stage.surface, stage.deformation, stage.controls, stiv.EditOptions(threads=threads))
        states = [session.drag(end, hand_over=hand_over).controls for end in ends]
        return [stage.controls, *states, session.settle().controls]

    shown = dragged(1, 0.0)
    assert np.array_equal(shown, dragged(2, 0.0))
    for (before, after), goal in zip(pairwise(shown), ends, strict=False):
        assert len(stiv.find_intersections(surface(after), stage.surface)) == 0
        assert missing(after, goal) <= 1.1 * missing(before, goal)
    whole = dragged(2, None)
    assert missing(shown[-1], ends[-1]) <= 1.05 * missing(whole[-1], ends[-1])


def test_the_contacts_of_the_last_solve_spare_rounds() -> None:
    """Against solves from the same states by sessions that have just been restored."""
    stage = shirt()
    ends, last = goals(stage), stage.controls
    session = stiv.EditSession(stage.surface, stage.deformation, stage.controls)
    other = stiv.EditSession(stage.surface, stage.deformation, stage.controls)
    rounds, energies = [], []
    for end in ends:
        other.restore(session.controls, last)
        results = [each.drag(end, hand_over=0.0) for each in (session, other)]
        rounds.append([each.rounds for each in results])
        energies.append([each.energy for each in results])
        last = end
    kept, found_again = np.sum(rounds[1:], axis=0)
    assert kept < 0.8 * found_again
    kept, found_again = np.sum(energies[1:], axis=0)
    assert kept < 1.02 * found_again


def test_contacts_that_have_ended_hold_nothing_back() -> None:
    """The shirt is widened past its first size: it leaves the body, and is exactly at its goal some calls later."""
    stage = shirt()
    session = stiv.EditSession(stage.surface, stage.deformation, stage.controls)
    for end in goals(stage):
        session.drag(end, hand_over=0.0)
    wide = stage.controls + 0.3 * (stage.controls - goals(stage)[-1])
    statuses = [session.drag(wide, hand_over=0.0).status for _ in range(12)]
    assert "reached" in statuses and np.allclose(session.controls, wide, atol=1e-6)
