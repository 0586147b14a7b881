# SPDX-License-Identifier: GPL-3.0-or-later
"""Jobs: calls of the core on a thread of their own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from stiv import _native
from stiv._native import CancelledError

__all__ = ["CancelledError", "Job", "JobProgress"]

Result = TypeVar("Result")
WAIT = 0.05  # seconds between two looks at keyboard interrupts


@dataclass(frozen=True)
class JobProgress:
    """The progress of a job."""

    phase: str = ""
    fraction: float = 0.0  #: of the phase, in [0, 1]
    done: bool = False  #: there is a result, or an error


class Job(Generic[Result]):
    """A call of the core on a thread of its own, started by a function whose name begins with ``start``.

    The result has the same bits as that of the synchronous call. The job's thread touches no Python objects. Until
    the job is done, other calls of its session raise InputError. A job without references is cancelled.

    A function given to :func:`stiv.observed` runs in the thread that calls `poll`, `wait` or `result`. `poll` makes one
    call that the job waits for, the others all that come. Its exceptions are raised by `result`.
    """

    def __init__(self, native: _native.Job, translate: Callable[[Any], Result]) -> None:
        self._native = native
        self._translate = translate
        self._result: list[Result] = []

    def poll(self) -> JobProgress:
        """Return the progress, without waiting for the job."""
        return JobProgress(*self._native.poll())

    def cancel(self) -> None:
        """Ask the job to stop, which takes milliseconds; does not wait. Afterwards, :meth:`result` returns at once.

        A cancelled edit returns the status "cancelled", and the session keeps the state before the call.
        """
        self._native.cancel()

    def wait(self, seconds: float) -> bool:
        """Wait until the job is done, at most some seconds; return whether it is."""
        return self._native.wait_for(seconds)

    def result(self) -> Result:
        """Wait for the result and return it.

        Raises:
            CancelledError: the job was cancelled, and has no result.
            Exception: whatever the synchronous call raises.
        """
        while not self.wait(WAIT):  # keyboard interrupts are handled in between
            pass
        if not self._result:
            self._result.append(self._translate(self._native.result()))
        return self._result[0]
