# SPDX-License-Identifier: GPL-3.0-or-later
"""How ticks of a drag stay within the time of a frame: the budget of a solve, and when its state is written."""

from __future__ import annotations

FRAME = 1.0 / 24.0  # seconds of a tick
RESERVE = 0.003  # seconds of a tick that are not measured: events and headers
IDLE = 0.001  # seconds below which a tick solved nothing: it writes, however long that takes


class Pace:
    """Divides ticks between solving and writing (with Blender's evaluation, reading back and testing)."""

    budget = FRAME - RESERVE
    """Seconds that a solve may take."""

    def __init__(self) -> None:
        """Before the first measurement, writing is expected to take half of a frame."""
        self._cost = FRAME / 2

    def has_time_to_write(self, spent: float) -> bool:
        """Whether a tick can also write after `spent` seconds; otherwise the next tick only writes."""
        return spent < IDLE or spent + self._cost <= FRAME

    def note(self, seconds: float) -> None:
        """Record that writing took this long; the expected cost is a running mean that halves old values."""
        self._cost = (self._cost + seconds) / 2
