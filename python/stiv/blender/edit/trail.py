# SPDX-License-Identifier: GPL-3.0-or-later
"""The calls of a session since its state was last written, and the states that it accepted."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import stiv
from stiv.blender.scene.arrays import Floats
from stiv.deadlines import is_over
from stiv.task import Steps, run


@dataclass(frozen=True)
class SolverCall:
    """One call of a session, a drag to a goal, or settling or confirming (None), with its result."""

    goal: Floats | None
    result: stiv.EditResult
    path: tuple[Floats, ...]
    """Accepted controls: all of the result's path, or the first of them."""


@dataclass(frozen=True)
class AcceptedState:
    """Accepted controls, by number of the call (-1 for the last written state) and step within the call."""

    controls: Floats
    call: int
    step: int


@dataclass
class Trail:
    """All calls since the last written state, and the goal before them."""

    written: Floats
    goal: Floats
    calls: list[SolverCall] = field(default_factory=list)

    def add(self, goal: Floats | None, result: stiv.EditResult) -> None:
        """Append a call."""
        self.calls.append(SolverCall(goal, result, tuple(result.path)))

    def states(self) -> list[AcceptedState]:
        """All accepted states, oldest first; the linear step between consecutive states is free of intersections."""
        return [AcceptedState(self.written, -1, 0)] + [
            AcceptedState(controls, number, step)
            for number, call in enumerate(self.calls)
            for step, controls in enumerate(call.path)
        ]

    def goal_at(self, state: AcceptedState) -> Floats:
        """The goal when the state was accepted."""
        goals = [call.goal for call in self.calls[: state.call + 1] if call.goal is not None]
        return goals[-1] if goals else self.goal

    def truncate_at(self, state: AcceptedState) -> list[SolverCall]:
        """Truncate the trail at a state; returns the calls after it, including the interrupted one."""
        if state.call < 0:
            left, self.calls = self.calls, []
            return left
        left = self.calls[state.call :]
        self.calls = [
            *self.calls[: state.call],
            SolverCall(left[0].goal, left[0].result, left[0].path[: state.step + 1]),
        ]
        return left


def find_latest(states: Sequence[AcceptedState], holds: Callable[[AcceptedState], bool]) -> AcceptedState | None:
    """Find the last state with a property that held at the start, with few evaluations of it.

    Searches backwards with doubling strides, then bisects. The property holds for the result, and may hold for
    later states. Returns None if it holds for no examined state.
    """
    return run(find_latest_steps(states, holds))


def find_latest_steps(
    states: Sequence[AcceptedState], holds: Callable[[AcceptedState], bool], end: float = float("inf")
) -> Steps[AcceptedState | None]:
    """Steps of `find_latest`, one for each evaluation.

    After the deadline `end`, or cancelled, they evaluate no state but the first one, and only if none held.
    """
    failed, stride = len(states), 1
    while failed > 0:
        index = max(0, failed - stride)
        if holds(states[index]):
            return (yield from _between(states, index, failed, holds, end))
        failed, stride = index, 2 * stride
        if (yield from is_late(end)):
            stride = failed
    return None


def _between(
    states: Sequence[AcceptedState], held: int, failed: int, holds: Callable[[AcceptedState], bool], end: float
) -> Steps[AcceptedState]:
    while failed - held > 1 and not (yield from is_late(end)):
        middle = (held + failed) // 2
        if holds(states[middle]):
            held = middle
        else:
            failed = middle
    return states[held]


def is_late(end: float) -> Steps[bool]:
    """A step that gives a waiting caller a turn; returns whether the work is cancelled, or its deadline has passed."""
    cancelled = yield None
    return bool(cancelled) or is_over(end)
