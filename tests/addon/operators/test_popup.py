# SPDX-License-Identifier: GPL-3.0-or-later
"""When the popup of a refused drag opens; tests in a window open it."""

import pytest

pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

from stiv_addon.operators.repair.popup import LONGEST, REST, decide


@pytest.mark.parametrize(
    ("still", "waited", "expected"),
    [(0, 0, "wait"), (REST - 1, 20, "wait"), (REST, REST, "open"), (0, LONGEST - 1, "wait")],
)
def test_it_opens_when_the_mouse_rests(still: int, waited: int, expected: str) -> None:
    assert decide("TIMER", "NOTHING", still, waited) == expected


def test_it_opens_in_the_end_under_a_moving_mouse() -> None:
    assert decide("MOUSEMOVE", "NOTHING", 0, LONGEST) == "wait"
    assert decide("TIMER", "NOTHING", 0, LONGEST) == "open"


def test_keys_and_clicks_open_or_cancel_it() -> None:
    assert decide("X", "PRESS", 0, 0) == decide("LEFTMOUSE", "PRESS", 0, 0) == "open"
    assert decide("ESC", "PRESS", 0, 0) == decide("RIGHTMOUSE", "PRESS", 0, 0) == "cancel"
    assert decide("M", "RELEASE", 0, 0) == "wait"
