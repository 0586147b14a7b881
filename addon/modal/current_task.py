# SPDX-License-Identifier: GPL-3.0-or-later
"""The task that a drag runs: one at a time, whose result is taken as soon as it ends."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..stiv_blender import Steps, Task


class CurrentTask:
    """Runs steps for some seconds at a time.

    Attributes:
        can_cancel: whether the task refines a state that is accepted, until the next motion.

    """

    def __init__(self, make: Callable[[Steps[Any]], Task[Any]]) -> None:
        """Run nothing yet; `make` makes a task of steps."""
        self.can_cancel = False
        self._make = make
        self._task: Task[Any] | None = None

    @property
    def runs(self) -> bool:
        """Whether there is a task without a result."""
        return self._task is not None

    @property
    def fraction(self) -> float:
        """The fraction of the task that is done; 1 without a task."""
        return self._task.progress.fraction if self._task is not None else 1.0

    def run(
        self, steps: Steps[Any], take: Callable[[Any], None], can_cancel: bool = False, limit: float = math.inf
    ) -> None:
        """Run other steps, and call `take` with their result; limit: seconds, see `cancel_slow`."""
        self._task = self._make(steps)
        self._take, self.can_cancel, self._limit = take, can_cancel, limit
        self.wait_from_now()

    def advance(self, seconds: float) -> bool:
        """Continue for some seconds; returns whether the task is done, and its result taken."""
        assert self._task is not None
        try:
            if not self._task.advance(seconds):
                return False
        except BaseException:
            self._task = None
            raise
        result, self._task = self._task.result, None
        self._take(result)
        return True

    def start(self) -> None:
        """Start the first job of the task, if any, without waiting for it."""
        if self._task is not None:
            self._task.start()

    def cancel(self) -> None:
        """Cancel the task, which then has a result early."""
        if self._task is not None:
            self._task.cancel()

    def wait_from_now(self) -> None:
        """Count the limit of the task from now."""
        self._waited_since = time.perf_counter()

    def cancel_slow(self) -> None:
        """Cancel a task that takes longer than its limit. The accepted state stays."""
        if time.perf_counter() - self._waited_since > self._limit:
            self.cancel()

    def end(self, seconds: float) -> None:
        """Cancel the task and wait for its result, which takes milliseconds, for some seconds at a time."""
        self.cancel()
        while self._task is not None and not self.advance(seconds):
            pass

    def leave(self, waits: bool) -> None:
        """End the task without its result; waits: until its job has ended, which leaves the session to others."""
        if self._task is not None:
            (self._task.close if waits else self._task.abandon)()
        self._task = None
