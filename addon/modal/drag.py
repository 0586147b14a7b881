# SPDX-License-Identifier: GPL-3.0-or-later
"""One drag: events turned into goals, goals into edits, and every way out."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from typing import Any, Protocol

from .events import Event
from .state import Effect, State, step


class Edit(Protocol):
    """What a drag needs of an edit of the scene; `stiv.blender.BlenderEdit` is one."""

    def drag(self, matrix: Any) -> Any:
        """Solve for an absolute goal."""

    def settle(self) -> Any:
        """Solve again from the accepted state."""

    def write(self) -> Any:
        """Show the accepted state."""

    def restore(self) -> None:
        """Put everything back as it was at the start."""


class Progress(Enum):
    """Where a drag stands after an event."""

    RUNNING = "running"
    FINISHED = "finished"
    VALUE_GIVEN = "value given"
    """Confirmed by a typed number: everything is restored, and `transform` is to be applied as a script would."""
    CANCELLED = "cancelled"


class DragEnded(RuntimeError):  # noqa: N818 (it is no error of anybody)
    """Something outside the drag ended it."""


class Drag:
    """A drag from its start to a confirmation or a clean cancellation.

    Events only change the state; `tick` solves for the latest one, so that motions are never queued up behind a solve.
    No exception leaves this class: a refused value (ValueError) is told in `note` and the last accepted state stays
    until the user types on; anything else restores the scene and ends the drag with the exception in `error`.
    """

    def __init__(self, edit: Edit, measure: Callable[[State], Any], matrix: Callable[[Any], Any], state: State):
        """Start a drag.

        Args:
            edit: begun, nothing solved yet.
            measure: from a state to the transform that it asks for.
            matrix: from such a transform to a (4, 4) world matrix.
            state: the state before the first event.

        """
        self.state = state
        self.progress = Progress.RUNNING
        self.transform: Any = None
        self.result: Any = None
        self.report: Any = None
        self.note = ""
        self.error: Exception | None = None
        self._edit = edit
        self._measure = measure
        self._matrix = matrix
        self._pending = False

    def handle(self, event: Event) -> Progress:
        """Take one event."""
        return self._guarded(lambda: self._carry_out(event))

    def tick(self) -> Progress:
        """Solve for the latest goal, if it is not yet reached."""
        return self._guarded(self._solve_pending)

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

    def _carry_out(self, event: Event) -> None:
        self.state, effect = step(self.state, event)
        if effect is Effect.UPDATE:
            self._pending = True
        elif effect is Effect.CONFIRM:
            self._confirm()
        elif effect is Effect.CANCEL:
            self._edit.restore()
            self.progress = Progress.CANCELLED

    def _solve_pending(self) -> None:
        if not self._pending:
            return
        self._pending = False
        self.transform = self._measure(self.state)
        try:
            self.result = self._edit.drag(self._matrix(self.transform))
        except ValueError as refusal:
            self.note = str(refusal)
            return
        self.note = ""
        self._pending = self.result.status == "budget"
        self._write()

    def _confirm(self) -> None:
        if self.state.typed.active:
            self.transform = self._measure(self.state)
            self._edit.restore()
            self.progress = Progress.VALUE_GIVEN
            return
        if self._pending or self.result is not None:
            self._finish_dragged()
        self.progress = Progress.FINISHED

    def _finish_dragged(self) -> None:
        if self._pending:
            self.transform = self._measure(self.state)
            self.result = self._edit.drag(self._matrix(self.transform))
        settled = self._edit.settle()
        self.result = settled if settled.status != "unchanged" else self.result
        self._write()

    def _write(self) -> None:
        self.report = self._edit.write()
        if self.report is not None and self.report.result is not None:  # solved again
            self.result = self.report.result

    def _fail(self, error: Exception) -> None:
        self.error = error
        self.progress = Progress.CANCELLED
        put_back(self._edit, error)


def put_back(edit: Edit, error: Exception) -> None:
    """Restore after an error; where that fails too (the scene is gone), the error says so."""
    try:
        edit.restore()
    except Exception as second:
        error.add_note(f"while restoring: {second}")
