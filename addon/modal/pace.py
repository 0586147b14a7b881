# SPDX-License-Identifier: GPL-3.0-or-later
"""How ticks of a drag keep the time of a frame: how long a solve may take, and whether its state is shown at once."""

from __future__ import annotations

FRAME = 1.0 / 24.0  # seconds of a tick
RESERVE = 0.003  # seconds of it that nobody measures: events, headers, handing over
LITTLE = 0.001  # seconds of a tick that solved nothing: it shows, however long that takes


class Pace:
    """Shares ticks between solving and showing (writing, Blender's evaluation, reading back, testing)."""

    budget = FRAME - RESERVE
    """Seconds that a solve may take."""

    def __init__(self) -> None:
        """Nothing has been measured yet: showing is expected to take half of a frame."""
        self._cost = FRAME / 2

    def has_time_to_show(self, spent: float) -> bool:
        """After so many seconds of a tick; otherwise the next one does nothing else."""
        return spent < LITTLE or spent + self._cost <= FRAME

    def note(self, showing: float) -> None:
        """Showing took so many seconds. The last ones count, the very last for half."""
        self._cost = (self._cost + showing) / 2
