# SPDX-License-Identifier: GPL-3.0-or-later
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiv_addon.modal.pace import FRAME, LONGEST_FRAME, Pace

COSTS = st.floats(0, 10)


@pytest.mark.parametrize(("showing", "frame"), [(0.0, FRAME), (0.015, FRAME), (0.03, 0.06), (0.04, 0.08)])
def test_solving_gets_what_showing_leaves_of_a_frame(showing: float, frame: float) -> None:
    pace = Pace()
    for _ in range(100):
        pace.note(showing)
    assert frame - 0.005 < showing + pace.budget < frame


@given(st.lists(COSTS))
def test_there_is_always_time_to_solve(costs: list[float]) -> None:
    pace = Pace()
    for cost in costs:
        pace.note(cost)
        assert LONGEST_FRAME / 5 < pace.budget < LONGEST_FRAME or FRAME / 5 < pace.budget < FRAME


def test_one_dear_tick_is_remembered_for_some_and_then_forgotten() -> None:
    pace = Pace()
    pace.note(0.02)
    pace.note(0.001)
    remembered = pace.budget
    for _ in range(50):
        pace.note(0.001)
    assert remembered < pace.budget
