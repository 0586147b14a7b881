# SPDX-License-Identifier: GPL-3.0-or-later
"""The guard's state machine: from an observation of Blender to an action, without bpy."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

QUIET_TIME = 1.0  # seconds without a change after which a change without an undo step is complete
POLL_INTERVAL = 0.05  # seconds between two observations while waiting

UndoStep = tuple[int, str, str]
"""Index, address and name of a step: all three, since replacing a step preserves index and name."""


class Action(Enum):
    """The action that is due."""

    REST = "rest"
    """None until the next change."""
    WAIT = "wait"
    """Observe again soon."""
    ACCEPT = "accept"
    """Test the current scene; if it is clear, it becomes the accepted state. Writes nothing."""
    REPLACE = "replace"
    """Correct, and store the correction in the tool's undo step."""
    PUSH = "push"
    """Correct, and add an undo step, since the change made none."""
    WRITE = "write"
    """Test, and correct only if the scene is not clear, without changing the undo stack."""


@dataclass(frozen=True)
class Observation:
    """Blender at one moment.

    Attributes:
        time: seconds of any clock.
        busy: a tool or an animation runs.
        changed: controls or surfaces may differ from the accepted state.
        updates: number of changes of the scene since the guard was turned on.
        step: the active undo step; None if it cannot be determined.
        sculpting: an object is in Sculpt Mode, where undo steps cannot be replaced.
        own_edit: one of STIV's own operators wrote the current state.
        frame_changed: the scene is at another frame than the accepted state.
    """

    time: float
    busy: bool = False
    changed: bool = True
    updates: int = 0
    step: UndoStep | None = None
    sculpting: bool = False
    own_edit: bool = False
    frame_changed: bool = False


@dataclass(frozen=True)
class Guard:
    """The guard's memory between two observations.

    Attributes:
        has_accepted: there is an accepted state.
        step: the undo step that was active when the scene was settled last.
        history: undo or redo ran since then.
        restored: the step that undo or redo restored.
        quiet: number of updates, and the time since it has been that number.
    """

    has_accepted: bool = False
    step: UndoStep | None = None
    restored: UndoStep | None = None
    history: bool = False
    quiet: tuple[int, float] | None = None

    def after_history(self, step: UndoStep | None) -> Guard:
        """The memory after undo or redo restored a step."""
        return replace(self, history=True, restored=step, quiet=None)

    def settled(self, step: UndoStep | None, has_accepted: bool) -> Guard:
        """The memory after the due action is complete."""
        return Guard(has_accepted, step)


def decide(guard: Guard, seen: Observation) -> tuple[Guard, Action]:
    """The action for an observation, and the memory after it."""
    if seen.busy:
        return replace(guard, quiet=None), Action.WAIT
    if not seen.changed:
        return guard.settled(seen.step, guard.has_accepted), Action.REST
    if not guard.has_accepted or seen.own_edit or seen.frame_changed:
        return guard, Action.ACCEPT
    if guard.history and seen.step == guard.restored:
        return guard, Action.WRITE  # the stack restored it: accepted before, unless the guard was off
    if seen.sculpting:
        return guard, Action.WRITE
    if seen.step is not None and (seen.step != guard.step or _is_after_history(guard)):
        return guard, Action.REPLACE
    return _wait_for_quiet(guard, seen)


def is_new_result(guard: Guard, seen: Observation, action: Action) -> bool:
    """Whether an action deals with the result of a tool or a script that undo or redo did not restore."""
    if guard.history and seen.step == guard.restored:
        return False
    return action is not Action.ACCEPT or (seen.step is not None and seen.step != guard.step)


def _is_after_history(guard: Guard) -> bool:
    """Any step other than the restored one is new: a step of the redo panel may have the address of a freed one."""
    return guard.history and guard.restored is not None


def _wait_for_quiet(guard: Guard, seen: Observation) -> tuple[Guard, Action]:
    """A dragged number field is not a tool and adds its step at the end; a script adds none."""
    if guard.quiet is None or guard.quiet[0] != seen.updates:
        return replace(guard, quiet=(seen.updates, seen.time)), Action.WAIT
    done = seen.time - guard.quiet[1] >= QUIET_TIME
    return guard, Action.PUSH if done else Action.WAIT
