# SPDX-License-Identifier: GPL-3.0-or-later
"""The peak memory of this process, also on Windows, which lacks the module `resource`."""

from __future__ import annotations

import ctypes
import sys


def peak_bytes() -> int:
    """The largest resident set, or working set on Windows, so far; 0 if unknown."""
    if sys.platform == "win32":
        return _peak_on_windows()
    import resource

    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


def _peak_on_windows() -> int:
    """The peak of the working set in bytes, from PROCESS_MEMORY_COUNTERS: two 32-bit fields, then nine of 64 bits."""
    kernel = ctypes.CDLL("kernel32")
    kernel.GetCurrentProcess.restype = ctypes.c_void_p
    process = ctypes.c_void_p(kernel.GetCurrentProcess())
    counters = (ctypes.c_uint64 * 9)()
    known = kernel.K32GetProcessMemoryInfo(process, ctypes.byref(counters), ctypes.sizeof(counters))
    return int(counters[1]) if known else 0
