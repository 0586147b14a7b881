# SPDX-License-Identifier: GPL-3.0-or-later
import itertools
from dataclasses import replace

import pytest

from stiv_addon.modal.axis_lock import AxisLock

LOCKS = [AxisLock(axis, plane) for axis in range(3) for plane in (False, True)]


def test_without_a_lock_every_axis_is_free() -> None:
    assert AxisLock().axes == (0, 1, 2)
    assert AxisLock().label == ""


@pytest.mark.parametrize("lock", LOCKS)
def test_an_axis_leaves_itself_and_a_plane_the_others(lock: AxisLock) -> None:
    assert set(lock.axes) == ({0, 1, 2} - {lock.axis} if lock.plane else {lock.axis})
    assert lock.label == "".join("XYZ"[axis] for axis in lock.axes)


@pytest.mark.parametrize(("before", "wanted"), list(itertools.product([AxisLock(), *LOCKS], LOCKS)))
def test_another_lock_replaces(before: AxisLock, wanted: AxisLock) -> None:
    after = before.toggled(wanted.axis, plane=wanted.plane)
    assert after == (replace(wanted, second=True) if before == wanted else wanted)


@pytest.mark.parametrize("lock", LOCKS)
def test_the_same_key_switches_to_other_axes_and_then_unlocks(lock: AxisLock) -> None:
    again = lock.toggled(lock.axis, plane=lock.plane)
    assert again == replace(lock, second=True) and again.axes == lock.axes
    assert again.toggled(lock.axis, plane=lock.plane) == AxisLock()
