# SPDX-License-Identifier: GPL-3.0-or-later
"""The lock of a job, the peak memory of a worker, and signals that end a batch, on Windows too."""

from __future__ import annotations

import ctypes
import signal
import sys
import types
from pathlib import Path

import pytest

from stiv import InputError
from stiv.batch import run, worker
from stiv.command_line import batch, program
from tests.batch.jobs import write_job


def test_the_lock_of_a_job_on_windows_is_that_of_its_c_runtime(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    locked: list[tuple[int, int]] = []

    def locking(_: int, mode: int, count: int) -> None:
        if locked:
            raise PermissionError(13, "Permission denied")
        locked.append((mode, count))

    monkeypatch.setitem(sys.modules, "msvcrt", types.SimpleNamespace(LK_NBLCK=2, locking=locking))
    monkeypatch.setattr(sys, "platform", "win32")
    with run._locked(tmp_path, "lock"):
        assert locked == [(2, 1)]
        with pytest.raises(InputError, match="another process is running this job"), run._locked(tmp_path, "lock"):
            pass


def test_the_peak_memory_on_windows_is_that_of_the_working_set(monkeypatch: pytest.MonkeyPatch) -> None:
    class Kernel:
        GetCurrentProcess = staticmethod(lambda: 7)

        @staticmethod
        def K32GetProcessMemoryInfo(process: ctypes.c_void_p, counters: object, size: int) -> int:  # noqa: N802
            assert (process.value, size) == (7, 72)
            # size and page faults, then the peak of the working set
            ctypes.memmove(counters, bytes(8) + (123_456_789).to_bytes(8, "little") + bytes(56), size)
            return 1

    monkeypatch.setattr(ctypes, "CDLL", lambda name: Kernel() if name == "kernel32" else None)
    monkeypatch.setattr(sys, "platform", "win32")
    assert worker._peak_megabytes() == 123.5


def test_the_peak_memory_is_known_on_this_system() -> None:
    assert worker._peak_megabytes() > 5


@pytest.mark.parametrize("name", sorted({"SIGINT", "SIGTERM", "SIGBREAK"} & set(dir(signal))))
def test_a_signal_of_the_system_cancels_a_batch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    signals = [signal.Signals[each] for each in ("SIGINT", "SIGTERM", name)]
    handlers = {each: signal.getsignal(each) for each in signals}
    monkeypatch.setattr(batch, "run_job", lambda *_: signal.raise_signal(signal.Signals[name]))
    signal.signal(signal.SIGINT, signal.default_int_handler)  # Python ignores it where a shell started it with "&"
    try:
        assert program.run(["batch", str(write_job(tmp_path, 1)), "--workers", "1"]) == 5
    finally:
        for each, handler in handlers.items():
            signal.signal(each, handler)
