# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits of 75,592 faces, cancelled from another thread at random moments, leave no trace.

`tests/long/cancelling.py` repeats this 200 times and measures the response times.
"""

import threading

import numpy as np
from ball_above_wall import session

import stiv

SHIFT = (0.02, 0.01, -0.45)


def test_cancelled_edits_leave_the_session_exactly_unchanged():
    chance = np.random.default_rng(5)
    editing, undisturbed = session(), session()
    goal = editing.controls + SHIFT
    controls, surface = editing.controls, editing.surface
    expected = undisturbed.drag(goal)
    duration = expected.timings["total"]
    statuses = [cancelled(editing, goal, chance.uniform(0, duration)) for _ in range(4)]
    statuses.append(editing.drag(goal, cancel=already_cancelled()).status)
    assert "cancelled" in statuses
    editing.restore(controls)
    np.testing.assert_array_equal(editing.surface, surface)
    result = editing.drag(goal)
    assert np.array_equal(result.controls, expected.controls) and result.status == expected.status


def cancelled(editing: stiv.EditSession, goal: np.ndarray, after: float) -> str:
    """The status of a drag cancelled after this many seconds; a drag that ended earlier is undone."""
    controls, surface, token = editing.controls, editing.surface, stiv.CancelToken()
    timer = threading.Timer(after, token.cancel)
    timer.start()
    result = editing.drag(goal, cancel=token)
    timer.cancel()
    if result.status == "cancelled":
        assert np.array_equal(result.controls, controls) and np.array_equal(result.surface, surface)
        assert np.array_equal(editing.controls, controls) and np.array_equal(editing.surface, surface)
    else:
        editing.restore(controls)
    return result.status


def already_cancelled() -> stiv.CancelToken:
    token = stiv.CancelToken()
    token.cancel()
    return token
