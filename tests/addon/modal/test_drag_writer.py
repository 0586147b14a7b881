# SPDX-License-Identifier: GPL-3.0-or-later
import pytest
from fake_edit import FakeEdit
from scripted_drag import follow, move_to, new_drag, pause

from stiv_addon.modal import drag_loop
from stiv_addon.modal.drag_end import Progress
from stiv_addon.modal.drag_writer import MAX_REJECTED
from stiv_addon.modal.event import Event


def long_solves(**given: object) -> FakeEdit:
    """Solves that end in the next tick, and take longer than a frame."""
    return FakeEdit(delays={"drag": 1}, solving=0.03, **given)


def test_the_next_solve_runs_while_a_state_is_written() -> None:
    edit = long_solves()
    drag = new_drag(edit)
    follow(drag, 10, 20, 30)
    assert edit.calls == ["drag", "write beside", "drag", "write beside"]
    assert edit.goals == [0.1, 0.2] and edit.shown == drag.writer.written.path[-1] == 0.2
    assert drag.writer.turned == 0.5 and edit.busy  # with the solve for the third goal
    drag.tick()
    drag.tick()
    assert edit.shown == 0.3 and drag.writer.written is drag.result


def test_a_solve_and_a_writing_that_fit_into_a_frame_run_in_sequence(monkeypatch: pytest.MonkeyPatch) -> None:
    """The state is newer then."""
    monkeypatch.setattr(drag_loop, "FITTING", 60.0)
    edit = FakeEdit(delays={"drag": 1})
    drag = new_drag(edit)
    follow(drag, 10, 20)
    assert edit.calls == ["drag", "write"] and not edit.busy


def test_an_edit_that_must_be_written_first_is() -> None:
    edit = long_solves(taking=False)
    drag = new_drag(edit)
    follow(drag, 10, 20, 30)
    assert edit.calls == ["drag", "write"]


def test_a_solve_toward_the_same_goal_waits_for_the_writing() -> None:
    """It may find nothing to show, and the next motion would have to wait for it."""
    edit = FakeEdit(solving=0.03, statuses=["budget", "corrected"])
    drag = new_drag(edit)
    follow(drag, 10)
    assert edit.calls == ["drag", "write"] and not drag.at_rest


@pytest.mark.parametrize("end", ["ESC", "RIGHTMOUSE"])
def test_cancelling_while_a_solve_runs_restores_the_start(end: str) -> None:
    edit = long_solves()
    drag = new_drag(edit)
    follow(drag, 10, 20)
    assert edit.busy and edit.shown == 0.1
    drag.handle(Event(end))
    assert drag.progress is Progress.CANCELLED and edit.calls[-1] == "restore" and edit.shown == 0.0


def test_a_confirmation_while_a_solve_runs_ends_at_the_last_goal() -> None:
    edit = long_solves()
    drag = new_drag(edit)
    follow(drag, 10, 20, 30)
    drag.handle(Event("LEFTMOUSE"))
    while drag.progress is Progress.FINISHING:
        drag.tick()
    assert drag.progress is Progress.FINISHED and edit.shown == edit.accepted == drag.transform == 0.3


def test_a_taken_state_that_fails_the_test_is_written_again_once_the_solve_has_ended() -> None:
    """Blender flips the diagonals of bent quads."""
    edit = long_solves(flips=True)
    drag = new_drag(edit)
    follow(drag, 10, 20)
    assert edit.calls == ["drag", "write beside", "drag", "write"] and not edit.busy
    assert edit.shown == edit.accepted == 0.2 and drag.at_rest


def test_a_state_that_fails_the_test_is_not_shown_and_the_solve_continues() -> None:
    edit = long_solves(cutting=(0.2,))
    drag = new_drag(edit)
    follow(drag, 10, 20, 30)
    assert edit.calls == ["drag", "write beside", "drag", "write beside", "write shown"] and edit.busy
    assert edit.shown == drag.writer.written.path[-1] == 0.1 and drag.writer.report.passed and not drag.at_rest
    follow(drag, 40)
    assert edit.calls[5:] == ["drag", "write beside"] and edit.shown == drag.writer.written.path[-1] == 0.3


def test_a_state_that_fails_the_test_is_passed_over_without_a_solve_beside_it_too() -> None:
    edit = FakeEdit(cutting=(0.2,))
    drag = new_drag(edit)
    follow(drag, 10, 20)
    assert edit.calls == ["drag", "write", "drag", "write", "write shown"] and edit.shown == 0.1
    follow(drag, 30)
    assert edit.shown == drag.writer.written.path[-1] == 0.3 and drag.writer.is_incomplete and not drag.at_rest


def test_a_pause_tests_the_last_state_completely() -> None:
    edit = FakeEdit()
    drag = new_drag(edit)
    follow(drag, 10)
    drag.tick()
    assert edit.calls == ["drag", "write"] and drag.writer.is_incomplete
    pause(drag)
    assert edit.calls == ["drag", "write", "write"] and not drag.writer.is_incomplete


def test_the_last_state_is_written_completely_if_it_failed_beside_a_solve() -> None:
    edit = long_solves(cutting=(0.2,))
    drag = new_drag(edit)
    follow(drag, 10, 20, 30)
    edit.furthest = 0.0  # nothing more is accepted
    pause(drag)
    assert edit.calls[-1] == "write" and edit.shown == edit.accepted


def test_after_several_failures_the_path_is_solved_again() -> None:
    edit = long_solves(cutting=(0.2, 0.3, 0.4))
    drag = new_drag(edit)
    follow(drag, 10, 20, 30, 40, 50)
    assert edit.calls.count("write shown") == MAX_REJECTED
    assert edit.calls[-1] == "write" and edit.shown == edit.accepted


@pytest.mark.parametrize("call", ["drag", "write beside"])
def test_an_exception_beside_a_solve_restores_and_ends(call: str) -> None:
    edit = long_solves(failing={call: RuntimeError("broken")})
    drag = new_drag(edit)
    follow(drag, 10, 20, 30)
    assert drag.progress is Progress.CANCELLED and edit.calls[-1] == "restore" and str(drag.error) == "broken"


@pytest.mark.parametrize("stops", [False, True])
def test_the_last_state_is_written_in_turns_which_esc_shortens(stops: bool) -> None:
    """Where Blender's evaluation fails the test, an older state is searched, for seconds in large scenes."""
    edit = FakeEdit(delays={"write": 5})
    drag = new_drag(edit)
    follow(drag, 10)
    shown = edit.shown
    drag.handle(Event("LEFTMOUSE"))
    turns = 0
    while drag.progress is Progress.FINISHING:
        assert edit.shown == shown and turns < 20
        turns += 1
        if stops and turns == 2:
            drag.handle(Event("ESC"))
        drag.tick()
    assert drag.progress is Progress.FINISHED and drag.error is None
    assert turns < 4 if stops else turns > 4
    assert edit.shown == edit.accepted == 0.1 and drag.writer.written is drag.result and edit.calls[-1] == "write"


def test_an_error_while_the_last_state_is_written_restores_the_start() -> None:
    edit = FakeEdit(delays={"write": 3}, failing={"write": RuntimeError("the scene has changed")})
    drag = new_drag(edit)
    drag.handle(move_to(10))
    drag.handle(Event("LEFTMOUSE"))
    while not drag.progress.ended:
        drag.tick()
    assert drag.progress is Progress.CANCELLED and str(drag.error) == "the scene has changed"
    assert edit.calls[-1] == "restore" and edit.shown == 0.0
