# SPDX-License-Identifier: GPL-3.0-or-later
"""The calls of a session since its state was last written, and the states that it accepted."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import stiv
from stiv.blender.scene.arrays import Floats


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
    failed, stride = len(states), 1
    while failed > 0:
        index = max(0, failed - stride)
        if holds(states[index]):
            return _between(states, index, failed, holds)
        failed, stride = index, 2 * stride
    return None


def _between(
    states: Sequence[AcceptedState], held: int, failed: int, holds: Callable[[AcceptedState], bool]
) -> AcceptedState:
    while failed - held > 1:
        middle = (held + failed) // 2
        if holds(states[middle]):
            held = middle
        else:
            failed = middle
    return states[held]
