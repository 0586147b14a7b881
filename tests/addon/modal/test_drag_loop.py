# SPDX-License-Identifier: GPL-3.0-or-later
import time
from types import SimpleNamespace

import pytest
from fake_edit import FakeEdit
from hypothesis import given
from hypothesis import strategies as st
from scripted_drag import follow, move_to, new_drag, pause
from test_event_handling import EVENTS

from stiv_addon.modal import drag_loop, solve_budget
from stiv_addon.modal.current_task import CurrentTask
from stiv_addon.modal.drag_end import Progress
from stiv_addon.modal.event import Event
from stiv_addon.modal.pointer import Pointer
from stiv_addon.modal.repeated_solves import MAX_FRUITLESS, MAX_HIDDEN
from stiv_addon.modal.request import Request
from stiv_addon.modal.state import Effect


def test_motions_are_solved_for_the_latest_only() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    for x in range(100):
        drag.handle(move_to(x))
    drag.tick()
    drag.tick()
    assert edit.goals == [0.99]
    assert edit.calls == ["drag", "write"]


@pytest.mark.parametrize(("status", "settles"), [("reached", []), ("blocked", ["settle", "confirm"])])
def test_confirming_solves_for_the_last_goal_settles_and_writes(status: str, settles: list[str]) -> None:
    """Of a large object, even finding nothing to settle takes longer than a frame."""
    edit = FakeEdit(statuses=[status])
    drag = new_drag(edit)
    drag.handle(move_to(30))
    assert drag.handle(Event("LEFTMOUSE")) is Effect.CONFIRM and drag.progress is Progress.FINISHED
    assert edit.calls == ["drag", *settles, "write"]
    assert edit.shown == drag.transform == 0.3


def test_confirming_without_a_motion_changes_nothing() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    drag.handle(Event("RET"))
    assert drag.progress is Progress.FINISHED and edit.calls == [] and drag.transform is None


def test_a_typed_value_is_applied_from_the_start() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    drag.handle(move_to(70))
    drag.tick()
    drag.handle(Event("TWO"))
    drag.tick()
    edit.calls.clear()
    drag.handle(Event("RET"))
    assert drag.progress is Progress.FINISHED
    assert edit.calls == ["restore", "apply", "apply", "write"]
    assert (drag.transform, edit.shown) == (2.0, 1.0)


def test_esc_stops_a_long_typed_value_and_keeps_the_part_that_is_safe() -> None:
    edit = FakeEdit(delays={"apply": 3})
    drag = new_drag(edit)
    drag.handle(Event("ONE"))
    drag.handle(Event("RET"))
    for _ in range(20):
        drag.tick() if not edit.accepted else None
    assert drag.progress is Progress.FINISHING and 0.0 < drag.fraction <= 1.0
    assert drag.handle(Event("ESC")) is Effect.STOP
    while drag.progress is Progress.FINISHING:
        drag.tick()
    assert drag.progress is Progress.FINISHED and drag.error is None
    assert edit.calls.count("apply") == 1 and edit.shown == edit.accepted == 0.5


def test_events_during_a_long_start_count_once_it_is_over() -> None:
    edit = FakeEdit(delays={"begin": 5})
    drag = new_drag(edit)
    assert drag.progress is Progress.STARTING
    drag.handle(move_to(40))
    drag.handle(Event("LEFTMOUSE"))
    assert drag.progress is Progress.STARTING and edit.calls == []
    for _ in range(10):
        drag.tick()
    assert drag.progress is Progress.FINISHED and edit.shown == 0.4


@pytest.mark.parametrize("events", [["ESC"], ["LEFTMOUSE", "ESC"], ["TWO", "ESC"]])
def test_esc_ends_a_long_start_with_nothing_called(events: list[str]) -> None:
    edit = FakeEdit(delays={"begin": 5})
    drag = new_drag(edit)
    for kind in events:
        drag.handle(Event(kind))
    drag.tick()
    assert drag.progress.ended and edit.calls == [] and drag.transform is None and drag.error is None


