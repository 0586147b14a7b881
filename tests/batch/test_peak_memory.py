# SPDX-License-Identifier: GPL-3.0-or-later
"""The peak memory of a process, on Windows too."""

from __future__ import annotations

import ctypes
import sys

import pytest

from stiv.batch.peak_memory import peak_bytes


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
    assert peak_bytes() == 123_456_789


def test_the_peak_memory_is_known_on_this_system() -> None:
    assert peak_bytes() > 5_000_000
