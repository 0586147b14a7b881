# SPDX-License-Identifier: GPL-3.0-or-later
"""The calls of a drag, and the goal that it solves for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .request import Request
from .state import State

if TYPE_CHECKING:
    from ..stiv_blender import Edit, EditResult, Motion, Steps, Task
    from ..transform import Transform


@dataclass(frozen=True)
class Goal:
    """The goal of a solve: a state, its transform, and the motion that an edit takes."""

    state: State
    transform: Transform
    motion: Motion


@dataclass(frozen=True)
class DragCalls:
    """The calls of a drag.

    Attributes:
        begin: steps that begin an edit of the current scene; called again when the state requests another one.
        transform_of: the transform that a state requests.
        motion_of: the motion that an edit takes for a transform and a state.
        apply: steps of an edit that applies typed values as a script would, from the start.
        task: makes a task of steps.

    """

    begin: Callable[[Request], Steps[Edit]]
    transform_of: Callable[[State], Transform]
    motion_of: Callable[[Transform, State], Motion]
    apply: Callable[[Transform, State], Steps[tuple[Edit, EditResult]]]
    task: Callable[[Steps[Any]], Task[Any]]

    def goal(self, state: State) -> Goal:
        """The goal that a state requests. Raises ValueError if its values are rejected."""
        transform = self.transform_of(state)
        return Goal(state, transform, self.motion_of(transform, state))


def with_rejection(steps: Steps[Any]) -> Steps[Any]:
    """Steps whose result may be the ValueError that ended them."""
    try:
        return (yield from steps)
    except ValueError as error:
        return error