def test_esc_stops_the_solve_after_the_confirmation_and_keeps_the_accepted_state() -> None:
    edit = FakeEdit(statuses=["budget"] * 1000, furthest=0.01, delays={"drag": 2})
    drag = new_drag(edit)
    drag.handle(move_to(90))
    drag.handle(Event("LEFTMOUSE"))
    while drag.progress is Progress.FINISHING and edit.accepted < 0.3:
        assert drag.tick() is Progress.FINISHING
    drag.handle(Event("ESC"))
    drag.tick()
    assert drag.progress is Progress.FINISHED and drag.stopped
    assert 0.3 <= edit.shown == edit.accepted < 0.4 and edit.calls.count("settle") == 0


def test_a_solve_longer_than_a_frame_leaves_the_events_free() -> None:
    edit = FakeEdit(delays={"drag": 3})
    drag = new_drag(edit)
    drag.handle(move_to(20))
    drag.tick()
    drag.handle(move_to(30))
    assert edit.calls == [] and drag.progress is Progress.RUNNING
    for _ in range(12):
        drag.tick()
    pause(drag)
    assert edit.goals == [0.2, 0.3]
    drag.handle(move_to(50))
    drag.tick()
    drag.handle(Event("ESC"))
    assert drag.progress is Progress.CANCELLED and edit.shown == 0.0


def test_solves_hand_over_early_only_until_the_mouse_rests(monkeypatch: pytest.MonkeyPatch) -> None:
    """Short solves gain too little each, and would seem to have settled."""
    edit = FakeEdit(statuses=["budget"] * 3)
    drag = new_drag(edit)
    follow(drag, 50)
    monkeypatch.setattr(drag_loop, "REST_TIME", 0.0)
    drag.tick()
    drag.handle(Event("LEFTMOUSE"))
    first, *later = edit.hand_overs
    assert first == solve_budget.HAND_OVER and later and set(later) == {None}


@pytest.mark.parametrize("key", ["ESC", "RIGHTMOUSE"])
def test_cancel_restores(key: str) -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    drag.handle(move_to(70))
    drag.tick()
    drag.handle(Event(key))
    assert drag.progress is Progress.CANCELLED
    assert edit.calls[-1] == "restore"
    assert edit.shown == 0.0 and drag.error is None


def test_a_used_up_budget_is_continued_at_the_next_tick() -> None:
    edit = FakeEdit(statuses=["budget", "corrected"])
    drag = new_drag(edit)
    drag.handle(move_to(50))
    for _ in range(4):
        drag.tick()
    assert edit.calls == ["drag", "write", "drag", "write"]


def test_a_budget_used_up_before_the_first_accepted_state_writes_nothing() -> None:
    edit = FakeEdit(statuses=["budget"], furthest=0.0)
    drag = new_drag(edit)
    drag.handle(move_to(50))
    drag.tick()
    assert edit.calls == ["drag"] and drag.result.status == "budget" and drag.shows_soon
    edit.furthest = 1.0
    drag.tick()
    assert edit.calls == ["drag", "drag", "write"] and edit.shown == 0.5 and not drag.shows_soon


def test_a_long_solve_that_accepts_nothing_is_shown() -> None:
    edit = FakeEdit(statuses=["budget"] * 20, furthest=0.0)
    drag = new_drag(edit)
    drag.handle(move_to(50))
    for _ in range(MAX_HIDDEN):
        drag.tick()
        assert drag.shows_soon
    drag.tick()
    assert drag.result.status == "budget" and not drag.shows_soon


def test_a_goal_is_continued_until_a_state_is_accepted() -> None:
    edit = FakeEdit(statuses=["budget"] * 3, furthest=0.0)
    drag = new_drag(edit)
    for x in (50, 60, 70):
        drag.handle(move_to(x))
        drag.tick()
    assert edit.goals == [0.5] * 3
    edit.furthest = 1.0
    drag.tick()
    assert (edit.shown, drag.transform, drag.at_rest) == (0.5, 0.5, False)
    drag.tick()
    pause(drag)
    assert (edit.shown, drag.transform) == (0.7, 0.7)


