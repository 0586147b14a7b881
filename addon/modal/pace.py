# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a solve of a drag may take, so that a tick with all that it shows keeps the time of a frame."""

from __future__ import annotations

FRAME = 1.0 / 24.0  # seconds of a tick, where solving is left half of it or more
LONGEST_FRAME = 1.0 / 12.0  # in scenes so large that showing takes longer
RESERVE = 0.003  # seconds of a tick that nobody measures: events, headers, handing over
FORGETTING = 0.8  # of the cost that is remembered is kept at each tick that cost less


class Pace:
    """Shares a tick between solving and the rest (writing, Blender's evaluation, reading back, testing)."""

    def __init__(self) -> None:
        """Nothing has been measured yet: half of a frame is left for showing."""
        self._cost = FRAME / 2

    @property
    def budget(self) -> float:
        """Seconds that the next solve may take. Solving and showing have equal parts of a frame that is too short."""
        frame = min(max(FRAME, 2 * self._cost), LONGEST_FRAME)
        return max(frame - self._cost, frame / 4) - RESERVE

    def note(self, showing: float) -> None:
        """A tick showed a state, in so many seconds without solving. The dearest of the last ones count."""
        self._cost = max(showing, FORGETTING * self._cost)
