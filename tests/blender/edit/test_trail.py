# SPDX-License-Identifier: GPL-3.0-or-later
"""Trails of accepted states, and searches along them."""

from types import SimpleNamespace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from stiv.blender.edit.trail import AcceptedState, Trail, find_latest, find_latest_steps


def controls(number: int) -> np.ndarray:
    return np.full((1, 3), float(number))


def trail_of(*paths: list[int]) -> Trail:
    trail = Trail(controls(0), controls(0))
    for number, path in enumerate(paths):
        trail.add(controls(100 + number), SimpleNamespace(path=[controls(each) for each in path]))
    return trail


@given(st.lists(st.booleans(), max_size=40))
def test_the_state_found_passes_and_the_next_one_fails(holding: list[bool]) -> None:
    states = [AcceptedState(controls(k), k, 0) for k in range(len(holding))]
    found = find_latest(states, lambda place: holding[place.call])
    if found is None:
        assert not holding or not holding[0]
        return
    assert holding[found.call]
    assert found.call + 1 == len(holding) or not holding[found.call + 1]


@given(st.integers(1, 500), st.data())
def test_few_states_are_tested(count: int, data: st.DataObject) -> None:
    end = data.draw(st.integers(1, count))
    states, seen = [AcceptedState(controls(k), k, 0) for k in range(count)], []
    found = find_latest(states, lambda place: seen.append(place.call) or place.call < end)
    assert found is not None and found.call == end - 1
    assert len(seen) <= 2 * np.log2(count) + 3


@given(st.lists(st.booleans(), max_size=40), st.integers(0, 12))
def test_a_cancelled_search_ends_at_a_state_that_passes(holding: list[bool], turns: int) -> None:
    """It tests one more state at most: the first one, if none has passed yet."""
    states, seen = [AcceptedState(controls(k), k, 0) for k in range(len(holding))], []
    steps = find_latest_steps(states, lambda place: seen.append(place.call) or holding[place.call])
    found, tested = None, 0
    try:
        next(steps)
        for turn in range(100):
            tested = len(seen) if turn <= turns else tested
            steps.send(turn >= turns)
    except StopIteration as end:
        found = end.value
    passing = [number for number in seen if holding[number]]
    assert (found.call if found else None) == max(passing, default=None)
    assert tested == 0 or len(seen) <= tested + 1
    assert found is not None or not any(holding[:1])


def test_a_truncated_trail_keeps_the_calls_before_the_state() -> None:
    trail = trail_of([1, 2], [3, 4, 5], [], [6])
    place = next(each for each in trail.states() if each.controls[0, 0] == 4)
    assert trail.goal_at(place)[0, 0] == 101
    left = trail.truncate_at(place)
    assert [call.goal[0, 0] for call in left] == [101, 102, 103]
    assert [int(each.controls[0, 0]) for each in trail.states()] == [0, 1, 2, 3, 4]


def test_truncating_at_the_written_state_removes_all_calls() -> None:
    trail = trail_of([1], [2])
    assert len(trail.truncate_at(trail.states()[0])) == 2
    assert trail.calls == []
    assert trail.goal_at(trail.states()[0])[0, 0] == 0
