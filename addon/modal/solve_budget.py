# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a solve of a drag may take: about as long as a state takes to be shown."""

BUDGET = 0.038  # seconds of a solve while the mouse moves: a frame of 24 a second, less events and headers
LONG_BUDGET = 0.12  # seconds of a solve that hands over a state: its end would lose what is not accepted yet
HAND_OVER = 0.006  # seconds after which a solve ends with the state that it accepts next, to be shown at once
MAX_BUDGET = 0.15  # seconds of the same if writing and drawing take longer: a solve may then take as long
FINAL_BUDGET = 0.2  # seconds of a solve after the confirmation, which double while they are too few


class SolveBudget:
    """The budget of the next solve, in seconds."""

    def __init__(self) -> None:
        """Nothing is shown yet."""
        self._while_moving = BUDGET

    def take_shown_in(self, seconds: float) -> None:
        """Let the next solve take as long as a state takes to be shown."""
        self._while_moving = min(max(BUDGET, seconds), MAX_BUDGET)

    def of_solve(self, written_in: float, *, hands_over: bool, confirmed: bool) -> tuple[float, float | None]:
        """Budget of a solve, and the time after which it hands over the next state that it accepts; None: never.

        Args:
            written_in: seconds in which the last state was written.
            hands_over: whether the mouse moves, so that a newer state is worth more than a closer one.
            confirmed: whether the drag is confirmed.

        """
        budget = FINAL_BUDGET if confirmed else self._while_moving
        if hands_over:
            return max(budget, LONG_BUDGET), max(HAND_OVER, written_in / 2)
        return budget, None
