# SPDX-License-Identifier: GPL-3.0-or-later
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiv_addon.modal.axis_lock import AxisLock
from stiv_addon.modal.event import Event
from stiv_addon.modal.event_handling import CANCEL_KEYS, CONFIRM_KEYS, step
from stiv_addon.modal.pointer import Pointer
from stiv_addon.modal.proportional import Proportional
from stiv_addon.modal.request import RESPONSES, Request
from stiv_addon.modal.state import Effect, Phase, State

SHIFT, ALT = frozenset({"shift"}), frozenset({"alt"})
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


def test_the_release_of_a_button_held_from_the_start_confirms() -> None:
    held = replace(start(), release="LEFTMOUSE")
    moved, _ = step(held, Event("MOUSEMOVE", "NOTHING", (150.0, 100.0)))
    assert step(moved, Event("RIGHTMOUSE", "RELEASE")) == (moved, Effect.NONE)
    state, effect = step(moved, Event("LEFTMOUSE", "RELEASE"))
    assert (state.phase, effect) == (Phase.CONFIRMED, Effect.CONFIRM)
    assert state.pointer.last == (150.0, 100.0)


@pytest.mark.parametrize(("key", "axis"), [("X", 0), ("Y", 1), ("Z", 2)])
def test_axis_keys_lock(key: str, axis: int) -> None:
    state, effect = step(start(), Event(key))
    assert (state.axis_lock, effect) == (AxisLock(axis), Effect.UPDATE)
    assert after(Event(key, modifiers=SHIFT)).axis_lock == AxisLock(axis, plane=True)
    assert after(Event(key), Event(key)).axis_lock == AxisLock(axis, second=True)
    assert after(Event(key), Event(key), Event(key)).axis_lock == AxisLock()
    assert step(start(), Event(key, modifiers=frozenset({"ctrl"}))) == (start(), Effect.NONE)


def test_a_motion_asks_for_an_update_with_the_latest_place() -> None:
    state, effect = step(start(), Event("MOUSEMOVE", "NOTHING", (130.0, 90.0)))
    assert (state.pointer.effective, effect) == ((130.0, 90.0), Effect.UPDATE)


def test_a_typed_number_overrides_motions_until_it_is_deleted() -> None:
    typed = after(Event("TWO"), Event("MINUS"), Event("PERIOD"), Event("FIVE"))
    assert typed.typed.value(0, float) == -2.5
    moved, effect = step(typed, Event("MOUSEMOVE", "NOTHING", (500.0, 0.0)))
    assert (moved.typed.value(0, float), effect) == (-2.5, Effect.NONE)
    for _ in range(4):
        moved, effect = step(moved, Event("BACK_SPACE"))
    assert effect is Effect.UPDATE
    assert not moved.typed.active and moved.pointer.effective == (500.0, 0.0)


def test_shift_makes_motions_precise_while_held() -> None:
    assert after(Event("LEFT_SHIFT", modifiers=SHIFT)).precise
    assert not after(Event("LEFT_SHIFT", modifiers=SHIFT), Event("LEFT_SHIFT", "RELEASE")).precise
    state = after(Event("MOUSEMOVE", "NOTHING", (200.0, 100.0), SHIFT))
    assert state.pointer.effective == pytest.approx((110.0, 100.0))


@pytest.mark.parametrize("key", ["A", "F5", "WINDOW_DEACTIVATE", "TIMER", "NONE", "PAGE_UP", "O", "LEFT_ALT"])
def test_other_events_change_nothing(key: str) -> None:
    assert step(start(), Event(key)) == (start(), Effect.NONE)


@pytest.mark.parametrize(("key", "kind"), [("G", "move"), ("R", "rotate"), ("S", "scale")])
def test_another_kind_keeps_lock_number_and_pointer(key: str, kind: str) -> None:
    before = after(Event("MOUSEMOVE", "NOTHING", (130.0, 90.0)), Event("X"), Event("TWO"))
    for other in {"move", "rotate", "scale"} - {kind}:
        state, _ = step(replace(before, request=Request(other)), Event(key))
        assert state == replace(before, request=Request(kind))


def test_numbers_without_a_component_are_dropped() -> None:
    typed = after(Event("ONE"), Event("TAB"), Event("TWO"), Event("TAB"), Event("THREE"))
    assert [typed.typed.value(i, float) for i in range(3)] == [1, 2, 3]
    plane, _ = step(typed, Event("X", modifiers=SHIFT))
    assert [plane.typed.value(i, float) for i in range(3)] == [1, 2, None]
    turned, _ = step(typed, Event("R"))
    assert [turned.typed.value(i, float) for i in range(3)] == [1, None, None] and turned.typed.index == 0


