# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs entries on a pool of worker processes. If a worker dies, its entry is tried once more."""

from __future__ import annotations

import queue
import time
from collections import deque
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from stiv.batch.records import Record
from stiv.batch.worker_process import WorkerProcess

ATTEMPTS = 2
FAILED_STARTS = 3  # consecutive workers that end before they are ready; then the pool gives up
START_LIMIT = 300.0  # seconds until a worker is ready

Message = tuple[WorkerProcess, dict[str, Any] | None]


class PoolError(RuntimeError):
    """Workers cannot be started."""


class Pool:
    """Runs commands on `size` workers until all are done."""

    def __init__(
        self, size: int, command: Sequence[str], time_limit: float = 0.0, log: Path | None = None, threads: int = 1
    ) -> None:
        """Workers start when there is work, and are replaced when they die.

        command: starts a worker. time_limit: seconds for an entry, 0 for none. log: receives their standard error.
        threads: limit for each worker; STIV_THREADS in the environment takes precedence.
        """
        self._size = size
        self._threads = threads
        self._command = command
        self._limit = time_limit
        self._log = log
        self._messages: queue.Queue[Message] = queue.Queue()
        self._workers: dict[WorkerProcess, float] = {}  # time since each is starting or busy
        self._failed_starts = 0

    def run(
        self,
        names: Sequence[str],
        commands: Sequence[Sequence[str]],
        on_done: Callable[[int, Record], None],
        keep: bool = False,
    ) -> None:
        """Runs every command and calls `on_done` with the number of each. Ends all workers; `keep`: leaves them idle.

        Raises PoolError.
        """
        waiting = deque((number, 1) for number in range(len(commands)))
        attempts: dict[int, int] = {}
        left = len(commands)
        try:
            while left:
                while len(self._workers) < min(self._size, left):
                    self._start()
                for worker in self._workers:
                    if worker.ready and worker.number is None and waiting:
                        number, attempt = waiting.popleft()
                        attempts[number] = attempt
                        worker.send(number, commands[number])
                        self._workers[worker] = time.monotonic()
                worker, reply = self._next_message()
                number_done = worker.number
                record = self._record(worker, reply, names, attempts)
                if record is None or number_done is None:
                    continue
                if record.exit_code is None and attempts[number_done] < ATTEMPTS:
                    waiting.appendleft((number_done, attempts[number_done] + 1))
                    continue
                left -= 1
                on_done(number_done, record)
        except BaseException:
            keep = False
            raise
        finally:
            if not keep:
                self.end()

    def end(self) -> None:
        """Ends all workers."""
        for worker in self._workers:
            worker.kill()
        self._workers.clear()

    def _start(self) -> None:
        worker = WorkerProcess(
            self._command, lambda of, reply: self._messages.put((of, reply)), self._log, self._threads
        )
        self._workers[worker] = time.monotonic()

    def _next_message(self) -> Message:
        while True:
            try:
                message = self._messages.get(timeout=0.5)
            except queue.Empty:
                self._kill_late()
                continue
            if message[0] in self._workers:
                return message

    def _kill_late(self) -> None:
        """Kills workers that exceed a time limit. Their end arrives as a message."""
        for worker, since in self._workers.items():
            limit = START_LIMIT if not worker.ready else self._limit if worker.number is not None else 0.0
            if limit and time.monotonic() - since > limit:
                worker.kill()

    def _record(
        self, worker: WorkerProcess, reply: dict[str, Any] | None, names: Sequence[str], attempts: dict[int, int]
    ) -> Record | None:
        """The record of the entry that a message ends, or None."""
        number = worker.number
        if reply is None:
            since = self._workers.pop(worker)
            self._count_failed_starts(worker)
            if number is None:
                return None
            seconds = time.monotonic() - since
            late = self._limit and seconds > self._limit
            why = f"took longer than {self._limit:g} s" if late else "its worker process died"
            return Record(names[number], None, why, round(seconds, 3), attempts[number])
        if "ready" in reply:
            worker.ready, self._failed_starts = True, 0
            return None
        assert number is not None and reply.pop("number") == number
        worker.number = None
        return Record(names[number], attempts=attempts[number], **reply)

    def _count_failed_starts(self, worker: WorkerProcess) -> None:
        self._failed_starts += not worker.ready
        if self._failed_starts >= FAILED_STARTS:
            where = "" if self._log is None else f"; see {self._log}"
            raise PoolError(f"{FAILED_STARTS} worker processes in a row ended before they were ready{where}")
