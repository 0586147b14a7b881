# SPDX-License-Identifier: GPL-3.0-or-later
"""Tasks: work that calls the core several times, at once in this thread or as jobs beside it."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from contextlib import suppress
from functools import partial
from typing import Any, Generic, TypeVar

from stiv.job import WAIT, Job, JobProgress

Result = TypeVar("Result")


TURN = 0.05  # seconds between two turns of `Turns`


class Left(BaseException):
    """Ends steps whose effects the caller undoes itself; they restore nothing."""


_abandoned: list[Job[Any]] = []  # a job without references would wait for its end


class Call(Generic[Result]):
    """A call of the core that is still to be made: `run(*given)` at once, or `start(*given)` as a job."""

    def __init__(
        self, run: Callable[..., Result], start: Callable[..., Job[Result]], /, *given: Any, **named: Any
    ) -> None:
        self._run, self._start = run, start
        self._given, self._named = given, named

    def run(self, **execution: Any) -> Result:
        """Make the call here; `cancel` and `progress` are those of :meth:`stiv.EditSession.edit`."""
        return self._run(*self._given, **self._named, **execution)

    def start(self) -> Job[Result]:
        """Make the call as a job."""
        return self._start(*self._given, **self._named)


Steps = Generator[Call[Any] | float | None, Any, Result]
"""Work in steps: yields calls and receives their results.

A number is the fraction of all steps that is done. None gives a waiting caller a turn, and receives whether the work is
cancelled.
"""


class Turns:
    """Gives a waiting caller a turn sometimes, in work of many short parts."""

    def __init__(self) -> None:
        self._last = time.perf_counter()

    def take(self) -> Steps[None]:
        """A step, if the last turn was more than `TURN` ago."""
        if time.perf_counter() - self._last > TURN:
            yield None
            self._last = time.perf_counter()


def run(steps: Steps[Result], **execution: Any) -> Result:
    """Make all calls of the steps at once; `cancel` and `progress` are those of :meth:`stiv.EditSession.edit`."""
    resume = _outcome(steps, lambda: None)
    while True:
        try:
            call = resume()
        except StopIteration as end:
            result: Result = end.value
            return result
        resume = _outcome(steps, partial(_run, call, execution))


class Task(Generic[Result]):
    """Work in steps whose calls are jobs; the code between them runs in the thread that calls `advance`.

    A task ends when a step raises: `advance` raises the exception.
    """

    def __init__(self, steps: Steps[Result]) -> None:
        self._steps = steps
        self._resume: Callable[[], Call[Any] | float | None] = partial(next, steps)
        self._job: Job[Any] | None = None
        self._progress = JobProgress()
        self._fraction: float | None = None
        self._done: list[Result] = []
        self._cancelled = False

    @property
    def progress(self) -> JobProgress:
        """The phase of the last job; the fraction that the steps gave, or that of the job."""
        if self._job is not None:
            self._progress = self._job.poll()
        fraction = self._progress.fraction if self._fraction is None else self._fraction
        return JobProgress(self._progress.phase, fraction, bool(self._done))

    @property
    def result(self) -> Result:
        """The result of the steps. Only when done."""
        return self._done[0]

    def start(self) -> None:
        """Take the first step, which starts the first job; its result is left to `advance`."""
        self._step()

    def advance(self, seconds: float = 0.0) -> bool:
        """Continue for about some seconds, or until a step asks for a turn; return whether the task is done."""
        end = time.perf_counter() + seconds
        while not self._done:
            if self._job is not None and not self._job.wait(max(0.0, end - time.perf_counter())):
                return False
            if not self._step():
                return bool(self._done)
        return True

    def cancel(self) -> None:
        """Cancel the present job and all later ones, without waiting; `advance` until the steps have ended."""
        self._cancelled = True
        if self._job is not None:
            self._job.cancel()

    def close(self) -> None:
        """Cancel, wait for the end of the job, which takes milliseconds, and end the steps where they are."""
        self.cancel()
        while self._job is not None and not self._job.wait(WAIT):
            pass
        self._steps.close()

    def abandon(self) -> None:
        """Cancel without waiting: the job ends when it next looks, and the steps end where they are."""
        self._end_without_waiting(self._steps.close)

    def leave(self) -> None:
        """The same for steps whose effects the caller undoes itself: they end by the exception Left."""
        self._end_without_waiting(partial(self._steps.throw, Left()))

    def _end_without_waiting(self, end: Callable[[], object]) -> None:
        self.cancel()
        with suppress(Left):
            end()
        if self._job is not None:
            _abandoned.append(self._job)
        _abandoned[:] = [job for job in _abandoned if not job.poll().done]

    def _step(self) -> bool:
        """Take the next step and start its call; returns whether there is one."""
        self._job, resume = None, self._resume
        self._resume = partial(next, self._steps)  # no reference to itself remains, which would wait for a collection
        try:
            call = resume()
        except StopIteration as end:
            self._done.append(end.value)
            return False
        if not isinstance(call, Call):
            self._resume = lambda: self._steps.send(self._cancelled)
            self._fraction = self._fraction if call is None else call
            return call is not None
        try:
            self._job = job = call.start()
        except Exception as error:
            self._resume = partial(self._steps.throw, error)
            return True
        if self._cancelled:
            job.cancel()
        self._resume = partial(_continue, self._steps, job)
        return True


def _run(call: Call[Any] | float | None, execution: dict[str, Any]) -> Any:
    if isinstance(call, Call):
        return call.run(**execution)
    cancel = execution.get("cancel")
    return cancel is not None and cancel.cancelled


def _continue(steps: Steps[Any], job: Job[Any]) -> Call[Any] | float | None:
    return _outcome(steps, job.result)()


def _outcome(steps: Steps[Any], result: Callable[[], Any]) -> Callable[[], Call[Any] | float | None]:
    """How the steps resume after a call: with its result, or with its exception."""
    try:
        return partial(steps.send, result())
    except BaseException as error:
        return partial(steps.throw, error)