def test_the_confirmation_ends_an_unfinished_goal() -> None:
    edit = FakeEdit(statuses=["budget"], furthest=0.0)
    drag = new_drag(edit)
    drag.handle(move_to(50))
    drag.tick()
    edit.furthest = 1.0
    drag.handle(move_to(70))
    drag.handle(Event("RET"))
    assert edit.goals == [0.5, 0.7] and edit.shown == drag.transform == 0.7


@pytest.mark.parametrize("key", ["I", "W", "R"])
def test_another_request_ends_an_unfinished_goal(key: str) -> None:
    edit = FakeEdit(statuses=["budget"], furthest=0.0)
    drag = new_drag(edit)
    drag.handle(move_to(50))
    drag.tick()
    drag.handle(move_to(70))
    drag.handle(Event(key))
    drag.tick()
    assert edit.goals == [0.5, 0.7]


def test_the_progress_after_the_confirmation_never_goes_back(monkeypatch: pytest.MonkeyPatch) -> None:
    """Several solves follow, each with a fraction of its own."""
    monkeypatch.setattr(drag_loop, "FINISHING_TIME", 0.1)
    drag = new_drag(FakeEdit(statuses=["budget"] * 8, furthest=0.1, delays={"drag": 4, "settle": 4}))
    drag.handle(move_to(90))
    drag.tick()
    drag.handle(Event("LEFTMOUSE"))
    seen = []
    while drag.progress is Progress.FINISHING:
        seen.append(drag.fraction)
        drag.tick()
    assert len(seen) > 4 and seen == sorted(seen) and seen[0] >= 0.0 and seen[-1] <= 1.0


