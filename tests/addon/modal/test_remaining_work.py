# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves that repeat, settle and compare a drag while the mouse rests and after the confirmation."""

import pytest
from fake_edit import FakeEdit
from scripted_drag import follow, move_to, new_drag, pause

from stiv_addon.modal import drag_loop
from stiv_addon.modal.drag_end import Progress
from stiv_addon.modal.event import Event
from stiv_addon.modal.repeated_solves import MAX_FRUITLESS, MAX_IDLE, MAX_SLOW


@pytest.fixture
def rest(monkeypatch: pytest.MonkeyPatch) -> None:
    """A mouse that does not move rests at once."""
    monkeypatch.setattr(drag_loop, "REST_TIME", 0.0)


def test_a_goal_not_reached_at_the_confirmation_is_solved_for_repeatedly() -> None:
    edit = FakeEdit(statuses=["budget", "budget", "corrected"], furthest=0.2)
    drag = new_drag(edit)
    drag.handle(move_to(50))
    drag.handle(Event("LEFTMOUSE"))
    assert drag.progress is Progress.FINISHED and edit.calls == [*["drag"] * 4, "write"]


def test_a_goal_that_solves_come_no_closer_to_is_left_until_the_confirmation() -> None:
    edit = FakeEdit(statuses=["budget"] * (1 + MAX_SLOW) + ["reached"])
    drag = new_drag(edit)
    drag.handle(move_to(50))
    for _ in range(20):
        drag.tick()
    pause(drag)
    assert edit.calls.count("drag") == 1 + MAX_SLOW
    drag.handle(Event("LEFTMOUSE"))
    assert drag.progress is Progress.FINISHED and drag.result.status == "reached"