@pytest.mark.parametrize("key", ["G", "R", "S", "X", "I", "W", "O", "SPACE", "SLASH"])
def test_in_an_expression_keys_are_characters(key: str) -> None:
    before = after(Event("ONE"), Event("EQUAL", text="="))
    state, effect = step(before, Event(key))
    assert effect is Effect.UPDATE
    assert state == replace(before, typed=state.typed) and len(state.typed.numbers[0].digits) == 2


@pytest.mark.parametrize("key", ["RET", "ESC", "LEFTMOUSE", "RIGHTMOUSE"])
def test_an_expression_can_be_confirmed_and_cancelled(key: str) -> None:
    assert step(after(Event("EQUAL", text="=")), Event(key))[0].phase is not Phase.DRAGGING


@pytest.mark.parametrize("key", ["MOUSEROTATE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "NDOF_MOTION", "TRACKPADPAN"])
@pytest.mark.parametrize("value", ["PRESS", "RELEASE", "NOTHING"])
def test_the_view_is_left_to_blender(key: str, value: str) -> None:
    assert step(start(), Event(key, value)) == (start(), Effect.PASS)


def test_the_wheel_changes_the_size_of_proportional_editing() -> None:
    before = replace(start(), proportional=Proportional(True, True, 2.0))
    larger, effect = step(before, Event("WHEELDOWNMOUSE"))
    assert effect is Effect.UPDATE and larger.proportional.size > 2.0
    assert step(before, Event("PAGE_DOWN"))[0].proportional.size < 2.0
    assert step(before, Event("WHEELDOWNMOUSE", modifiers=SHIFT))[0].proportional.size == pytest.approx(2.02)
    assert step(before, Event("NUMPAD_PLUS", modifiers=ALT))[0].proportional.size == larger.proportional.size
    assert step(before, Event("TRACKPADPAN", "NOTHING", pan=-10.0))[0].proportional.size == pytest.approx(1.9)
    assert step(before, Event("C", modifiers=ALT))[0].proportional.connected
    assert step(before, Event("WHEELDOWNMOUSE", modifiers=ALT)) == (before, Effect.NAVIGATE)
    assert not step(before, Event("O"))[0].proportional.on
    assert step(before, Event("O", modifiers=SHIFT))[0].proportional.falloff == "SPHERE"
    assert step(start(), Event("O")) == (start(), Effect.NONE)


def test_ctrl_and_shift_tab_invert_snapping() -> None:
    held, effect = step(start(), Event("LEFT_CTRL", modifiers=frozenset({"ctrl"})))
    assert held.snapping and effect is Effect.UPDATE
    assert step(held, Event("LEFT_CTRL", "RELEASE")) == (start(), Effect.UPDATE)
    assert step(held, Event("MOUSEMOVE", "NOTHING", (100.0, 100.0)))[0].snapping is False
    switched, effect = step(start(), Event("TAB", modifiers=SHIFT))
    assert switched.snapping and effect is Effect.UPDATE
    assert step(switched, Event("LEFT_SHIFT"))[1] is Effect.UPDATE  # finer steps
    assert step(start(), Event("LEFT_SHIFT"))[1] is Effect.NONE


def test_with_alt_the_middle_button_and_the_wheel_navigate() -> None:
    for key in ("MIDDLEMOUSE", "WHEELUPMOUSE"):
        assert step(start(), Event(key, modifiers=ALT)) == (start(), Effect.NAVIGATE)
    assert step(start(), Event("MIDDLEMOUSE", "RELEASE", modifiers=ALT)) == (start(), Effect.PASS)


@pytest.mark.parametrize(("modifiers", "plane"), [(frozenset(), False), (SHIFT, True)])
def test_the_middle_button_picks_the_axis_that_the_pointer_follows(modifiers: frozenset, plane: bool) -> None:
    held, effect = step(start(), Event("MIDDLEMOUSE", modifiers=modifiers, axis=0))
    assert (held.axis_lock, effect) == (AxisLock(0, plane), Effect.UPDATE)
    held, _ = step(held, Event("MOUSEMOVE", "NOTHING", axis=2))
    assert held.axis_lock == AxisLock(2, plane)
    released, _ = step(held, Event("MIDDLEMOUSE", "RELEASE"))
    assert step(released, Event("MOUSEMOVE", "NOTHING", axis=1))[0].axis_lock == AxisLock(2, plane)
    again, _ = step(released, Event("MIDDLEMOUSE", modifiers=modifiers, axis=1))
    assert again.axis_lock == AxisLock() and step(again, Event("MIDDLEMOUSE", "RELEASE"))[0].axis_lock == AxisLock()
    assert step(again, Event("X"))[0].axis_lock == AxisLock(0)
    assert step(released, Event("C"))[0].axis_lock == AxisLock()


def test_r_in_a_rotation_switches_the_trackball() -> None:
    ball = after(Event("R"), Event("R"))
    assert ball.trackball and ball.components == 2
    assert not step(ball, Event("R"))[0].trackball
    assert not step(ball, Event("G"))[0].trackball


def test_snap_points_are_added_and_removed() -> None:
    assert step(start(), Event("A")) == (start(), Effect.NONE)
    first, effect = step(start(), Event("A", target=(1.0, 0.0, 0.0)))
    both, _ = step(first, Event("A", target=(0.0, 2.0, 0.0)))
    assert both.snap_points == ((1.0, 0.0, 0.0), (0.0, 2.0, 0.0)) and effect is Effect.UPDATE
    assert step(both, Event("A", modifiers=ALT))[0] == first


@pytest.mark.parametrize("key", sorted(CONFIRM_KEYS | {"B"}))
def test_the_snap_base_is_picked_before_the_drag_continues(key: str) -> None:
    picking = after(Event("MOUSEMOVE", "NOTHING", (130.0, 90.0)), Event("B"))
    assert picking.picking_base and picking.snapping
    assert step(picking, Event(key)) == (picking, Effect.NONE)  # nothing under the pointer
    assert step(picking, Event("X")) == (picking, Effect.NONE)
    marked, _ = step(picking, Event("A", target=(2.0, 0.0, 0.0)))
    picked, effect = step(marked, Event(key, target=(0.0, 4.0, 0.0)))
    assert (picked.base, picked.picking_base, picked.snap_points, effect) == ((1.0, 2.0, 0.0), False, (), Effect.UPDATE)
    assert picked.pointer.start == picked.pointer.effective == (130.0, 90.0) and picked.phase is Phase.DRAGGING
    assert step(picked, Event("LEFTMOUSE"))[1] is Effect.CONFIRM
    assert step(picking, Event("ESC"))[1] is Effect.CANCEL


def test_keys_change_the_responders_and_collisions() -> None:
    assert after(Event("I")).request == Request(interference=False)
    assert after(Event("I"), Event("I")).request == Request()
    assert [after(*[Event("T")] * times).request.response for times in range(4)] == [*RESPONSES, RESPONSES[0]]
    found = [after(*[Event("W")] * times).request.responders for times in range(4)]
    assert sorted(set(found)) == ["all", "selected", "unselected"] and found[3] == found[0]


POINTER_KEYS = ["MOUSEMOVE", "INBETWEEN_MOUSEMOVE", "MIDDLEMOUSE", "TIMER"]
OTHER_KEYS = ["A", *"GRSIWO", "TAB", "LEFT_SHIFT", "RIGHT_CTRL", "PAGE_UP", "WHEELUPMOUSE", "EQUAL"]
NUMBER_KEYS = ["ZERO", "NUMPAD_3", "PERIOD", "COMMA", "MINUS", "SLASH", "NUMPAD_ASTERIX", "BACK_SPACE"]
KEYS = st.sampled_from([*"XYZ", *POINTER_KEYS, *OTHER_KEYS, *NUMBER_KEYS, *sorted(CONFIRM_KEYS | CANCEL_KEYS)])
EVENTS = st.builds(
    Event,
    type=KEYS,
    value=st.sampled_from(["PRESS", "RELEASE", "NOTHING", "CLICK"]),
    mouse=st.tuples(st.floats(-1e4, 1e4), st.floats(-1e4, 1e4)),
    modifiers=st.sets(st.sampled_from(["shift", "ctrl", "alt", "oskey"])).map(frozenset),
    text=st.text(max_size=2),
)


# Space is left out as the last key: within an expression it is typed, and does not confirm.
@given(st.lists(EVENTS, max_size=40), st.sampled_from(sorted((CONFIRM_KEYS | CANCEL_KEYS) - {"SPACE"})))
def test_every_sequence_ends_once_and_stays_ended(events: list[Event], last: str) -> None:
    state, endings = start(), []
    for event in [*events, Event(last), *events]:
        was_final = state.phase is not Phase.DRAGGING
        following, effect = step(state, event)
        assert not was_final or (following == state and effect in (Effect.NONE, Effect.STOP))
        if effect in ENDS:
            endings.append(effect)
            assert following.phase is ENDS[effect]
        state = following
    assert len(endings) == 1
