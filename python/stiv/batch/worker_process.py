# SPDX-License-Identifier: GPL-3.0-or-later
"""The owner's side of a worker process: sends commands and receives replies."""

from __future__ import annotations

import json
import os
import subprocess
import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from stiv.batch.worker import MARK

PACKAGES = Path(__file__).absolute().parents[2]

Listener = Callable[["WorkerProcess", dict[str, Any] | None], None]


class WorkerProcess:
    """Attributes: `ready`, and `number` of the current entry, or None."""

    def __init__(self, command: Sequence[str], listen: Listener, log: Path | None = None, threads: int = 1) -> None:
        """Start it. Another thread calls `listen` with each reply, and with None at the end of the process.

        threads: limit for its edits, unless STIV_THREADS in the environment sets another.
        """
        paths = [str(PACKAGES), *filter(None, [os.environ.get("PYTHONPATH")])]
        errors = subprocess.DEVNULL if log is None else log.open("ab")
        self.ready = False
        self.number: int | None = None
        self._process = subprocess.Popen(
            list(command), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors, encoding="utf-8",
            errors="replace", env={"STIV_THREADS": str(threads), **os.environ, "PYTHONIOENCODING": "utf-8",
                                   "PYTHONPATH": os.pathsep.join(paths)},
        )  # fmt: skip
        if not isinstance(errors, int):
            errors.close()
        threading.Thread(target=self._listen, args=(listen,), daemon=True).start()

    @property
    def pid(self) -> int:
        """Id of the process."""
        return self._process.pid

    def send(self, number: int, arguments: Sequence[str]) -> None:
        """Send an entry. If the worker is already dead, `listen` is called with None."""
        self.number = number
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(json.dumps({"number": number, "arguments": list(arguments)}) + "\n")
            self._process.stdin.flush()
        except OSError:
            pass

    def kill(self) -> None:
        """Kill it, and wait until it has ended."""
        self._process.kill()
        self._process.wait()

    def _listen(self, listen: Listener) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            if line.startswith(MARK):
                listen(self, json.loads(line.removeprefix(MARK)))
        self._process.wait()
        listen(self, None)
