# SPDX-License-Identifier: GPL-3.0-or-later
"""Rounding modes set by other code do not change results; coordinates out of range are refused."""

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

UPWARD = 0x4000  # control and status register of SSE: round up
FLUSH_TO_ZERO = 0x8040  # denormal results and operands become 0
REGISTER = 28  # its offset in the 32 bytes of glibc's fenv_t


def environment() -> bytearray:
    """The result of glibc's fegetenv."""
    saved = ctypes.create_string_buffer(32)
    assert ctypes.CDLL(ctypes.util.find_library("m")).fegetenv(saved) == 0
    return bytearray(saved.raw)


def register() -> int:
    return struct.unpack_from("<I", environment(), REGISTER)[0]


@contextmanager
def processor_mode(bits: int) -> Iterator[None]:
    """Set these bits of the register within the scope."""
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
    """Pairs of triangles so small that their boxes have denormal sides in single precision."""
    corners = np.random.default_rng(3).random((300, 3)) * 1e-40
    faces = np.arange(300).reshape(-1, 3)
    assert 0 < len(stiv.find_intersections(corners, faces)) < 4950
    return lambda: stiv.find_intersections(corners, faces)


def impacts() -> Work:
    points = np.random.default_rng(4).normal(size=(2, 500, 4, 3))
    assert np.isfinite(stiv.time_of_impact("ee", points[0], points[1], 1e-3)).any()
    return lambda: stiv.time_of_impact("ee", points[0], points[1], 1e-3)


@pytest.mark.parametrize("prepared", [ball_into_wall, crossing_pairs, impacts])
@pytest.mark.parametrize("bits", [UPWARD, FLUSH_TO_ZERO], ids=["upward", "flush to zero"])
def test_a_mode_set_by_other_code_changes_no_bit_and_persists(bits: int, prepared: Callable[[], Work]) -> None:
    work = prepared()
    expected = work()
    with processor_mode(bits):
        found = work()
        kept = register() & bits
    assert found.tobytes() == expected.tobytes()
    assert kept == bits


@pytest.mark.parametrize(("coordinate", "fault"), [(0.9e-70, "below 1e-70"), (-1.1e70, "above 1e70"), (1e-320, "")])
def test_coordinates_out_of_range_are_refused_by_row(coordinate: float, fault: str) -> None:
    corners = np.random.default_rng(5).random((6, 3))
    faces, beyond = np.arange(6).reshape(-1, 3), corners.copy()
    beyond[4, 1] = coordinate
    for refuse in (
        lambda: stiv.find_intersections(beyond, faces),
        lambda: stiv.least_distance(beyond, faces, within=True),
        lambda: stiv.find_interference(faces, corners, beyond),
    ):
        with pytest.raises(stiv.InputError, match=f"vertex 4: coordinate is {fault}"):
            refuse()
    with pytest.raises(stiv.InputError, match=f"end, row 1: coordinate is {fault}"):
        stiv.time_of_impact("vf", corners[[[0, 1, 2, 3], [1, 2, 3, 4]]], beyond[[[0, 1, 2, 3], [1, 2, 3, 4]]])


def test_coordinates_that_weights_make_too_small_become_0() -> None:
    weights = np.array([[1, 0], [1, 0], [1, 0], [1, 1e-90]])
    deformation = stiv.linear(weights, np.array([[1, 0, 0], [0, 1, 0], [1, 1, 0], [2, 2, 0.0]]))
    controls = np.zeros((2, 3))
    surface = stiv.Surface(np.array([[0, 1, 2], [1, 3, 2]]), 4)
    session = stiv.EditSession(surface, deformation, controls)
    result = session.edit(np.array([[0, 0, 0], [0, 0, 1.0]]))
    assert result.status == "reached"
    assert deformation.surface(result.controls)[3, 2] == 1e-90
    assert result.surface[3, 2] == 0
