# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether another solve for the same goal pays, judged by the gains of the last ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .state import State, same_goal

if TYPE_CHECKING:
    from ..stiv_blender import EditResult

DOUBLINGS = 4  # of a budget that ends before a state is accepted, at most; of an unfinished goal, fewer
DOUBLINGS_UNFINISHED = 2
MAX_HIDDEN = 3  # solves for a goal that accept nothing before the header says so
GAIN = 0.99  # fraction of the energy: a repeated solve that leaves more of it has gained nothing
POOR_GAIN = 0.9999  # the same for a poor solve, which ends a drag at rest: deep in a wall, a slide gains little
MAX_SLOW = 6  # solves that use up their budget and gain little; then a drag waits for the next motion
MAX_IDLE = 10  # settling solves that accept nothing, each from where the last one was; then a drag ends
MAX_FRUITLESS = 20  # solves that use up their budget and accept nothing; then the goal is given up


class RepeatedSolves:
    """The last solves for a goal.

    Attributes:
        fruitless: number of consecutive solves that came no closer.
        is_poor: whether the last one hardly came closer, while the mouse rests or after the confirmation.

    """

    def __init__(self) -> None:
        """Start without solves."""
        self._solved: tuple[State | None, float] = (None, 0.0)  # the goal, and the energy of its last gain
        self._energy = 0.0  # of the last solve
        self.begin()

    def begin(self) -> None:
        """Forget the solves before a motion."""
        self.begin_confirmed()
        self._idle = 0
        self.is_poor = False

    def begin_confirmed(self) -> None:
        """Forget fruitless solves before the confirmation: the next ones have larger budgets."""
        self.fruitless = self._empty = 0

    @property
    def are_hidden(self) -> bool:
        """Whether the first solves accepted nothing, which the header does not say yet."""
        return 0 < self._empty <= MAX_HIDDEN

    def doublings(self, is_new: bool) -> int:
        """How often the budget of the next solve doubles; is_new: the goal is not that of an unfinished solve."""
        return min(self._empty, DOUBLINGS if is_new else DOUBLINGS_UNFINISHED)

    def may_gain(self, state: State, result: EditResult, confirmed: bool, rests: bool) -> bool:
        """Whether another solve for the same state may come closer: one solve goes only a limited way to a far goal.

        While the mouse rests, this makes the final state independent of the number of motions before it.
        """
        accepts_nothing = len(result.path) == 0
        self._empty = self._empty + 1 if result.status == "budget" and accepts_nothing else 0
        gained = self._has_gained(state, result, confirmed or rests)
        self.fruitless = 0 if gained else self.fruitless + 1
        if result.status == "budget":
            most = MAX_FRUITLESS if confirmed or accepts_nothing else MAX_SLOW
            return self.fruitless < most and not self.is_poor
        return result.status == "corrected" and gained

    def may_settle(self, settled: EditResult, waits: bool) -> bool:
        """Whether settling that used up its budget may come closer; waits: nothing moves the goal."""
        gained = self._has_gained(self._solved[0], settled, waits)
        self._idle = 0 if gained else self._idle + 1
        return self._idle < MAX_IDLE and not self.is_poor

    def _has_gained(self, state: State | None, result: EditResult, waits: bool) -> bool:
        """Whether a solve came closer to its goal."""
        solved, least = self._solved
        is_new, before = not same_goal(solved, state), self._energy
        gained = is_new or result.energy < GAIN * least
        if gained:
            self._solved = (state, result.energy)
        self._energy = result.energy
        self.is_poor = not is_new and waits and len(result.path) > 0 and result.energy >= POOR_GAIN * before
        return gained
