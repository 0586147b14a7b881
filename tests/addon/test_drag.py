# SPDX-License-Identifier: GPL-3.0-or-later
import pytest
from fake_edit import FakeEdit
from hypothesis import given
from hypothesis import strategies as st
from test_state import EVENTS

from stiv_addon.modal.drag import Drag, Progress
from stiv_addon.modal.events import Event
from stiv_addon.modal.pointer import Pointer
from stiv_addon.modal.state import State


def new_drag(edit: FakeEdit) -> Drag:
    """A drag whose goal is a hundredth of the pointer's x, or the typed number."""

    def measure(state: State) -> float:
        return (state.typed.value or 0.0) if state.typed.active else state.pointer.effective[0] / 100.0

    return Drag(edit, measure, lambda value: value, State(Pointer.at((0.0, 0.0))))


def move_to(x: float) -> Event:
    return Event("MOUSEMOVE", "NOTHING", (x, 0.0))


def test_motions_are_solved_for_the_latest_only() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    for x in range(100):
        drag.handle(move_to(x))
    drag.tick()
    drag.tick()
    assert edit.goals == [0.99]
    assert edit.calls == ["drag", "write"]


def test_confirm_solves_what_is_left_settles_and_writes() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    drag.handle(move_to(30))
    assert drag.handle(Event("LEFTMOUSE")) is Progress.FINISHED
    assert edit.calls == ["drag", "settle", "write"]
    assert edit.shown == drag.transform == 0.3


def test_confirm_without_a_motion_touches_nothing() -> None:
    edit = FakeEdit()
    assert new_drag(edit).handle(Event("RET")) is Progress.FINISHED
    assert edit.calls == []


def test_a_typed_value_restores_and_is_left_to_the_caller() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    drag.handle(move_to(70))
    drag.tick()
    drag.handle(Event("TWO"))
    drag.tick()
    assert drag.handle(Event("RET")) is Progress.VALUE_GIVEN
    assert edit.calls[-1] == "restore"
    assert (drag.transform, edit.shown) == (2.0, 0.0)


@pytest.mark.parametrize("key", ["ESC", "RIGHTMOUSE"])
def test_cancel_restores(key: str) -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    drag.handle(move_to(70))
    drag.tick()
    assert drag.handle(Event(key)) is Progress.CANCELLED
    assert edit.calls[-1] == "restore"
    assert edit.shown == 0.0 and drag.error is None


def test_a_used_up_budget_is_continued_at_the_next_tick() -> None:
    edit = FakeEdit(statuses=["budget", "corrected"])
    drag = new_drag(edit)
    drag.handle(move_to(50))
    for _ in range(4):
        drag.tick()
    assert edit.calls == ["drag", "write", "drag", "write"]


def test_a_refused_value_is_told_and_can_be_corrected() -> None:
    edit = FakeEdit(failing={"drag": ValueError("scale is zero")})
    drag = new_drag(edit)
    drag.handle(Event("ZERO"))
    assert drag.tick() is Progress.RUNNING
    assert drag.note == "scale is zero"
    edit.failing.clear()
    drag.handle(Event("FIVE"))
    drag.tick()
    assert (drag.note, edit.goals) == ("", [5.0])


@pytest.mark.parametrize("call", ["drag", "settle", "write"])
def test_an_exception_anywhere_restores_and_ends(call: str) -> None:
    edit = FakeEdit(failing={call: RuntimeError("broken")})
    drag = new_drag(edit)
    drag.handle(move_to(40))
    drag.tick()
    drag.handle(Event("RET"))
    assert drag.progress is Progress.CANCELLED
    assert edit.calls[-1] == "restore" and edit.shown == 0.0
    assert str(drag.error) == "broken"


def test_a_scene_that_is_gone_ends_too() -> None:
    edit = FakeEdit(failing={"drag": RuntimeError("gone"), "restore": RuntimeError("gone as well")})
    drag = new_drag(edit)
    drag.handle(move_to(40))
    assert drag.tick() is Progress.CANCELLED
    assert "gone as well" in drag.error.__notes__[0]
    assert drag.handle(Event("RET")) is Progress.CANCELLED


def test_abort_restores_once() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    assert drag.abort(RuntimeError("mode changed")) is Progress.CANCELLED
    drag.abort(RuntimeError("again"))
    assert edit.calls == ["restore"]


FAULTS = st.dictionaries(
    st.sampled_from(["drag", "settle", "write"]), st.sampled_from([RuntimeError("broken"), ValueError("no")])
)


@given(st.lists(EVENTS, max_size=40), st.lists(st.sampled_from(["budget", "blocked", "reached"])), FAULTS)
def test_every_sequence_ends_shown_as_accepted_or_restored(
    events: list[Event], statuses: list[str], failing: dict[str, Exception]
) -> None:
    edit = FakeEdit(statuses=list(statuses), failing=failing)
    drag = new_drag(edit)
    for number, event in enumerate([*events, Event("ESC")]):
        drag.handle(event)
        if number % 3 == 0:
            drag.tick()
    assert drag.progress is not Progress.RUNNING
    assert edit.shown == (edit.accepted if drag.progress is Progress.FINISHED else 0.0)
    before = list(edit.calls)
    drag.handle(Event("MOUSEMOVE", "NOTHING", (7.0, 7.0)))
    drag.tick()
    assert edit.calls == before
