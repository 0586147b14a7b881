# SPDX-License-Identifier: GPL-3.0-or-later
"""One drag: events turned into goals, goals into edits, and every way out."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any

from .edit import Edit, Request, put_back
from .event import Event
from .event_handling import step
from .pace import Pace
from .pointer import Pointer
from .state import Effect, Phase, State

LAST_SLICES = 10  # solves, each within its time, for what is left to do when a drag is confirmed
GAIN = 0.99  # of the energy before: a solve for the same goal that leaves more of it was the last


class Progress(Enum):
    """Where a drag stands after an event."""

    RUNNING = "running"
    FINISHED = "finished"
    VALUE_GIVEN = "value given"
    """Confirmed by typed numbers: everything is restored, and `transform` is to be applied as a script would."""
    CANCELLED = "cancelled"


@dataclass(frozen=True)
class Aim:
    """What a solve is for: the transform that a state asks for, and what an edit drags to for it."""

    state: State
    transform: Any
    motion: Any


class DragEnded(RuntimeError):  # noqa: N818 (it is no error of anybody)
    """Something outside the drag ended it."""


class Drag:
    """A drag from its start to a confirmation or a clean cancellation.

    Events only change the state; `tick` solves for the latest one, so that motions are never queued up behind a solve.
    A solve has the time of a frame. Where that ends before anything was accepted, the next tick goes on with the same
    goal: one that is new at each tick would never be solved. What there is no time left to show, the next tick shows.
    No exception leaves this class: a refused value (ValueError) is told in `note` and the last accepted state stays
    until the user types on; anything else restores the scene and ends the drag with the exception in `error`.
    """

    def __init__(
        self,
        begin: Callable[[Request], Edit],
        measure: Callable[[State], Any],
        motion: Callable[[Any, State], Any],
        state: State,
    ):
        """Start a drag; what `begin` raises comes out, with nothing changed.

        Args:
            begin: an edit of the scene as it is; again when the state requests another one.
            measure: from a state to the transform that it asks for.
            motion: from such a transform, and the state, to what an edit drags to.
            state: the state before the first event.

        """
        self.state = state
        self.progress = Progress.RUNNING
        self.transform: Any = None
        self.result: Any = None
        self.report: Any = None
        self.note = ""
        self.error: Exception | None = None
        self.edit = begin(state.request)
        self._begun = state.request
        self._begin = begin
        self._measure = measure
        self._motion = motion
        self._pending = False
        self._pace = Pace()
        self._unfinished: Aim | None = None
        self._unshown = False
        self._solved: tuple[State | None, float] = (None, 0.0)

    @property
    def at_rest(self) -> bool:
        """Is there nothing to solve for until the next event?"""
        return not (self._pending or self._unshown) or self.progress is not Progress.RUNNING

    def handle(self, event: Event) -> Effect:
        """Take one event; says what it asked for."""
        effect = Effect.NONE

        def take() -> None:
            nonlocal effect
            effect = self._carry_out(event)

        self._guarded(take)
        return effect

    def look(self, pointer: Pointer) -> None:
        """The view changed: solve for what the pointer means in it."""
        self.state = replace(self.state, pointer=pointer)
        self._pending = True

    def tick(self) -> Progress:
        """Solve for the latest goal, if it is not yet reached, or show what the last tick came to."""
        return self._guarded(self._advance)

    def abort(self, reason: Exception) -> Progress:
        """Restore and end, whatever the state."""
        return self._guarded(lambda: self._fail(reason))

    def _guarded(self, action: Callable[[], None]) -> Progress:
        if self.progress is Progress.RUNNING:
            try:
                action()
            except Exception as error:  # a running modal operator must not be left behind, whatever went wrong
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
        if not self._unshown:
            self._unshown = self._solve()
        if self._unshown and self._pace.has_time_to_show(time.perf_counter() - begun):
            self._show()

    def _solve(self) -> bool:
        """Solve for the latest goal, or go on with the one in hand; says whether there is anything to show."""
        if not self._pending:
            return False
        self._pending = False
        refusal = self._begin_again()
        try:
            aim = self._unfinished or self._new_aim()
            self._unfinished = None
            self.result = self.edit.drag(aim.motion, time_budget=self._pace.budget)
        except ValueError as error:
            self.note = str(error)
            return False
        self.transform = aim.transform
        self.note = refusal
        self._pending = self._may_gain(aim.state) or aim.state != self.state
        nothing_accepted = self.result.status == "budget" and len(self.result.path) == 0
        self._unfinished = aim if nothing_accepted else None
        return not nothing_accepted

    def _show(self) -> None:
        begun = time.perf_counter()
        self._unshown = False
        self._write()
        self._pace.note(time.perf_counter() - begun)

    def _new_aim(self) -> Aim:
        transform = self._measure(self.state)
        return Aim(self.state, transform, self._motion(transform, self.state))

    def _may_gain(self, state: State) -> bool:
        """Is it worth to solve for the same state once more? A solve goes only so far toward a goal that is far off.

        While the mouse moves the next motion does that; where it rests, so that what is shown does not hang on how
        many motions there was time for.
        """
        solved, least = self._solved
        self._solved = (state, self.result.energy)
        gained = solved != state or self.result.energy < GAIN * least
        return self.result.status == "budget" or (self.result.status == "corrected" and gained)

    def _begin_again(self) -> str:
        """Another edit from the start where another is requested; where that is refused, the old one goes on.

        Interference alone is switched in the edit that is there.
        """
        request = self.state.request
        if request == replace(self._begun, interference=request.interference):
            return self._switch_interference() if request != self._begun else ""
        self._unfinished = None
        self.edit.restore()
        try:
            self.edit = self._begin(self.state.request)
        except ValueError as error:
            self.state = replace(self.state, request=self._begun)
            return str(error)
        self._begun = self.state.request
        return ""

    def _switch_interference(self) -> str:
        self._unfinished = None
        reason = self.edit.set_interference(self.state.request.interference)
        self._begun = replace(self._begun, interference=self.edit.interference)
        self.state = replace(self.state, request=self._begun)
        return reason

    def _confirm(self) -> None:
        if self.state.typed.active:
            self._give_value()
            return
        if self._pending or self.result is not None:
            self._finish_dragged()
        self.progress = Progress.FINISHED

    def _give_value(self) -> None:
        """What is no number cannot be confirmed: the drag goes on, and says so."""
        try:
            self.transform = self._measure(self.state)
        except ValueError as error:
            self.note = str(error)
            self.state = replace(self.state, phase=Phase.DRAGGING)
            return
        self.edit.restore()
        self.progress = Progress.VALUE_GIVEN

    def _finish_dragged(self) -> None:
        self._unfinished = None  # what counts is where the mouse was let go
        for _ in range(LAST_SLICES):
            if self._solve():
                self._show()
        if self.result is not None:
            settled = self.edit.settle()
            self.result = settled if settled.status != "unchanged" else self.result
            self._write()

    def _write(self) -> None:
        self.report = self.edit.write()
        if self.report is not None and self.report.result is not None:  # solved again
            self.result = self.report.result

    def _fail(self, error: Exception) -> None:
        self.error = error
        self.progress = Progress.CANCELLED
        put_back(self.edit, error)
