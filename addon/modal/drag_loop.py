# SPDX-License-Identifier: GPL-3.0-or-later
"""The loop of a drag: events change its state, ticks solve for the state's goal, and every exit is clean."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING

from .event import Event
from .event_handling import step
from .pace import Pace
from .pointer import Pointer
from .request import Request
from .state import Effect, Phase, State

if TYPE_CHECKING:
    from ..stiv_blender import Edit, EditResult, Motion, WriteReport
    from ..transform import Transform

FINAL_SOLVES = 10  # solves, each within its budget, for a goal that is not reached when a drag is confirmed
GAIN = 0.99  # fraction of the energy: a repeated solve that leaves more of it is the last


class Progress(Enum):
    """The status of a drag after an event."""

    RUNNING = "running"
    FINISHED = "finished"
    VALUE_GIVEN = "value given"
    """Confirmed by typed numbers: the start is restored, and the caller applies `transform` as a script would."""
    CANCELLED = "cancelled"


@dataclass(frozen=True)
class Goal:
    """The goal of a solve: a state, its transform, and the motion that an edit takes."""

    state: State
    transform: Transform
    motion: Motion


class DragEnded(RuntimeError):  # noqa: N818 (it is not an error)
    """An event outside the drag ended it."""


def restore_after_error(edit: Edit, error: Exception) -> None:
    """Restore the start; if that fails too because the scene is gone, `error` gets a note."""
    try:
        edit.restore()
    except Exception as second:
        error.add_note(f"while restoring: {second}")


class DragLoop:
    """A drag from its start to a confirmation or a clean cancellation.

    Events only change the state; `tick` solves for the latest goal, so that motions never queue up behind a solve. A
    solve has the time of a frame. If that ends before a state is accepted, the next tick continues with the same goal:
    with a new goal at each tick, none would be reached. If a tick has no time left to write, the next one writes.

    No exception leaves this class. A rejected value (ValueError) becomes `note`, and the last accepted state stays
    until the user types on. Any other exception restores the scene, ends the drag and becomes `error`.
    """

    def __init__(
        self,
        begin: Callable[[Request], Edit],
        transform_of: Callable[[State], Transform],
        motion_of: Callable[[Transform, State], Motion],
        state: State,
    ):
        """Start a drag. An exception of `begin` is passed on, with nothing changed.

        Args:
            begin: begins an edit of the current scene; called again when the state requests another one.
            transform_of: the transform that a state requests.
            motion_of: the motion that an edit takes for a transform and a state.
            state: the state before the first event.

        """
        self.state = state
        self.progress = Progress.RUNNING
        self.transform: Transform | None = None
        self.result: EditResult | None = None
        self.report: WriteReport | None = None
        self.written: EditResult | None = None  # the result that the scene shows
        self.note = ""
        self.error: Exception | None = None
        self.edit = begin(state.request)
        self._begun = state.request
        self._begin = begin
        self._transform_of = transform_of
        self._motion_of = motion_of
        self._pending = False
        self._pace = Pace()
        self._unfinished: Goal | None = None
        self._unwritten = False
        self._solved: tuple[State | None, float] = (None, 0.0)

    @property
    def at_rest(self) -> bool:
        """Whether nothing is left to solve until the next event."""
        return not (self._pending or self._unwritten) or self.progress is not Progress.RUNNING

    def handle(self, event: Event) -> Effect:
        """Take one event; returns the effect that it requested."""
        effect = Effect.NONE

        def take() -> None:
            nonlocal effect
            effect = self._carry_out(event)

        self._guarded(take)
        return effect

    def change_view(self, pointer: Pointer) -> None:
        """Solve for the goal of the pointer in a changed view."""
        self.state = replace(self.state, pointer=pointer)
        self._pending = True

    def tick(self) -> Progress:
        """Solve for the latest goal if it is not reached, or write the result of the last tick."""
        return self._guarded(self._advance)

    def abort(self, reason: Exception) -> Progress:
        """Restore the start and end the drag."""
        return self._guarded(lambda: self._fail(reason))

    def _guarded(self, action: Callable[[], None]) -> Progress:
        if self.progress is Progress.RUNNING:
            try:
                action()
            except Exception as error:  # a modal operator must end, whatever went wrong
                self._fail(error)
        return self.progress

    def _carry_out(self, event: Event) -> Effect:
        self.state, effect = step(self.state, event)
        if effect is Effect.UPDATE:
            self._pending = True
        elif effect is Effect.CONFIRM:
            self._confirm()
        elif effect is Effect.CANCEL:
            self.edit.restore()
            self.progress = Progress.CANCELLED
        return effect

    def _advance(self) -> None:
        begun = time.perf_counter()
        if not self._unwritten:
            self._unwritten = self._solve()
        if self._unwritten and self._pace.has_time_to_write(time.perf_counter() - begun):
            self._write()

    def _solve(self) -> bool:
        """Solve for the latest goal or continue the current one; returns whether there is a state to write."""
        if not self._pending:
            return False
        self._pending = False
        refusal = self._begin_again()
        try:
            goal = self._unfinished or self._new_goal()
            self._unfinished = None
            result = self.edit.drag(goal.motion, time_budget=self._pace.budget)
        except ValueError as error:
            self.note = str(error)
            return False
        self.result, self.transform, self.note = result, goal.transform, refusal
        self._pending = self._may_gain(goal.state, result) or goal.state != self.state
        nothing_accepted = result.status == "budget" and len(result.path) == 0
        self._unfinished = goal if nothing_accepted else None
        return not nothing_accepted

    def _new_goal(self) -> Goal:
        transform = self._transform_of(self.state)
        return Goal(self.state, transform, self._motion_of(transform, self.state))

    def _may_gain(self, state: State, result: EditResult) -> bool:
        """Whether another solve for the same state may come closer: one solve goes only a limited way to a far goal.

        While the mouse rests, this makes the final state independent of the number of motions before it.
        """
        solved, least = self._solved
        self._solved = (state, result.energy)
        gained = solved != state or result.energy < GAIN * least
        return result.status == "budget" or (result.status == "corrected" and gained)

    def _begin_again(self) -> str:
        """Begin another edit if the state requests one; returns the reason if that is refused and the old one stays.

        Collisions alone are turned on and off within the current edit.
        """
        request = self.state.request
        if request == replace(self._begun, interference=request.interference):
            return self._switch_interference() if request != self._begun else ""
        self._unfinished = None
        self.edit.restore()
        try:
            self.edit = self._begin(request)
        except ValueError as error:
            self.state = replace(self.state, request=self._begun)
            return str(error)
        self._begun = request
        return ""

    def _switch_interference(self) -> str:
        self._unfinished = None
        reason = self.edit.set_interference(self.state.request.interference)
        self._begun = replace(self._begun, interference=self.edit.interference)
        self.state = replace(self.state, request=self._begun)
        return reason

    def _confirm(self) -> None:
        if self.state.typed.active:
            self._confirm_typed()
            return
        if self._pending or self.result is not None:
            self._finish_dragged()
        self.progress = Progress.FINISHED

    def _confirm_typed(self) -> None:
        """Confirm typed numbers; if they are invalid, the drag continues with a note."""
        try:
            self.transform = self._transform_of(self.state)
        except ValueError as error:
            self.note = str(error)
            self.state = replace(self.state, phase=Phase.DRAGGING)
            return
        self.edit.restore()
        self.progress = Progress.VALUE_GIVEN

    def _finish_dragged(self) -> None:
        self._unfinished = None  # the goal is the position where the mouse was released
        for _ in range(FINAL_SOLVES):
            if self._solve():
                self._write()
        if self.result is not None:
            settled = self.edit.settle()
            self.result = settled if settled.status != "unchanged" else self.result
            self._write()

    def _write(self) -> None:
        begun = time.perf_counter()
        self._unwritten = False
        self.report = self.edit.write()
        if self.report is not None and self.report.result is not None:  # solved again
            self.result = self.report.result
        self.written = self.result if self.report is None or not self.report.message else None
        self._pace.note(time.perf_counter() - begun)

    def _fail(self, error: Exception) -> None:
        self.error = error
        self.progress = Progress.CANCELLED
        restore_after_error(self.edit, error)
