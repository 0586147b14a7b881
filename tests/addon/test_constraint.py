# SPDX-License-Identifier: GPL-3.0-or-later
import itertools

import pytest

from stiv_addon.modal.constraint import Constraint

LOCKS = [Constraint(axis, plane) for axis in range(3) for plane in (False, True)]


def test_free_leaves_every_axis() -> None:
    assert Constraint().axes == (0, 1, 2)
    assert Constraint().label == ""


@pytest.mark.parametrize("lock", LOCKS)
def test_an_axis_leaves_itself_and_a_plane_the_others(lock: Constraint) -> None:
    assert set(lock.axes) == ({0, 1, 2} - {lock.axis} if lock.plane else {lock.axis})
    assert lock.label == "".join("XYZ"[axis] for axis in lock.axes)


@pytest.mark.parametrize(("before", "wanted"), list(itertools.product([Constraint(), *LOCKS], LOCKS)))
def test_toggling_replaces_and_the_same_lock_lets_go(before: Constraint, wanted: Constraint) -> None:
    after = before.toggled(wanted.axis, plane=wanted.plane)
    assert after == (Constraint() if before == wanted else wanted)
