# SPDX-License-Identifier: GPL-3.0-or-later
"""The lock of a job and the peak memory of a worker on Windows, with stand-ins for its libraries."""

from __future__ import annotations

import ctypes
import sys
import types
from pathlib import Path

import pytest

from stiv import InputError
from stiv.batch import run, worker


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
