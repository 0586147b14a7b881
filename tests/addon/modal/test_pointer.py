# SPDX-License-Identifier: GPL-3.0-or-later
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiv_addon.modal.pointer import PRECISION, Pointer

PIXELS = st.tuples(st.integers(-4000, 4000), st.integers(-4000, 4000))


@given(st.lists(PIXELS, min_size=1, max_size=30), PIXELS)
def test_without_precision_only_the_last_position_matters(path: list, start: tuple) -> None:
    pointer = Pointer.at(start)
    for mouse in path:
        pointer = pointer.moved(mouse)
    assert pointer.effective == path[-1] == pointer.last
    assert pointer.start == start


def test_precision_scales_the_motion_by_a_tenth() -> None:
    pointer = Pointer.at((0.0, 0.0)).moved((100.0, 0.0)).moved((200.0, 50.0), precise=True)
    assert pointer.effective == pytest.approx((100.0 + 100.0 * PRECISION, 50.0 * PRECISION))
    assert pointer.moved((210.0, 50.0)).effective == pytest.approx((120.0, 5.0))


@pytest.mark.parametrize("turns", [-2.5, -0.25, 0.25, 1.0, 3.0])
def test_turns_add_up_beyond_a_full_one(turns: float) -> None:
    pointer = Pointer.at((110.0, 10.0), centre=(10.0, 10.0))
    steps = 60
    for i in range(1, steps + 1):
        angle = 2.0 * math.pi * turns * i / steps
        pointer = pointer.moved((10.0 + 100.0 * math.cos(angle), 10.0 + 100.0 * math.sin(angle)))
    assert pointer.turn == pytest.approx(2.0 * math.pi * turns)


def test_a_pointer_on_the_centre_does_not_turn() -> None:
    pointer = Pointer.at((5.0, 5.0), centre=(5.0, 5.0)).moved((5.0, 5.0)).moved((9.0, 5.0))
    assert pointer.turn == 0.0
