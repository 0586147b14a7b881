# SPDX-License-Identifier: GPL-3.0-or-later
"""The loop of a drag: events change its state, ticks solve for the state's goal, and every exit is clean."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from .current_task import CurrentTask
from .drag_calls import DragCalls, Goal, with_rejection
from .drag_end import Progress, restore_after_error
from .drag_writer import DragWriter
from .event import Event
from .event_handling import step
from .pointer import Pointer
from .remaining_work import Moment, Refinement, RemainingWork
from .request import Request
from .solve_budget import BUDGET, MAX_BUDGET, SolveBudget
from .state import Effect, Phase, State, same_goal

if TYPE_CHECKING:
    from ..stiv_blender import Edit, EditResult
    from ..transform import Transform

FRAME = 1.0 / 60.0  # seconds that a tick waits for a solve
FITTING = 0.75 * FRAME  # seconds of a solve and its writing that run in sequence: the state is newer then
COMPARING_TIME = 5.0  # seconds that the comparison with the edit from the start may take after the confirmation
FINISHING_TIME = 10.0  # seconds after the confirmation in which solves that meet obstacles may come closer
PAUSE_TIME = 2 * FRAME  # seconds without a motion after which a state is tested completely
REST_TIME = 0.2  # seconds without a motion after which a drag settles, so that its confirmation need not
START_WAIT = 0.15  # seconds that a job of a start may take before the view is redrawn, which takes longer if large


class DragLoop:
    """A drag from its start to a confirmation or a clean cancellation.

    Events only change the state; `tick` solves for the latest goal, so that motions never queue up behind a solve. The
    start and each solve are tasks, whose jobs run beside Blender: a tick waits for a job no longer than a frame, and
    the next tick continues. While an accepted state is written, evaluated and tested, the next solve already runs.
    While the mouse rests, budgets grow and the drag settles; the next motion cancels that. If the budget of a solve
    ends before a state is accepted, the next solve continues with the same goal: with a new goal each time, none would
    be reached.

    No exception leaves this class after the start. A rejected value (ValueError) becomes `note`, and the last accepted
    state stays until the user types on. Any other exception restores the scene, ends the drag and becomes `error`.
    """

    def __init__(self, calls: DragCalls, state: State):
        """Start a drag. An exception of the first step is passed on, with nothing changed.

        Args:
            calls: what the drag calls.
            state: the state before the first event.

        """
        self.state = state
        self.progress = Progress.STARTING
        self.transform: Transform | None = None
        self.result: EditResult | None = None
        self.writer = DragWriter()
        self.note = ""
        self.error: Exception | None = None
        self.edit: Edit | None = None
        self.stopped = False  # Esc ended the solve after the confirmation
        self._calls = calls
        self._task = CurrentTask(calls.task)
        self._work = RemainingWork()
        self._budget = SolveBudget()
        self._begun = state.request
        self._confirmed, self._confirmed_at = False, math.inf
        self._refusal = ""
        self._solves = 0
        self._aimed_at: State | None = None  # state of the last goal
        self._moved_at = 0.0
        self._applies = False  # confirmed with typed values
        self._returned_at = math.inf  # when the last tick gave the interface its turn
        self._task.run(calls.begin(state.request), self._take_first_edit)
        began = time.perf_counter()
        starts_job = not self._task.advance(0.0)  # reads the scene, which takes about as long as writing and drawing it
        self.writer.seconds = time.perf_counter() - began
        self._budget.take_shown_in(self.writer.seconds)
        if starts_job:
            self._task.advance(START_WAIT)

    @property
    def at_rest(self) -> bool:
        """Whether nothing is left to solve until the next event."""
        writes = self.writer.is_due or self.writer.is_incomplete
        unfinished = self._work.pending or writes or self._task.runs
        return self.progress.ended or not unfinished

    @property
    def shows_soon(self) -> bool:
        """Whether the first solves for a goal accepted nothing, and others follow: showing each would draw the view."""
        return self._work.repeated.are_hidden and not self.at_rest

    @property
    def fraction(self) -> float:
        """The fraction of a start or of typed values that is done; of solves after a drag, of the time that they have.

        Each of these has a fraction of its own, and nobody knows how many follow.
        """
        if self._confirmed and self.edit is not None and not self._applies:
            return min(self.seconds_confirmed / FINISHING_TIME, 1.0)
        return self._task.fraction

    @property
    def seconds_confirmed(self) -> float:
        """Seconds since the confirmation."""
        return max(0.0, time.perf_counter() - self._confirmed_at)

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
        if not self._confirmed:
            self.state = replace(self.state, pointer=pointer)
            self._note_motion()

    def tick(self) -> Progress:
        """Solve for the latest goal if it is not reached, and write the result."""
        progress = self._guarded(self._advance)
        self._returned_at = time.perf_counter()
        return progress

    @property
    def _wait(self) -> float:
        """Seconds that a tick waits for a solve: after the confirmation, as long as Blender took since the last tick.

        Many solves wait for the evaluations of Blender's thread. Otherwise a slow drawing would leave them little time.
        """
        if not self._confirmed:
            return FRAME
        return min(max(FRAME, time.perf_counter() - self._returned_at), MAX_BUDGET)

    def abort(self, reason: Exception) -> Progress:
        """Restore the start and end the drag."""
        return self._guarded(lambda: self._fail(reason))

    def _guarded(self, action: Callable[[], None]) -> Progress:
        drawn_in = self.writer.drawn_in()
        if drawn_in is not None:
            self._budget.take_shown_in(drawn_in)
        if not self.progress.ended:
            try:
                action()
            except Exception as error:  # a modal operator must end, whatever went wrong
                self._fail(error)
        return self.progress

    def _carry_out(self, event: Event) -> Effect:
        self.state, effect = step(self.state, event)
        if effect is Effect.UPDATE:
            self._note_motion()
        elif effect is Effect.CONFIRM:
            self._confirm()
        elif effect is Effect.STOP:
            self._stop()
        elif effect is Effect.CANCEL:
            self._leave_task()
            if self.edit is not None:
                self.edit.restore()
            self.progress = Progress.CANCELLED
        return effect

    def _note_motion(self) -> None:
        """Solve for a new goal, without what rest was used for."""
        self._work.begin()
        self._moved_at = time.perf_counter()
        if self._task.can_cancel:
            self._task.cancel()

    def _advance(self) -> None:
        if self._confirmed:
            self._task.cancel_slow()
        end, solves = time.perf_counter() + self._wait, self._solves
        while solves == self._solves and (self._task.runs or self._begin_work()):
            if not self._task.advance(max(0.0, end - time.perf_counter())):
                return
        if self.writer.is_incomplete and not self._work.pending and not self._task.runs and not self._moves(PAUSE_TIME):
            self.writer.is_due = True
        if self.writer.is_due and not self._solves_on():
            self._write(is_new=solves < self._solves)
        if self._confirmed and self.at_rest and not self._needs_refinement:
            self._end_confirmed()

    def _end_confirmed(self) -> None:
        """Finish. If no state was accepted, write the start: an operator without a report would solve again."""
        if self.result is not None and self.writer.report is None and self.writer.written is None:
            self._write(is_new=False)
            if self._task.runs:  # it writes in steps, and this is called again
                return
        self.progress = Progress.FINISHED

    def _solves_on(self) -> bool:
        """Whether a confirmed drag is not at its end: drawing each state on the way would take longer than solving."""
        return self._confirmed and (self._work.pending or self._task.runs or self._needs_refinement)

    @property
    def _needs_refinement(self) -> bool:
        return self.result is not None and self._work.refinement is not Refinement.NONE

    def _leave_task(self) -> None:
        """End a task without its result. A session is free afterwards; the start need not be waited for."""
        self._task.leave(waits=self.edit is not None)

    def _begin_work(self) -> bool:
        """Begin the next task, if any: another edit, a solve, or settling after the confirmation."""
        if self._work.pending:
            if not self._begin_again():
                self._begin_solve()
        elif self._needs_refinement and (self._confirmed or self._rests()):
            self._begin_refinement()
        return self._task.runs

    def _begin_refinement(self) -> None:
        assert self.edit is not None
        if self._work.refinement is Refinement.SETTLING:
            self._work.refinement = Refinement.CONFIRMING
            self._task.run(self.edit.settle_steps(), self._take_settled, can_cancel=not self._confirmed)
        else:
            self._work.refinement = Refinement.NONE
            self._task.run(self.edit.confirm_steps(), self._take_confirmed, not self._confirmed, COMPARING_TIME)

    def _rests(self) -> bool:
        """Whether the mouse has not moved for a while, and surfaces collide."""
        return self.progress is Progress.RUNNING and not self._moves(REST_TIME) and self._begun.interference

    def _moves(self, seconds: float) -> bool:
        """Whether the mouse has moved in the last seconds, and nothing is confirmed."""
        return self.progress is Progress.RUNNING and time.perf_counter() - self._moved_at < seconds

    def _begin_solve(self) -> None:
        assert self.edit is not None
        work = self._work
        work.pending = False
        try:
            goal = work.unfinished or self._calls.goal(self.state)
        except ValueError as error:
            self.note = str(error)
            return
        self._aimed_at = goal.state
        is_new = work.unfinished is None
        work.unfinished = None
        hands_over = not self._confirmed and not self._rests()
        budget, hand_over = self._budget.of_solve(self.writer.seconds, hands_over=hands_over, confirmed=self._confirmed)
        budget *= 2 ** work.repeated.doublings(is_new or self._confirmed)
        steps = self.edit.drag_steps(goal.motion, time_budget=budget, hand_over=hand_over)
        can_cancel = is_new and work.repeated.fruitless > 0 and not self._confirmed
        self._task.run(with_rejection(steps), lambda found: self._take_solved(goal, found), can_cancel)

    def _take_first_edit(self, edit: Edit) -> None:
        self.edit = edit
        self.progress = Progress.FINISHING if self._confirmed else Progress.RUNNING

    def _take_solved(self, goal: Goal, found: EditResult | ValueError) -> None:
        if self._is_cancelled(found):
            return
        self._solves += 1
        if isinstance(found, ValueError):
            self.note = str(found)
            return
        if self.stopped and not found.path:
            return
        self.result, self.transform, self.note = found, goal.transform, self._refusal
        self._refusal = ""
        self.writer.is_due |= self._has_to_show(found)
        if self._work.take_solved(goal, found, self._moment()):
            self._call_corrected()

    def _has_to_show(self, found: EditResult) -> bool:
        """Whether a solve accepted a state, or ended without one before any was written."""
        nothing_accepted = found.status == "budget" and len(found.path) == 0
        return len(found.path) > 0 or (self.writer.report is None and not nothing_accepted)

    def _moment(self) -> Moment:
        is_late = self.seconds_confirmed > FINISHING_TIME
        return Moment(self.state, self._confirmed, self._rests(), self.stopped, is_late)

    def _take_settled(self, settled: EditResult) -> None:
        """Take a settled state."""
        if self._is_cancelled(settled):
            return
        self._solves += 1
        if settled.path or settled.status not in ("unchanged", "cancelled", "budget"):
            self.result, self.writer.is_due = settled, True
        if self._work.take_settled(settled, self._moment()):
            self._call_corrected()

    def _take_confirmed(self, confirmed: EditResult) -> None:
        """Take another state, if it is better. Otherwise the result before has the contacts of the shown state."""
        if self._is_cancelled(confirmed):
            return
        self._solves += 1
        if confirmed.path:
            self.result, self.writer.is_due = confirmed, True

    def _call_corrected(self) -> None:
        """End the solves for the goal, of which the last ones gained little: the state is as close as they come."""
        if self.result is not None and self.result.status == "budget" and self.result.path:
            self.result = replace(self.result, status="corrected")

    def _is_cancelled(self, found: EditResult | ValueError) -> bool:
        """Whether a motion cancelled the solve, whose goal is no longer wanted."""
        return self._task.can_cancel and self._work.pending and getattr(found, "status", "") == "cancelled"

    def _begin_again(self) -> bool:
        """Begin another edit if the state requests one; returns whether its task has begun.

        Collisions alone are turned on and off within the current edit.
        """
        request = self.state.request
        if request == self._begun:
            return False
        self._work.unfinished = None
        if request == replace(self._begun, interference=request.interference):
            self._switch_interference()
            return False
        assert self.edit is not None
        self.edit.restore()
        self._task.run(with_rejection(self._calls.begin(request)), lambda found: self._take_edit(request, found))
        return True

    def _take_edit(self, request: Request, found: Edit | ValueError) -> None:
        """Continue with another edit, or with the old one if another is refused."""
        if isinstance(found, ValueError):
            self.state = replace(self.state, request=self._begun)
            self._refusal = getattr(found, "short", "") or str(found)  # of objects that intersect: the first two
            return
        self.edit, self._begun, self.writer.turned = found, request, 0.0

    def _switch_interference(self) -> None:
        assert self.edit is not None
        self._refusal = self.edit.set_interference(self.state.request.interference)
        self._begun = replace(self._begun, interference=self.edit.interference)
        self.state = replace(self.state, request=self._begun)

    def _confirm(self) -> None:
        if self.state.typed.active and not self._accept_typed():
            return
        self._confirmed = True
        self._confirmed_at = time.perf_counter()
        self._task.wait_from_now()
        self._work.confirm(self.result)
        if self.edit is not None or self._work.refinement is Refinement.NONE:
            self.progress = Progress.FINISHING
            self._finish_at_once()

    def _finish_at_once(self) -> None:
        """Continue for the time of a frame."""
        end = time.perf_counter() + BUDGET
        while self.progress is Progress.FINISHING and time.perf_counter() < end:
            self._advance()
            if self._task.runs:  # its job takes longer
                return

    def _accept_typed(self) -> bool:
        """Apply typed numbers from the start; if they are invalid, the drag continues with a note."""
        try:
            transform = self._calls.transform_of(self.state)
        except ValueError as error:
            self.note = str(error)
            self.state = replace(self.state, phase=Phase.DRAGGING)
            return False
        self._leave_task()
        if self.edit is not None:
            self.edit.restore()
        self.writer.is_due = False
        self._work.stop()  # the steps refine
        self.result, self._applies = None, True
        self._task.run(self._calls.apply(transform, self.state), lambda found: self._take_applied(transform, *found))
        return True

    def _take_applied(self, transform: Transform, edit: Edit, result: EditResult) -> None:
        self.edit, self.result, self.transform, self.writer.is_due = edit, result, transform, True

    def _stop(self) -> None:
        """Keep the last accepted state."""
        self.stopped = True
        self._work.stop()
        self._task.cancel()

    def _write(self, is_new: bool) -> None:
        """Write the accepted state: a new one without its complete test while the mouse moves.

        If it fails, it is passed over. To search its path for a state that passes would take several frames. After the
        confirmation, this search takes turns with the window.
        """
        assert self.edit is not None
        with self.writer.writing():
            if is_new and self._moves(REST_TIME):
                if self.writer.write_beside(self.edit, self.result, self._start_next_solve):
                    return
                self._end_solve()
            if self._confirmed:
                self._task.run(self.writer.write_steps(self.edit, self.result), self._take_written)
                self._task.advance(FRAME)
                return
            self.result = self.writer.write(self.edit, self.result)

    def _take_written(self, result: EditResult | None) -> None:
        self.result = result

    def _start_next_solve(self) -> None:
        """Start the solve for a new goal, if there is one that takes too long for the same frame."""
        solved = self.result.timings["total"] if self.result is not None else 0.0
        is_new = not same_goal(self._aimed_at, self.state)  # a repeated solve may find nothing to show
        continues = self._work.pending and self.state.request == self._begun
        if continues and is_new and solved + self.writer.seconds > FITTING:
            self._begin_solve()
            self._task.start()

    def _end_solve(self) -> None:
        """Cancel a solve and wait for its end, which takes milliseconds; its goal is solved for again."""
        if self._task.runs:
            self._work.pending = self._task.can_cancel = True
            self._task.end(FRAME)

    def _fail(self, error: Exception) -> None:
        self.error = None if self.stopped else error
        self.progress = Progress.CANCELLED
        self._leave_task()
        if self.edit is not None:
            restore_after_error(self.edit, error)