@pytest.mark.parametrize("confirmed", [True, False])
def test_a_tick_after_the_confirmation_waits_as_long_as_blender_took_between_ticks(
    confirmed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A solve may need Blender's thread, which slow drawing would leave no time. Before, the mouse goes first."""
    drag = new_drag(FakeEdit(delays={"drag": 1000}))
    drag.handle(move_to(90))
    drag.tick()
    if confirmed:
        drag.handle(Event("LEFTMOUSE"))
    waits: list[float] = []
    now = time.perf_counter()
    monkeypatch.setattr(drag_loop, "time", SimpleNamespace(perf_counter=lambda: now))
    monkeypatch.setattr(CurrentTask, "advance", lambda task, seconds: waits.append(seconds))
    drag.tick()
    for between in (0.0, 0.06, 0.3):
        now += between
        drag.tick()
    expected = [drag_loop.FRAME, drag_loop.FRAME, 0.06, solve_budget.MAX_BUDGET] if confirmed else [drag_loop.FRAME] * 4
    assert waits == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("stops", [True, False])
def test_a_drag_that_accepts_nothing_writes_its_start(stops: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a report, its operator would solve again, and Blender would stand still."""
    monkeypatch.setattr(drag_loop, "FINISHING_TIME", 1e9 if stops else -1.0)
    edit = FakeEdit(statuses=["budget"] * 100, furthest=0.0, touching=True, delays={"drag": 2})
    drag = new_drag(edit)
    follow(drag, *[90] * 5)
    assert "write" not in edit.calls and drag.result is not None
    drag.handle(Event("LEFTMOUSE"))
    for event in [Event("ESC")] * stops:
        drag.handle(event)
    for _ in range(MAX_FRUITLESS):
        drag.tick()
    assert drag.progress is Progress.FINISHED and drag.stopped == stops
    assert edit.calls[-1] == "write" and edit.shown == 0.0 and drag.writer.written is drag.result


def test_a_solve_may_take_as_long_as_reading_or_as_writing_and_drawing_up_to_a_limit() -> None:
    """Of a large mesh, a shorter solve would draw a part of the way."""
    edit = FakeEdit(reading=0.06, writing=0.08)
    drag = new_drag(edit)
    for x in (10, 20):
        drag.handle(move_to(x))
        drag.tick()
    edit.writing = 0.2
    for x in (30, 40):
        drag.handle(move_to(x))
        drag.tick()
    first, second, _, last = edit.budgets
    assert solve_budget.BUDGET < 0.06 <= first and second >= 0.08 and last == solve_budget.MAX_BUDGET


def test_an_invalid_value_is_reported_and_can_be_corrected() -> None:
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
    edit = FakeEdit(statuses=["blocked"], failing={call: RuntimeError("broken")})
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
    assert drag.handle(Event("RET")) is Effect.NONE


def test_abort_restores_once() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    assert drag.abort(RuntimeError("mode changed")) is Progress.CANCELLED
    drag.abort(RuntimeError("again"))
    assert edit.calls == ["restore"]


def test_another_request_begins_again_from_the_start() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    drag.handle(move_to(70))
    drag.tick()
    drag.handle(Event("R"))
    drag.handle(Event("W"))
    drag.tick()
    assert edit.calls == ["drag", "write", "restore", "drag", "write"]
    assert edit.requests == [Request(), Request("rotate", "unselected")]


def test_a_rejected_request_is_reported_and_the_old_edit_continues() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    drag.handle(move_to(70))
    edit.failing["begin"] = ValueError("it cannot be turned")
    drag.handle(Event("R"))
    assert drag.tick() is Progress.RUNNING
    assert (drag.note, drag.state.kind, edit.shown) == ("it cannot be turned", "move", 0.7)


def test_a_rejection_of_objects_that_intersect_is_reported_in_short() -> None:
    """The header has no place for all of them, and would leave the note out."""
    error = ValueError("the start already intersects: 912 pairs of faces, " + 9 * "many names, ")
    error.short = "Box cuts Plane, 9 faces"
    edit = FakeEdit(failing={"again": error})
    drag = new_drag(edit)
    follow(drag, 30)
    drag.handle(Event("W"))
    pause(drag)
    assert drag.note == "Box cuts Plane, 9 faces"


def test_a_request_and_a_confirmation_at_once_end_in_the_new_kind() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    drag.handle(move_to(70))
    drag.handle(Event("S"))
    drag.handle(Event("LEFTMOUSE"))
    assert edit.requests[-1].kind == drag.state.kind == "scale" and edit.shown == 0.7


def test_a_rejection_at_the_confirmation_preserves_the_accepted_state() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    drag.handle(move_to(70))
    drag.tick()
    edit.failing["drag"] = ValueError("beyond the horizon")
    drag.handle(move_to(90))
    drag.handle(Event("LEFTMOUSE"))
    assert drag.progress is Progress.FINISHED and edit.shown == 0.7 and drag.transform == 0.7


@pytest.mark.parametrize("keys", [["EQUAL", "TWO", "NUMPAD_PLUS"], ["EQUAL", "A"]])
def test_an_invalid_number_cannot_be_confirmed(keys: list[str]) -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    for key in keys:
        drag.handle(Event(key))
    drag.tick()
    assert drag.note
    drag.handle(Event("RET"))
    assert drag.progress is Progress.RUNNING and drag.note
    drag.handle(Event("ESC"))
    assert drag.progress is Progress.CANCELLED and drag.error is None


def test_collisions_are_switched_within_the_edit() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    drag.handle(move_to(70))
    drag.handle(Event("I"))
    drag.tick()
    drag.tick()
    assert edit.calls == ["interference", "drag", "write"] and not edit.interference
    drag.handle(Event("I"))
    drag.tick()
    assert edit.interference and len(edit.requests) == 1


def test_a_changed_view_solves_for_the_pointer_in_it() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    drag.handle(move_to(30))
    drag.tick()
    drag.change_view(Pointer.at((60.0, 0.0)))
    drag.tick()
    assert edit.goals == [0.3, 0.6]


FAULTS = st.dictionaries(
    st.sampled_from(["drag", "settle", "write", "again"]), st.sampled_from([RuntimeError("broken"), ValueError("no")])
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
    if drag.progress is Progress.RUNNING:  # a number that is none cannot be confirmed
        drag.handle(Event("ESC"))
    assert drag.progress is not Progress.RUNNING
    assert edit.shown == (edit.accepted if drag.progress is Progress.FINISHED else 0.0)
    before = list(edit.calls)
    drag.handle(Event("MOUSEMOVE", "NOTHING", (7.0, 7.0)))
    drag.tick()
    assert edit.calls == before
