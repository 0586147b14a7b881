# SPDX-License-Identifier: GPL-3.0-or-later
"""Time limits of work in several parts, as times of the monotonic clock."""

import time

LEAST_TIME = 1e-3  # seconds of a solve after the deadline: it ends at once, and says so


def deadline_after(seconds: float) -> float:
    """The time of the monotonic clock after some seconds; infinite for 0, no limit."""
    return time.monotonic() + seconds if seconds > 0 else float("inf")


def is_over(deadline: float) -> bool:
    """Has a deadline passed?"""
    return time.monotonic() > deadline


def time_left(deadline: float) -> float:
    """Seconds until a deadline, as the time budget of a solve; 0, no limit, for an infinite one."""
    return 0.0 if deadline == float("inf") else max(deadline - time.monotonic(), LEAST_TIME)
