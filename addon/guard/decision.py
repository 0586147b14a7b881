# SPDX-License-Identifier: GPL-3.0-or-later
"""When the guard does what: a pure state machine over what was seen of Blender."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

STILL = 1.0  # seconds without a change after which one that no undo step tells of counts as finished
LOOK_AGAIN = 0.05  # seconds between two looks while waiting

UndoStep = tuple[int, str, str]
"""Index, address and name of a step: all three, since replacing a step keeps index and name."""


class Action(Enum):
    """What is to be done now."""

    REST = "rest"
    """Nothing, until something changes."""
    WAIT = "wait"
    """Look again soon."""
    ACCEPT = "accept"
    """Test the scene as it is; if it is free it is the accepted state. Writes nothing."""
    REPLACE = "replace"
    """Correct, and let the tool's undo step hold what was corrected."""
    PUSH = "push"
    """Correct, and add an undo step: what changed the scene made none."""
    WRITE = "write"
    """Test, and correct only if it fails, leaving the undo stack alone."""


@dataclass(frozen=True)
class Seen:
    """Blender at one moment.

    Attributes:
        time: seconds of any clock.
        busy: a tool or an animation runs.
        changed: controls or surfaces differ from the accepted state, or may.
        updates: how often the scene has been changed since the guard was turned on.
        step: the active undo step; None where that cannot be found out.
        sculpting: an object is being sculpted, whose undo knows no replaced steps.
        accepted_by_us: one of STIV's own operators wrote what is seen.
        frame_changed: the scene stands at another frame than the accepted state.
    """

    time: float
    busy: bool = False
    changed: bool = True
    updates: int = 0
    step: UndoStep | None = None
    sculpting: bool = False
    accepted_by_us: bool = False
    frame_changed: bool = False


@dataclass(frozen=True)
class Guard:
    """What the guard remembers between two looks.

    Attributes:
        has_accepted: there is a state free of intersections to go on from.
        step: the undo step that was active when the scene was last settled.
        restored: the step that undo or redo went to; None if there was no such thing since.
        quiet: number of updates, and since when it has been that.
    """

    has_accepted: bool = False
    step: UndoStep | None = None
    restored: UndoStep | None = None
    history: bool = False
    quiet: tuple[int, float] | None = None

    def went_through_history(self, step: UndoStep | None) -> Guard:
        """Undo or redo led to this step."""
        return replace(self, history=True, restored=step, quiet=None)

    def settled(self, step: UndoStep | None, has_accepted: bool) -> Guard:
        """Everything is done for now."""
        return Guard(has_accepted, step)


def decide(guard: Guard, seen: Seen) -> tuple[Guard, Action]:
    """What to do about what is seen, and what to remember."""
    if seen.busy:
        return replace(guard, quiet=None), Action.WAIT
    if not seen.changed:
        return guard.settled(seen.step, guard.has_accepted), Action.REST
    if not guard.has_accepted or seen.accepted_by_us or seen.frame_changed:
        return guard, Action.ACCEPT
    if guard.history and seen.step == guard.restored:
        return guard, Action.WRITE  # it came from the stack: accepted once, unless the guard was off then
    if seen.sculpting:
        return guard, Action.WRITE
    if seen.step is not None and (seen.step != guard.step or _is_after_history(guard)):
        return guard, Action.REPLACE
    return _wait_for_quiet(guard, seen)


def is_new_result(guard: Guard, seen: Seen, action: Action) -> bool:
    """Is what an action deals with the result of a tool or a script, and none that undo or redo brought back?"""
    if guard.history and seen.step == guard.restored:
        return False
    return action is not Action.ACCEPT or (seen.step is not None and seen.step != guard.step)


def _is_after_history(guard: Guard) -> bool:
    """A step that is not the one gone back to is new: the redo panel's may lie where the one before has been freed."""
    return guard.history and guard.restored is not None


def _wait_for_quiet(guard: Guard, seen: Seen) -> tuple[Guard, Action]:
    """A number field that is dragged is no tool and leaves its step at the end; a script leaves none at all."""
    if guard.quiet is None or guard.quiet[0] != seen.updates:
        return replace(guard, quiet=(seen.updates, seen.time)), Action.WAIT
    done = seen.time - guard.quiet[1] >= STILL
    return guard, Action.PUSH if done else Action.WAIT
