# SPDX-License-Identifier: GPL-3.0-or-later
"""The memory of this process, and its growth between two windows of samples. Needs /proc and glibc 2.33."""

from __future__ import annotations

import ctypes
import gc
import os
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

WINDOW = 9  # samples in each window


@dataclass
class Memory:
    """Bytes after this many drags: resident, resident without the allocator's free pages, and allocated."""

    drags: int
    resident: int
    used: int
    allocated: int


class AllocatorState(ctypes.Structure):
    """The result of mallinfo2, in the order of malloc.h."""

    _fields_ = (
        *((name, ctypes.c_size_t) for name in ("arena", "ordblks", "smblks", "hblks")),
        *((name, ctypes.c_size_t) for name in ("hblkhd", "usmblks", "fsmblks", "uordblks", "fordblks", "keepcost")),
    )


def memory_after(drags: int) -> Memory:
    """Memory in use after a garbage collection. It returns no page to the system."""
    gc.collect()
    allocator = ctypes.CDLL(None)
    allocator.mallinfo2.restype = AllocatorState
    state, whole = allocator.mallinfo2(), resident()
    return Memory(drags, whole, whole - free_pages(), state.uordblks + state.hblkhd)


def resident() -> int:
    """Resident bytes of the process."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE")


def free_pages() -> int:
    """Resident bytes in pages that the allocator could return.

    A child process returns them, so that this process continues like one that nobody measures.
    """
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        before = _anonymous()
        ctypes.CDLL(None).malloc_trim(0)
        os.write(writer, struct.pack("q", before - _anonymous()))
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader, "rb") as answer:
        (freed,) = struct.unpack("q", answer.read())
    os.waitpid(child, 0)
    return int(freed)


def _anonymous() -> int:
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(1024 * int(line.split()[1]) for line in lines if line.startswith("RssAnon:"))


def medians(samples: Sequence[Memory]) -> Memory:
    """The median of each kind of memory, and of the drags."""
    return Memory(*(int(median(values)) for values in zip(*(vars(each).values() for each in samples), strict=True)))


def growth(first: Memory, last: Memory, kind: str) -> float:
    """Relative growth of one kind of memory."""
    return float(getattr(last, kind) / getattr(first, kind) - 1)
