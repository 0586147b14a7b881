# SPDX-License-Identifier: GPL-3.0-or-later
"""Another add-on left the processor rounding upward, or flushing small numbers to zero: same bits, and it stays so."""

import ctypes
import ctypes.util
import platform
import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from ball_above_wall import session

import stiv

pytestmark = pytest.mark.skipif(
    (platform.system(), platform.machine()) != ("Linux", "x86_64"), reason="sets the registers of x86-64 through glibc"
)

Work = Callable[[], np.ndarray]

UPWARD = 0x4000  # of the control and status register of vector code: round up
FLUSH_TO_ZERO = 0x8040  # results and operands that are denormal count as 0
REGISTER = 28  # its place in glibc's fenv_t, of 32 bytes


def environment() -> bytearray:
    """What glibc's fegetenv gives."""
    saved = ctypes.create_string_buffer(32)
    assert ctypes.CDLL(ctypes.util.find_library("m")).fegetenv(saved) == 0
    return bytearray(saved.raw)


def register() -> int:
    return struct.unpack_from("<I", environment(), REGISTER)[0]


@contextmanager
def processor_mode(bits: int) -> Iterator[None]:
    """The register with these bits set."""
    library, before = ctypes.CDLL(ctypes.util.find_library("m")), environment()
    changed = bytearray(before)
    struct.pack_into("<I", changed, REGISTER, register() | bits)
    assert library.fesetenv(bytes(changed)) == 0
    try:
        yield
    finally:
        library.fesetenv(bytes(before))


def ball_into_wall() -> Work:
    editing = session(threads=2, levels=2, side=30)
    before = editing.controls
    goal = before + (0.02, 0.01, -0.45)

    def drag() -> np.ndarray:
        editing.restore(before)
        result = editing.drag(goal)
        assert result.rounds > 0
        return result.surface

    return drag


def crossing_pairs() -> Work:
    """Of triangles so small that products of their coordinates are denormal."""
    corners = np.random.default_rng(3).random((300, 3)) * 1e-160
    faces = np.arange(300).reshape(-1, 3)
    assert 0 < len(stiv.find_intersections(corners, faces)) < 4950
    return lambda: stiv.find_intersections(corners, faces)


def impacts() -> Work:
    points = np.random.default_rng(4).normal(size=(2, 500, 4, 3))
    assert np.isfinite(stiv.time_of_impact("ee", points[0], points[1], 1e-3)).any()
    return lambda: stiv.time_of_impact("ee", points[0], points[1], 1e-3)


@pytest.mark.parametrize("prepared", [ball_into_wall, crossing_pairs, impacts])
@pytest.mark.parametrize("bits", [UPWARD, FLUSH_TO_ZERO], ids=["upward", "flush to zero"])
def test_a_mode_set_by_others_changes_no_bit_and_stays(bits: int, prepared: Callable[[], Work]) -> None:
    work = prepared()
    expected = work()
    with processor_mode(bits):
        found = work()
        kept = register() & bits
    assert found.tobytes() == expected.tobytes()
    assert kept == bits
