# SPDX-License-Identifier: GPL-3.0-or-later
"""What the guard has done to the scene: through `stiv.blender`, with nothing of the interface."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from ..scene.edit_settings import edit_settings
from ..translations import say
from .problem import Problem, listed


@dataclass(frozen=True)
class Outcome:
    """What came of it.

    Attributes:
        problem: why the scene is not free of intersections; None if it is.
        wrote: something was written.
        text: what to tell the user of that.
    """

    problem: Problem | None = None
    wrote: bool = False
    text: str = ""


def read(context: Any) -> Any:
    """The state of all controls, a `stiv.blender.SceneState`."""
    from stiv.blender import read_state  # the add-on registers without the native module

    return read_state(context)


def take_strokes(context: Any) -> None:
    """Let Blender evaluate what was sculpted, which it only draws: what others read of it is as before the strokes."""
    context.object.update_tag(refresh={"DATA"})
    context.view_layer.update()


def test(context: Any) -> Outcome:
    """Is the scene free as it is, but for what may intersect?"""
    from stiv.blender import check_scene

    settings = _settings(context)
    try:
        pairs = settings.excluded.others(check_scene(context, settings).pairs)
    except ValueError as error:
        return Outcome(Problem(reason=str(error)))
    return Outcome(Problem(tuple(dict.fromkeys(pairs))) if pairs else None)


def correct(context: Any, accepted: Any) -> Outcome:
    """Edit from the accepted state toward the scene as it is. What cannot be followed is tested as it is."""
    from stiv.blender import SceneChangedError, compare, follow, read_state

    changes = compare(accepted, read_state(context))
    if changes.obstacle or not changes.changes:
        return _tested_instead(context, changes.obstacle)
    try:
        followed = follow(context, _settings(context), accepted, changes)
    except (ValueError, SceneChangedError) as error:
        return _tested_instead(context, str(error))
    found = Outcome()
    if followed.deformers:
        found = _tested_instead(context, say("{} cannot be corrected").format(listed(followed.deformers, say)))
    if not followed.corrected:
        return found
    told = say("corrected {}").format(listed(followed.names, say))
    if followed.blocking:
        told = say("corrected {}, blocked by {}").format(listed(followed.names, say), listed(followed.blocking, say))
    return Outcome(found.problem, wrote=True, text=told)


def revert(context: Any, accepted: Any, frame: int) -> tuple[str, ...]:
    """Put the accepted state back, at its frame; names of the objects that were written.

    Raises ValueError naming an object whose structure changed, before anything is changed.
    """
    from stiv.blender import revert as restore_state

    present = context.scene.frame_current
    if present == frame:
        return tuple(restore_state(context, accepted))
    context.scene.frame_set(frame)
    try:
        return tuple(restore_state(context, accepted))
    except ValueError:
        context.scene.frame_set(present)
        raise


def _tested_instead(context: Any, reason: str) -> Outcome:
    """The scene as it is, if free; otherwise why it could not be corrected."""
    found = test(context)
    if found.problem is None or not found.problem.pairs or not reason:
        return found
    return Outcome(replace(found.problem, reason=reason))


def _settings(context: Any) -> Any:
    """The scene's, with interference on whatever drags do."""
    return replace(edit_settings(context.scene), interference=True)
