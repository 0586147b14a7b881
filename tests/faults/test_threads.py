# SPDX-License-Identifier: GPL-3.0-or-later
"""Sessions in several threads give their serial results, and a session accepts one call at a time."""

import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from ball_above_wall import session

import stiv

SHIFTS = [(0.1 * k, -0.05 * k, -0.7) for k in range(4)]


def solved(shift: tuple[float, ...]) -> list[np.ndarray]:
    editing = session(threads=2, levels=2, side=40)
    goal = editing.controls + shift
    return [editing.drag(goal).controls, editing.settle().controls, editing.edit(goal + (0.2, 0, 0)).controls]


def test_four_parallel_sessions_equal_serial_ones_exactly():
    serial = [solved(shift) for shift in SHIFTS]
    with ThreadPoolExecutor(len(SHIFTS)) as pool:
        at_once = list(pool.map(solved, SHIFTS))
    for one, other in zip(serial, at_once, strict=True):
        assert all(np.array_equal(a, b) for a, b in zip(one, other, strict=True))
    assert any((a != b).any() for a, b in zip(serial[0], serial[1], strict=True))


def test_a_second_call_on_a_session_in_use_is_refused():
    editing = session(levels=2, side=40)
    goal = editing.controls + SHIFTS[0]
    reached, may_return, refused = threading.Event(), threading.Event(), []

    def hold(phase: str, fraction: float) -> None:
        reached.set()
        may_return.wait(30)

    solving = threading.Thread(target=lambda: editing.drag(goal, progress=hold))
    solving.start()
    assert reached.wait(30)
    try:
        editing.settle()
    except (RuntimeError, stiv.InputError) as error:
        refused.append(str(error))
    may_return.set()
    solving.join()
    assert refused and "use" in refused[0]
    assert len(stiv.find_intersections(editing.surface, session(levels=2, side=40)._topology)) == 0


def test_an_exception_in_progress_cancels_and_propagates():
    editing = session(levels=2, side=40)
    before = editing.controls

    def fail(phase: str, fraction: float) -> None:
        raise ZeroDivisionError("of the caller")

    with pytest.raises(ZeroDivisionError, match="of the caller"):
        editing.drag(before + SHIFTS[0], progress=fail)
    assert np.array_equal(editing.controls, before)
