# SPDX-License-Identifier: GPL-3.0-or-later
"""A worker: runs commands that arrive as lines of JSON on standard input, in one process with one Blender.

Replies are lines of JSON on standard output, each after MARK, because Blender writes there too. When standard input
ends, the process that gave the work is gone. The worker then exits at once, even during an entry: outputs are complete
or absent.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import queue
import sys
import threading
import time
from collections.abc import Callable
from typing import Any, TextIO

from stiv.batch.peak_memory import peak_bytes

MARK = "stiv-worker:"
MESSAGE = 2000  # characters of a command's output that a record holds

Run = Callable[[list[str]], int]  # runs `stiv` with these arguments and returns its exit code


def serve(run: Run) -> None:
    """Runs commands until standard input ends."""
    out = sys.stdout
    requests: queue.Queue[dict[str, Any]] = queue.Queue()
    threading.Thread(target=_read_requests, args=(sys.stdin, requests), daemon=True).start()
    _reply(out, {"ready": os.getpid()})
    while True:
        request = requests.get()
        _reply(out, {"number": request["number"], **run_command(run, request["arguments"])})


def run_command(run: Run, arguments: list[str]) -> dict[str, Any]:
    """Runs one command: its exit code, output, seconds and peak memory."""
    said, begin = io.StringIO(), time.perf_counter()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        code = run(arguments)
    return {
        "exit_code": code,
        "message": shortened(said.getvalue().strip()),
        "seconds": round(time.perf_counter() - begin, 3),
        "peak_megabytes": round(peak_bytes() / 1e6, 1),
    }


def shortened(text: str) -> str:
    """The first line and the end of a long text. A command prints its result first and its error last."""
    if len(text) <= MESSAGE:
        return text
    first = text.splitlines()[0][: MESSAGE // 2]
    return f"{first}\n...{text[len(first) + 4 - MESSAGE :]}"


def _read_requests(stream: TextIO, requests: queue.Queue[dict[str, Any]]) -> None:
    for line in stream:
        requests.put(json.loads(line))
    os._exit(0)


def _reply(out: TextIO, message: dict[str, Any]) -> None:
    out.write(f"\n{MARK}{json.dumps(message)}\n")
    out.flush()
