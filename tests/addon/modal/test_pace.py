# SPDX-License-Identifier: GPL-3.0-or-later
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiv_addon.modal.pace import FRAME, Pace


@pytest.mark.parametrize("showing", [0.0, 0.01, 0.03, 0.05])
@pytest.mark.parametrize("solving", [0.005, 0.02, 0.04])
def test_a_state_is_written_at_once_if_a_frame_has_time_for_both(showing: float, solving: float) -> None:
    pace = Pace()
    for _ in range(60):
        pace.note(showing)
    assert pace.has_time_to_write(solving) == (solving + showing < FRAME)


@given(st.lists(st.floats(0, 10)))
def test_an_idle_tick_always_writes_and_there_is_always_time_to_solve(costs: list[float]) -> None:
    pace = Pace()
    for cost in costs:
        pace.note(cost)
    assert pace.has_time_to_write(0.0) and 0.9 * FRAME < pace.budget < FRAME


def test_the_expected_cost_of_writing_follows_the_last_measurements() -> None:
    pace = Pace()
    pace.note(0.1)
    assert not pace.has_time_to_write(0.02)
    for _ in range(20):
        pace.note(0.001)
    assert pace.has_time_to_write(0.02)
