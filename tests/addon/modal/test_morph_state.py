# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape key drags: pointer, precision, typed values, several keys, limits."""

import pytest

from stiv_addon.modal.event import Event
from stiv_addon.modal.morph_state import KeyRange, MorphState, step
from stiv_addon.modal.state import Effect

KEYS = (KeyRange("Wide", 0.0, 1.0, 0.25), KeyRange("Tall", -2.0, 2.0, 0.0))
BEGIN = MorphState.at(KEYS, 0, (100.0, 50.0), 200.0)


def after(state: MorphState, *events: Event) -> MorphState:
    for event in events:
        state, _ = step(state, event)
    return state


def move(x: float, *modifiers: str) -> Event:
    return Event("MOUSEMOVE", "NOTHING", (x, 50.0), frozenset(modifiers))


def test_the_pointer_drags_a_key_through_its_range() -> None:
    assert BEGIN.goals == {"Wide": 0.25}
    assert after(BEGIN, move(200.0)).goals["Wide"] == pytest.approx(0.75)
    assert after(BEGIN, move(900.0)).goals["Wide"] == 1.0
    assert after(BEGIN, move(-900.0)).goals["Wide"] == 0.0
    assert after(BEGIN, move(200.0, "shift")).goals["Wide"] == pytest.approx(0.3)


def test_typed_values_replace_the_pointer_and_backspace_returns_to_it() -> None:
    typed = after(BEGIN, move(200.0), Event("ZERO"), Event("PERIOD"), Event("FOUR"))
    assert typed.goals["Wide"] == 0.4 and typed.text({}) == "Wide: [0.4|] = 0.4000"
    assert after(typed, move(120.0)).goals["Wide"] == 0.4
    assert after(typed, *[Event("BACK_SPACE")] * 3).goals["Wide"] == pytest.approx(0.75)
    assert after(BEGIN, Event("ZERO"), Event("SLASH")).error


def test_several_keys_in_turn_keep_their_goals() -> None:
    state = after(BEGIN, move(200.0), Event("DOWN_ARROW"), move(250.0))
    assert state.goals == pytest.approx({"Wide": 0.75, "Tall": 1.0})
    back = after(state, Event("UP_ARROW"), move(230.0))
    assert back.goals == pytest.approx({"Wide": 0.65, "Tall": 1.0})
    assert after(state, Event("MINUS"), Event("ONE")).goals["Tall"] == -1.0


@pytest.mark.parametrize(
    ("event", "effect"),
    [
        (Event("RET"), Effect.CONFIRM),
        (Event("LEFTMOUSE"), Effect.CONFIRM),
        (Event("ESC"), Effect.CANCEL),
        (Event("RIGHTMOUSE"), Effect.CANCEL),
        (Event("MIDDLEMOUSE", modifiers=frozenset({"alt"})), Effect.PASS),
        (Event("W"), Effect.UPDATE),
        (Event("K"), Effect.NONE),
    ],
)
def test_keys(event: Event, effect: Effect) -> None:
    state, found = step(BEGIN, event)
    assert found is effect and state.others_yield == (event.type == "W")
