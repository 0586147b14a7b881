# SPDX-License-Identifier: GPL-3.0-or-later
"""Header and status bar, in any language: every word of them is translated."""

from dataclasses import replace

from stiv_addon.modal.axis_lock import AxisLock
from stiv_addon.modal.header_texts import header_text, result_text, status_text
from stiv_addon.modal.pointer import Pointer
from stiv_addon.modal.proportional import Proportional
from stiv_addon.modal.request import Request
from stiv_addon.modal.state import State
from stiv_addon.transform.translation import Translation

PLAIN = State(Pointer.at((0.0, 0.0), None))


def shout(text: str) -> str:
    """A language in which everything is written in capitals."""
    return text.upper()


def test_a_plain_header_is_the_value_and_the_status() -> None:
    assert header_text(PLAIN, "Move X 1", "clear") == "Move X 1  |  clear"


def test_the_header_names_modes_that_differ_from_the_defaults() -> None:
    proportional = Proportional(available=True, on=True, size=1.5, falloff="INVERSE_SQUARE", connected=True)
    state = replace(
        PLAIN, request=Request("move", "all"), precise=True, snap=True, proportional=proportional,
        axis_lock=AxisLock(0),
    )  # fmt: skip
    header = header_text(state, "Move", "", ["a note"], ("GLOBAL", "LOCAL"))
    assert header == (
        "Move  along Global X  proportional 1.5 Inverse Square connected  precision  snap  yields: both  |  a note"
    )


def test_every_word_of_a_header_is_translated_and_names_of_objects_are_not() -> None:
    state = replace(PLAIN, precise=True, request=Request("move", "unselected"))
    verdict = result_text("blocked", ["Vase", "wall"], shout)
    value = Translation((1.0, 0.0, 0.0)).text(shout)
    assert header_text(state, value, verdict, translate=shout) == (
        "MOVE X 1  Y 0  Z 0  (DISTANCE 1)  PRECISION  YIELDS: OTHERS  |  BLOCKED BY Vase, wall"
    )


def test_every_word_of_the_status_bar_is_translated() -> None:
    proportional = Proportional(available=True, on=True)
    for state in (PLAIN, replace(PLAIN, proportional=proportional)):
        assert status_text(state, shout) == status_text(state).upper()


def test_an_unknown_status_is_shown_as_it_is() -> None:
    assert result_text("unheard of") == "unheard of"
    assert result_text("unchanged") == ""