@pytest.mark.parametrize("idle", [0, MAX_IDLE // 2])
def test_settling_that_uses_up_its_budget_is_continued_until_it_has_settled(idle: int) -> None:
    statuses = ["blocked", *["budget"] * (idle + 6), "blocked"]
    edit = FakeEdit(statuses=statuses, furthest=0.0, delays={"settle": 1}, settling=True)
    drag = new_drag(edit)
    drag.handle(move_to(90))
    drag.handle(Event("LEFTMOUSE"))
    while edit.calls.count("settle") < idle:
        assert drag.tick() is Progress.FINISHING
    edit.furthest = 0.1
    while drag.progress is Progress.FINISHING:
        drag.tick()
    assert drag.progress is Progress.FINISHED and drag.result.status == "blocked"
    assert edit.shown == edit.accepted > 0.4


def test_settling_that_gains_no_more_ends_as_deflected() -> None:
    edit = FakeEdit(statuses=["blocked"] + ["budget"] * 1000, settling=True)
    drag = new_drag(edit)
    drag.handle(move_to(500))
    drag.handle(Event("LEFTMOUSE"))
    while drag.progress is Progress.FINISHING:
        drag.tick()
    assert drag.result.status == "corrected" and edit.shown == edit.accepted == 1.0
    assert edit.calls.count("settle") == 1


def test_a_state_after_the_confirmation_is_compared_with_that_before(rest: None) -> None:
    edit = FakeEdit(statuses=["budget"] * 1000)
    drag = new_drag(edit)
    drag.handle(move_to(500))
    drag.tick()
    drag.handle(Event("LEFTMOUSE"))
    assert drag.progress is Progress.FINISHED and edit.calls.count("drag") == 2


def test_settling_that_accepts_nothing_ends(rest: None) -> None:
    edit = FakeEdit(statuses=["blocked"] + ["budget"] * 1000, settling=True, furthest=0.0)
    drag = new_drag(edit)
    drag.handle(move_to(500))
    drag.handle(Event("LEFTMOUSE"))
    while drag.progress is Progress.FINISHING:
        drag.tick()
    assert drag.result.status == "blocked" and edit.calls.count("settle") == MAX_IDLE


@pytest.mark.parametrize("confirmed", [True, False])
def test_an_accepted_state_that_gains_nothing_settles_a_drag_at_rest(confirmed: bool, rest: None) -> None:
    """Cages pressed at a wall took seconds for a thousandth of their energy."""
    edit = FakeEdit(statuses=["budget"] * 1000, settling=True)
    drag = new_drag(edit)
    drag.handle(move_to(500))
    drag.handle(Event("LEFTMOUSE")) if confirmed else None
    for _ in range(50):
        drag.tick()
    assert edit.calls.count("drag") == 2 and "settle" not in edit.calls
    assert drag.result.status == "corrected" and drag.at_rest
    drag.handle(Event("LEFTMOUSE"))
    assert drag.progress is Progress.FINISHED and edit.calls.count("drag") == 2


def test_esc_stops_settling_and_keeps_the_accepted_state() -> None:
    edit = FakeEdit(statuses=["blocked"] + ["budget"] * 1000, furthest=0.001, delays={"settle": 2}, settling=True)
    drag = new_drag(edit)
    drag.handle(move_to(90))
    drag.handle(Event("LEFTMOUSE"))
    while edit.accepted < 0.1:
        assert drag.tick() is Progress.FINISHING
    drag.handle(Event("ESC"))
    drag.tick()
    assert drag.progress is Progress.FINISHED and drag.stopped and 0.1 <= edit.shown == edit.accepted < 0.2


def test_a_drag_settles_while_the_mouse_rests_so_that_confirming_solves_nothing(rest: None) -> None:
    edit = FakeEdit(statuses=["corrected", "corrected", "budget", *["corrected"] * 4], furthest=0.3, settling=True)
    drag = new_drag(edit)
    drag.handle(move_to(500))
    for _ in range(10):
        drag.tick()
    assert drag.at_rest and edit.shown == edit.accepted == 1.0
    before = list(edit.calls)
    drag.handle(Event("LEFTMOUSE"))
    assert drag.progress is Progress.FINISHED and edit.calls == before


def test_a_motion_cancels_what_a_resting_drag_solves(rest: None) -> None:
    edit = FakeEdit(statuses=["blocked"], delays={"settle": 1000}, settling=True)
    drag = new_drag(edit)
    drag.handle(move_to(50))
    drag.tick()
    assert drag.tick() is Progress.RUNNING and edit.busy
    drag.handle(move_to(70))
    drag.tick()
    drag.tick()
    assert edit.goals == [0.5, 0.7] and edit.shown == 0.7


@pytest.mark.parametrize("rests", [True, False])
def test_a_settled_drag_is_confirmed_once(rests: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Solves within budgets never compare a drag with the edit from its start."""
    monkeypatch.setattr(drag_loop, "REST_TIME", 0.0 if rests else 1e9)
    edit = FakeEdit(statuses=["blocked"], furthest=0.3, from_start=0.8)
    drag = new_drag(edit)
    drag.handle(move_to(90))
    for _ in range(5):
        drag.tick()
    pause(drag)
    assert edit.shown == pytest.approx(0.8 if rests else 0.3)
    drag.handle(Event("LEFTMOUSE"))
    assert drag.progress is Progress.FINISHED and drag.result.status == "corrected"
    assert edit.shown == 0.8 and edit.calls.count("settle") == edit.calls.count("confirm") == 1


def test_esc_ends_a_confirming_solve_and_keeps_the_settled_state() -> None:
    edit = FakeEdit(statuses=["blocked"], furthest=0.3, from_start=0.8, delays={"confirm": 1000})
    drag = new_drag(edit)
    drag.handle(move_to(90))
    drag.handle(Event("LEFTMOUSE"))
    for _ in range(3):
        assert drag.tick() is Progress.FINISHING
    drag.handle(Event("ESC"))
    drag.tick()
    assert drag.progress is Progress.FINISHED and drag.stopped and edit.shown == edit.accepted == 0.3


@pytest.mark.parametrize("rests", [True, False])
def test_a_slow_comparison_with_the_edit_from_the_start_ends_soon_after_the_confirmation(
    rests: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While the mouse rests, nobody waits for it."""
    monkeypatch.setattr(drag_loop, "COMPARING_TIME", 0.0)
    monkeypatch.setattr(drag_loop, "REST_TIME", 0.0 if rests else 1e9)
    edit = FakeEdit(statuses=["blocked"], furthest=0.3, from_start=0.8, delays={"confirm": 1000})
    drag = new_drag(edit)
    drag.handle(move_to(90))
    for _ in range(5):
        assert drag.tick() is Progress.RUNNING
    assert not edit.cancelled
    drag.handle(Event("LEFTMOUSE"))
    for _ in range(3):
        drag.tick()
    assert drag.progress is Progress.FINISHED and not drag.stopped and edit.shown == edit.accepted == 0.3


@pytest.mark.parametrize("touching", [True, False])
def test_solves_that_meet_obstacles_end_some_time_after_the_confirmation(
    touching: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A motion that meets none goes to its goal."""
    monkeypatch.setattr(drag_loop, "FINISHING_TIME", -1.0)
    monkeypatch.setattr(drag_loop, "REST_TIME", 1e9)
    edit = FakeEdit(statuses=["budget"] * 8, furthest=0.1, from_start=0.9, touching=touching)
    drag = new_drag(edit)
    drag.handle(move_to(90))
    drag.tick()
    solves = len(edit.goals)
    drag.handle(Event("LEFTMOUSE"))
    for _ in range(10):
        drag.tick()
    assert drag.progress is Progress.FINISHED and not drag.stopped
    assert (len(edit.goals) <= solves + 1) == touching  # the first one may have been taken before or after
    assert edit.shown == pytest.approx(0.1 * len(edit.goals) if touching else 0.9)
    assert "confirm" not in edit.calls  # one reaches its goal, the other is too late
    assert drag.result.status == ("corrected" if touching else "reached")


def test_a_solve_that_runs_at_the_confirmation_does_not_continue_its_goal(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its goal would be solved for until it was given up, a minute later: another one stays pending."""
    monkeypatch.setattr(drag_loop, "FINISHING_TIME", -1.0)
    edit = FakeEdit(statuses=["budget"] * 100, furthest=0.0, touching=True, delays={"drag": 3})
    drag = new_drag(edit)
    follow(drag, 50)
    drag.handle(move_to(90))
    drag.handle(Event("LEFTMOUSE"))
    assert drag.progress is Progress.FINISHING
    while drag.progress is Progress.FINISHING:
        drag.tick()
    assert edit.goals == [0.5, 0.9]


def test_a_drag_without_a_rest_settles_only_at_the_confirmation() -> None:
    edit = FakeEdit(settling=True)
    drag = new_drag(edit)
    drag.handle(move_to(50))
    for _ in range(5):
        drag.tick()
    assert "settle" not in edit.calls


def test_an_endless_solve_can_be_confirmed() -> None:
    edit = FakeEdit(statuses=["budget"] * 1000, furthest=0.0)
    drag = new_drag(edit)
    drag.handle(move_to(50))
    drag.handle(Event("LEFTMOUSE"))
    while drag.progress is Progress.FINISHING:
        drag.tick()
    assert drag.progress is Progress.FINISHED and edit.calls.count("drag") == MAX_FRUITLESS + 1


def test_a_far_goal_is_solved_for_repeatedly_while_the_mouse_rests() -> None:
    edit = FakeEdit(statuses=["corrected"] * 30, furthest=0.3)
    drag = new_drag(edit)
    drag.handle(move_to(500))  # far beyond the wall at 1
    for _ in range(20):
        drag.tick()
    assert edit.shown == 1.0
    assert edit.goals == [5.0] * 5  # the last one gained nothing


def test_a_reached_or_blocked_goal_is_not_solved_for_again() -> None:
    for status in ("reached", "blocked", "cancelled"):
        edit = FakeEdit(statuses=[status])
        drag = new_drag(edit)
        drag.handle(move_to(500))
        for _ in range(5):
            drag.tick()
        assert edit.goals == [5.0]
