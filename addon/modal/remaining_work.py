# SPDX-License-Identifier: GPL-3.0-or-later
"""The work that remains for a drag: solves for its goal, or refinements of the accepted state."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

from .drag_calls import Goal
from .repeated_solves import RepeatedSolves
from .state import State, same_goal

if TYPE_CHECKING:
    from ..stiv_blender import EditResult


class Refinement(Enum):
    """The next work on a solved drag, while the mouse rests or after the confirmation."""

    SETTLING = "settling"
    CONFIRMING = "confirming"
    """A comparison with the edit from the start, which no solve within a budget makes."""
    NONE = "none"


@dataclass(frozen=True)
class Moment:
    """When a solve ended.

    Attributes:
        state: the latest one, which events may have changed since.
        confirmed: whether the drag is confirmed.
        rests: whether the mouse has not moved for a while.
        stopped: whether Esc stopped the drag after the confirmation.
        is_late: whether only a free motion may continue, which ends at its goal.

    """

    state: State
    confirmed: bool
    rests: bool
    stopped: bool
    is_late: bool

    def ends(self, found: EditResult) -> bool:
        """Whether to keep what the user sees, which obstacles hold. A free motion ends at its goal, however late."""
        meets_obstacles = len(found.events) > 0 or found.counters.get("events", 0) > 0
        return self.is_late and meets_obstacles


class RemainingWork:
    """The next work of a drag, chosen by the results so far.

    Attributes:
        pending: whether the goal is to be solved for.
        unfinished: the goal whose last solve accepted nothing; the next one continues with it.
        refinement: the next work once no goal is pending.
        repeated: the last solves for a goal.

    """

    def __init__(self) -> None:
        """Nothing is left before the first motion; a drag settles even without one."""
        self.pending = False
        self.unfinished: Goal | None = None
        self.refinement = Refinement.SETTLING
        self.repeated = RepeatedSolves()

    def begin(self) -> None:
        """A motion has changed the goal: forget what rest was used for."""
        self.pending, self.refinement = True, Refinement.SETTLING
        self.repeated.begin()

    def confirm(self, result: EditResult | None) -> None:
        """The goal is the position where the mouse was released."""
        self.unfinished = None
        if result is not None and result.status == "budget":
            self.pending = True
            self.repeated.begin_confirmed()

    def stop(self) -> None:
        """Nothing is left."""
        self.pending, self.refinement = False, Refinement.NONE

    def take_solved(self, goal: Goal, found: EditResult, moment: Moment) -> bool:
        """Choose the next work after a solve; returns whether further ones would gain little."""
        nothing_accepted = found.status == "budget" and len(found.path) == 0
        may_gain = self.repeated.may_gain(goal.state, found, moment.confirmed, moment.rests)
        is_late = moment.ends(found)
        is_current = same_goal(goal.state, moment.state)
        self.pending = not moment.stopped and ((may_gain and not is_late) or not is_current)
        continues = is_current or not moment.confirmed  # a solve of an earlier goal may run at the confirmation
        self.unfinished = goal if nothing_accepted and continues else None
        if self.pending:
            return False
        if found.status == "reached":
            self.refinement = Refinement.NONE
            return False
        is_stuck = self.repeated.is_poor or (found.status == "blocked" and self.repeated.fruitless > 0)
        return self._end_settling(is_late=is_late, is_stuck=is_stuck)

    def take_settled(self, settled: EditResult, moment: Moment) -> bool:
        """Choose the next work after settling; returns whether more of it would gain little.

        A solve that used up its budget continues where it was, until it gains no more.
        """
        if settled.status != "budget" or moment.stopped:
            return False
        self.refinement = Refinement.SETTLING
        is_late = moment.ends(settled)
        is_stuck = not is_late and not self.repeated.may_settle(settled, moment.confirmed or moment.rests)
        return self._end_settling(is_late=is_late, is_stuck=is_stuck)

    def _end_settling(self, *, is_late: bool, is_stuck: bool) -> bool:
        """End the solves, if they are stuck, or late: then without a comparison. Returns whether they ended."""
        if is_late or is_stuck:
            self.refinement = Refinement.NONE if is_late else Refinement.CONFIRMING
        return is_late or is_stuck
