# SPDX-License-Identifier: GPL-3.0-or-later
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiv_addon.modal.constraint import Constraint
from stiv_addon.modal.events import Event
from stiv_addon.modal.pointer import Pointer
from stiv_addon.modal.state import CANCEL_KEYS, CONFIRM_KEYS, Effect, Phase, State, step

SHIFT = frozenset({"shift"})
ENDS = {Effect.CONFIRM: Phase.CONFIRMED, Effect.CANCEL: Phase.CANCELLED}


def start() -> State:
    return State(Pointer.at((100.0, 100.0)))


def after(*events: Event) -> State:
    state = start()
    for event in events:
        state, _ = step(state, event)
    return state


@pytest.mark.parametrize("key", sorted(CONFIRM_KEYS | CANCEL_KEYS))
@pytest.mark.parametrize("modifiers", [frozenset(), SHIFT, frozenset({"ctrl", "alt"})])
def test_an_ending_key_ends_with_any_modifier(key: str, modifiers: frozenset[str]) -> None:
    state, effect = step(start(), Event(key, modifiers=modifiers))
    assert effect is (Effect.CONFIRM if key in CONFIRM_KEYS else Effect.CANCEL)
    assert state.phase is ENDS[effect]


@pytest.mark.parametrize("key", sorted(CONFIRM_KEYS | CANCEL_KEYS | {"X", "FIVE", "A"}))
def test_a_release_does_nothing(key: str) -> None:
    assert step(start(), Event(key, "RELEASE")) == (start(), Effect.NONE)


@pytest.mark.parametrize(("key", "axis"), [("X", 0), ("Y", 1), ("Z", 2)])
def test_axis_keys_lock(key: str, axis: int) -> None:
    state, effect = step(start(), Event(key))
    assert (state.constraint, effect) == (Constraint(axis), Effect.UPDATE)
    assert after(Event(key, modifiers=SHIFT)).constraint == Constraint(axis, plane=True)
    assert after(Event(key), Event(key)).constraint == Constraint()
    assert step(start(), Event(key, modifiers=frozenset({"ctrl"}))) == (start(), Effect.NONE)


def test_a_motion_asks_for_an_update_with_the_latest_place() -> None:
    state, effect = step(start(), Event("MOUSEMOVE", "NOTHING", (130.0, 90.0)))
    assert (state.pointer.effective, effect) == ((130.0, 90.0), Effect.UPDATE)


def test_a_typed_number_outlives_motions_and_gives_way_when_deleted() -> None:
    typed = after(Event("TWO"), Event("MINUS"), Event("PERIOD"), Event("FIVE"))
    assert typed.typed.value == -2.5
    moved, effect = step(typed, Event("MOUSEMOVE", "NOTHING", (500.0, 0.0)))
    assert (moved.typed.value, effect) == (-2.5, Effect.NONE)
    for _ in range(4):
        moved, effect = step(moved, Event("BACK_SPACE"))
    assert effect is Effect.UPDATE
    assert not moved.typed.active and moved.pointer.effective == (500.0, 0.0)


def test_shift_makes_motions_precise_while_held() -> None:
    assert after(Event("LEFT_SHIFT", modifiers=SHIFT)).precise
    assert not after(Event("LEFT_SHIFT", modifiers=SHIFT), Event("LEFT_SHIFT", "RELEASE")).precise
    state = after(Event("MOUSEMOVE", "NOTHING", (200.0, 100.0), SHIFT))
    assert state.pointer.effective == pytest.approx((110.0, 100.0))


@pytest.mark.parametrize("key", ["A", "G", "TAB", "F5", "WINDOW_DEACTIVATE", "TIMER", "WHEELUPMOUSE", "NONE"])
def test_other_events_change_nothing(key: str) -> None:
    assert step(start(), Event(key)) == (start(), Effect.NONE)


POINTER_KEYS = ["MOUSEMOVE", "INBETWEEN_MOUSEMOVE", "MIDDLEMOUSE", "TIMER"]
OTHER_KEYS = ["A", "G", "S", "TAB", "LEFT_SHIFT", "RIGHT_SHIFT"]
NUMBER_KEYS = ["ZERO", "NUMPAD_3", "PERIOD", "COMMA", "MINUS", "BACK_SPACE"]
KEYS = st.sampled_from([*"XYZ", *POINTER_KEYS, *OTHER_KEYS, *NUMBER_KEYS, *sorted(CONFIRM_KEYS | CANCEL_KEYS)])
EVENTS = st.builds(
    Event,
    type=KEYS,
    value=st.sampled_from(["PRESS", "RELEASE", "NOTHING", "CLICK"]),
    mouse=st.tuples(st.floats(-1e4, 1e4), st.floats(-1e4, 1e4)),
    modifiers=st.sets(st.sampled_from(["shift", "ctrl", "alt", "oskey"])).map(frozenset),
    text=st.text(max_size=2),
)


@given(st.lists(EVENTS, max_size=40), st.sampled_from(sorted(CONFIRM_KEYS | CANCEL_KEYS)))
def test_every_sequence_ends_once_and_stays_ended(events: list[Event], last: str) -> None:
    state, endings = start(), []
    for event in [*events, Event(last), *events]:
        was_final = state.phase is not Phase.DRAGGING
        following, effect = step(state, event)
        assert not was_final or (following, effect) == (state, Effect.NONE)
        if effect in ENDS:
            endings.append(effect)
            assert following.phase is ENDS[effect]
        state = following
    assert len(endings) == 1
