# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the accepted states of a drag into Blender: at once, or beside the solve for the next goal."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..stiv_blender import Edit, EditResult, Steps, WriteReport

MAX_REJECTED = 2  # states in a row that fail in Blender's evaluation while the mouse moves: the next one may pass


class DragWriter:
    """Writes states, and knows what the scene shows.

    Attributes:
        report: of the last writing.
        written: the result that the scene shows.
        turned: radians by which contact has turned a moving object in it.
        is_due: whether an accepted state is to be written.
        is_incomplete: whether the last state was written by `write_beside`, and is still to be tested completely.
        seconds: of the last writing; before the first one, of reading.

    """

    def __init__(self) -> None:
        """Nothing is written yet."""
        self.report: WriteReport | None = None
        self.written: EditResult | None = None
        self.turned = 0.0
        self.is_due = False
        self.is_incomplete = False
        self.seconds = 0.0
        self._rejected = 0  # states since the last one that was written
        self._began: float | None = None  # until the drawing is over

    def drawn_in(self) -> float | None:
        """Seconds since the last writing began, which include drawing; None without one since the last call."""
        began, self._began = self._began, None
        return None if began is None else time.perf_counter() - began

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Time what is called to write a state."""
        self.is_due = False
        self._began = begun = time.perf_counter()
        yield
        self.seconds = time.perf_counter() - begun

    def write(self, edit: Edit, result: EditResult | None) -> EditResult | None:
        """Write the accepted state and test it completely; returns its result, which is new if it was solved again."""
        self._begin_complete()
        return self._take(edit, edit.write(), result)

    def write_steps(self, edit: Edit, result: EditResult | None) -> Steps[EditResult | None]:
        """Steps of `write`; the scene shows the last written state between them."""
        self._begin_complete()
        report = yield from edit.write_steps()
        return self._take(edit, report, result)

    def _begin_complete(self) -> None:
        self.is_due = self.is_incomplete = False
        self._rejected = 0

    def _take(self, edit: Edit, report: WriteReport | None, result: EditResult | None) -> EditResult | None:
        self.report = report
        if self.report is not None and self.report.result is not None:
            result = self.report.result
        self.written = result if self.report is None or not self.report.message else None
        self.turned = edit.turned  # a session in a job cannot be asked
        return result

    def write_beside(self, edit: Edit, result: EditResult | None, start_solve: Callable[[], None]) -> bool:
        """Write the accepted state; `start_solve` may start a solve, which then runs meanwhile.

        Returns whether the displayed state passed the test. A state that fails is not shown, and the solve continues:
        the path would have to be solved again before the view could change. A later state is written instead, or this
        one with `write` once the drag rests.
        """
        taken = edit.take_state()
        if taken is None:
            return False
        start_solve()
        report = edit.write_taken(taken)
        if report is None:
            return self._return_to_shown(edit)
        self._rejected = 0
        self.report, self.written, self.turned = report, result, taken.turned
        self.is_incomplete = True
        return True

    def _return_to_shown(self, edit: Edit) -> bool:
        """Show the state before the one that failed; returns whether it passes the test, unless too many failed."""
        if self._rejected >= MAX_REJECTED or not edit.write_shown():
            return False
        self._rejected += 1
        self.is_incomplete = True
        return True
