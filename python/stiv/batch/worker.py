# SPDX-License-Identifier: GPL-3.0-or-later
"""A worker: runs commands that come as lines of JSON on standard input, one Blender for all of them.

Replies are lines of JSON on standard output, each after MARK, since Blender writes there too. When standard input
ends, whoever gave the work is gone, and the worker ends at once, in the middle of an entry too: outputs are whole or
not there.
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
from typing import Any, TextIO

MARK = "stiv-worker:"
MESSAGE = 2000  # most characters kept of what a command said


def main() -> None:
    """Serves until standard input ends."""
    out = sys.stdout
    requests: queue.Queue[dict[str, Any]] = queue.Queue()
    threading.Thread(target=_read_requests, args=(sys.stdin, requests), daemon=True).start()
    _reply(out, {"ready": os.getpid()})
    while True:
        request = requests.get()
        _reply(out, {"number": request["number"], **run_command(request["arguments"])})


def run_command(arguments: list[str]) -> dict[str, Any]:
    """Runs `stiv` with these arguments in this process: exit code, what it said, seconds and peak memory."""
    from stiv.command_line import program

    said, begin = io.StringIO(), time.perf_counter()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        code = program.run(arguments)
    return {
        "code": code,
        "message": shortened(said.getvalue().strip()),
        "seconds": round(time.perf_counter() - begin, 3),
        "peak_megabytes": _peak_megabytes(),
    }


def shortened(text: str) -> str:
    """The first line and the last characters of a long text; a command's result comes first, its error last."""
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


def _peak_megabytes() -> float:
    try:
        import resource
    except ImportError:  # not a POSIX system
        return 0.0
    unit = 1 if sys.platform == "darwin" else 1024
    return round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6, 1)


if __name__ == "__main__":
    main()
