# SPDX-License-Identifier: GPL-3.0-or-later
"""The common form of layouts: read the scene, solve without Blender, write; cancelled or late, nothing changes."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import stiv
from stiv.job import Job, JobProgress
from stiv.task import Call, Steps

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
    """Reports progress, and stops a solve that is cancelled or exceeds its time."""

    def __init__(self, cancel: stiv.CancelToken | None, progress: Progress | None, time_budget: float) -> None:
        """Start the clock. time_budget: seconds, 0 for no limit."""
        self.cancel, self._progress = cancel, progress
        self._end = time.monotonic() + time_budget if time_budget > 0 else float("inf")
        self._phase, self._fraction = "", 0.0

    def at(self, phase: str, fraction: float) -> None:
        """Begin a phase: the name of an object, and the fraction of all work done before. Raises Stopped."""
        self._phase, self._fraction = phase, fraction
        self.check()

    def check(self) -> None:
        """Report the present phase. Raises Stopped."""
        if self._progress is not None:
            self._progress(self._phase, self._fraction)
        if self.cancel is not None and self.cancel.cancelled:
            raise Stopped("cancelled")
        if time.monotonic() > self._end:
            raise Stopped("budget")


class LayoutJob(Job[None]):
    """A solve of a layout on a thread of Python, since it calls the core many times. It has no access to Blender."""

    def __init__(self, solve: Callable[..., None]) -> None:
        """Start at once."""
        self._token, self._progress = stiv.CancelToken(), JobProgress()
        self._solve = solve
        self._error: Exception | None = None
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def poll(self) -> JobProgress:
        """Return the progress, without waiting."""
        return replace(self._progress, done=not self._thread.is_alive())

    def cancel(self) -> None:
        """Ask the solve to stop."""
        self._token.cancel()

    def wait(self, seconds: float) -> bool:
        """Wait until the solve is done, at most some seconds; return whether it is."""
        self._thread.join(seconds)
        return not self._thread.is_alive()

    def result(self) -> None:
        """Wait for the end. Raises what the solve raised."""
        self._thread.join()
        if self._error is not None:
            raise self._error

    def _run(self) -> None:
        try:
            self._solve(cancel=self._token, progress=self._note)
        except Exception as error:
            self._error = error

    def _note(self, phase: str, fraction: float) -> None:
        self._progress = JobProgress(phase, fraction)


class LayoutTask:
    """Base of layouts; a subclass solves and writes. Reading and writing require Blender's main thread."""

    def __init__(self, time_budget: float) -> None:
        """time_budget: seconds of a solve, 0 for no limit."""
        self._time_budget = time_budget
        self._stopped = ""

    def solve(self, *, cancel: stiv.CancelToken | None = None, progress: Progress | None = None) -> None:
        """Find the layout, without access to Blender. Cancelled or out of time, `write` changes nothing."""
        try:
            self._solve(Watch(cancel, progress, self._time_budget))
        except Stopped as stop:
            self._stopped = str(stop)

    def solve_steps(self) -> Steps[None]:
        """`solve` as a step for a stiv.blender.Task."""
        yield Call(self.solve, partial(LayoutJob, self.solve))

    def write(self) -> LayoutReport:
        """Write the layout and test Blender's evaluation. Raises InputError, with nothing changed."""
        return LayoutReport(self._stopped) if self._stopped else self._write()

    def restore(self) -> None:
        """Restore the scene exactly."""
        raise NotImplementedError

    def _solve(self, watch: Watch) -> None:
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
