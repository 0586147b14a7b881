# SPDX-License-Identifier: GPL-3.0-or-later
"""The common form of layouts: read the scene, solve in steps, write; cancelled or late, nothing changes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import stiv
from stiv.deadlines import deadline_after, is_over
from stiv.task import Steps
from stiv.task import run as run_steps

Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class LayoutReport:
    """The result of a layout.

    Attributes:
        status: "done", "unchanged", "cancelled" or "budget" (the time limit was reached); only "done" changes anything.
        changed: names of the objects that moved or were added.
        left: names of objects that stay unchanged, each with the reason: "nothing below", "nothing near", "locked",
            "no surface", "stuck" (cannot be moved apart) or "no room".
        contacts: number of points that support each object that was brought to rest.
        asked: number of objects to lay out.
        scale: by which the objects were scaled.
    """

    status: str
    changed: tuple[str, ...] = ()
    left: tuple[tuple[str, str], ...] = ()
    contacts: tuple[int, ...] = ()
    asked: int = 0
    scale: float = 1.0


class Stopped(Exception):  # noqa: N818 (not an error)
    """Ends a solve; its argument is the status of the report."""


class Watch:
    """Gives the caller of a solve its turns, reports progress, and stops a solve that is cancelled or out of time."""

    def __init__(self, progress: Progress | None, time_budget: float) -> None:
        """Start the clock. time_budget: seconds, 0 for no limit."""
        self._progress = progress
        self._end = deadline_after(time_budget)
        self._phase, self._fraction = "", 0.0

    def at(self, phase: str, fraction: float) -> Steps[None]:
        """Begin a phase: the name of an object, and the fraction of all work done before. Raises Stopped."""
        self._phase, self._fraction = phase, fraction
        yield fraction
        yield from self.check()

    def check(self) -> Steps[None]:
        """Report the present phase and give a turn. Raises Stopped."""
        if self._progress is not None:
            self._progress(self._phase, self._fraction)
        if (yield None):
            raise Stopped("cancelled")
        if is_over(self._end):
            raise Stopped("budget")


class LayoutTask:
    """Base of layouts; a subclass solves and writes. Reading and writing require Blender's main thread."""

    def __init__(self, time_budget: float) -> None:
        """time_budget: seconds of a solve, 0 for no limit."""
        self._time_budget = time_budget
        self._stopped = ""

    def solve(self, *, cancel: stiv.CancelToken | None = None, progress: Progress | None = None) -> None:
        """Find the layout. Cancelled or out of time, `write` changes nothing."""
        run_steps(self.solve_steps(progress), cancel=cancel)

    def solve_steps(self, progress: Progress | None = None) -> Steps[None]:
        """Steps of `solve`; they do not access Blender."""
        try:
            yield from self._solve(Watch(progress, self._time_budget))
        except Stopped as stop:
            self._stopped = str(stop)
        except stiv.CancelledError:
            self._stopped = "cancelled"

    def write(self) -> LayoutReport:
        """Write the layout and test Blender's evaluation. Raises InputError, with nothing changed."""
        return LayoutReport(self._stopped) if self._stopped else self._write()

    def restore(self) -> None:
        """Restore the scene exactly."""
        raise NotImplementedError

    def _solve(self, watch: Watch) -> Steps[None]:
        raise NotImplementedError

    def _write(self) -> LayoutReport:
        raise NotImplementedError


def run(task: LayoutTask, **execution: Any) -> LayoutReport:
    """Solve and write; restores the scene on any error."""
    try:
        task.solve(**execution)
        return task.write()
    except BaseException:
        task.restore()
        raise
