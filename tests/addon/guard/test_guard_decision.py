# SPDX-License-Identifier: GPL-3.0-or-later
from dataclasses import replace

import pytest

from stiv_addon.guard.decision import QUIET_TIME, Action, Guard, Observation, decide

BEFORE, AFTER = (3, "0x1", "Move"), (4, "0x2", "Move")
WATCHING = Guard(has_accepted=True, step=BEFORE)
MOVED = Observation(time=10.0, updates=5, step=AFTER)


def action(guard: Guard, seen: Observation) -> Action:
    return decide(guard, seen)[1]


def test_a_finished_tool_is_corrected_in_its_own_undo_step() -> None:
    assert action(WATCHING, MOVED) is Action.REPLACE


def test_a_running_tool_is_left_alone() -> None:
    guard, what = decide(WATCHING, replace(MOVED, busy=True))
    assert what is Action.WAIT
    assert action(guard, MOVED) is Action.REPLACE


def test_without_a_change_nothing_is_done_and_the_step_is_stored() -> None:
    guard, what = decide(WATCHING, replace(MOVED, changed=False))  # a selection made a step
    assert what is Action.REST
    assert guard.step == AFTER


@pytest.mark.parametrize(
    ("guard", "seen"),
    [
        (Guard(), MOVED),  # nothing accepted so far
        (WATCHING, replace(MOVED, own_edit=True)),
        (WATCHING, replace(MOVED, frame_changed=True)),
    ],
)
def test_without_an_accepted_state_the_scene_is_tested_and_not_written(guard: Guard, seen: Observation) -> None:
    assert action(guard, seen) is Action.ACCEPT


def test_a_step_at_a_reused_address_is_new_after_history() -> None:
    """The redo panel undoes the tool's step and adds another, which may get the same address."""
    other = (2, "0x3", "start")
    assert action(WATCHING.after_history(other), replace(MOVED, step=BEFORE)) is Action.REPLACE
    assert action(WATCHING.after_history(None), replace(MOVED, step=BEFORE)) is Action.WAIT


def test_a_state_restored_by_undo_is_written_only_if_it_intersects() -> None:
    guard = WATCHING.after_history(AFTER)
    assert action(guard, MOVED) is Action.WRITE


def test_a_step_of_the_redo_panel_is_the_result_of_a_tool() -> None:
    guard = WATCHING.after_history(BEFORE)
    assert action(guard, MOVED) is Action.REPLACE


def test_a_sculpt_stroke_leaves_the_undo_stack_alone() -> None:
    assert action(WATCHING, replace(MOVED, sculpting=True)) is Action.WRITE


def test_a_change_without_an_undo_step_is_corrected_when_it_ends() -> None:
    seen = replace(MOVED, step=BEFORE)
    guard, what = decide(WATCHING, seen)
    assert what is Action.WAIT
    assert action(guard, replace(seen, time=10.0 + QUIET_TIME / 2)) is Action.WAIT
    assert action(guard, replace(seen, time=10.0 + QUIET_TIME)) is Action.PUSH


def test_a_dragged_number_field_is_corrected_at_its_end_in_its_own_step() -> None:
    seen = replace(MOVED, step=BEFORE)
    guard, _ = decide(WATCHING, seen)
    guard, what = decide(guard, replace(seen, time=10.0 + QUIET_TIME, updates=6))
    assert what is Action.WAIT
    assert action(guard, replace(MOVED, updates=6)) is Action.REPLACE  # released: the step is there


def test_without_access_to_the_undo_stack_a_step_is_added() -> None:
    seen = replace(MOVED, step=None)
    guard, what = decide(replace(WATCHING, step=None), seen)
    assert what is Action.WAIT
    assert action(guard, replace(seen, time=10.0 + QUIET_TIME)) is Action.PUSH


def test_settling_clears_the_history() -> None:
    guard = WATCHING.after_history(AFTER).settled(AFTER, True)
    assert guard == Guard(True, AFTER)
