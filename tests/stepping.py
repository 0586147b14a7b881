# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps by number, so that no test depends on the machine's speed: a moment is a number of steps, not of seconds."""

from __future__ import annotations

from functools import partial
from typing import Any, TypeVar

import stiv
from stiv.task import Call, Steps, Task

Result = TypeVar("Result")


def run_cancelled(steps: Steps[Result], before: int) -> tuple[Result, int]:
    """Make all calls of the steps here, cancelled from this number on; returns the result and the number of steps.

    A cancelled call may raise CancelledError, which the steps receive.
    """
    token, number = stiv.CancelToken(), 0
    resume = partial(next, steps)
    while True:
        if number == before:
            token.cancel()
        try:
            step = resume()
        except StopIteration as end:
            return end.value, number
        number += 1
        try:
            answer = step.run(cancel=token) if isinstance(step, Call) else token.cancelled
            resume = partial(steps.send, answer)
        except BaseException as error:
            resume = partial(steps.throw, error)


def take_steps(task: Task[Any], count: int) -> bool:
    """Take this many steps of a task, each after the end of the job before; returns whether the task is done."""
    for _ in range(count):
        if task._done:
            break
        while task._job is not None and not task._job.wait(1.0):
            pass
        task._step()
    return bool(task._done)
