# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads, tests, corrects and restores the scene for the guard, without any interface."""

from __future__ import annotations

from dataclasses import dataclass, replace

import bpy

from .. import stiv_blender
from ..scene.edit_settings import edit_settings
from ..translations import translate
from .problem import Problem, listed


@dataclass(frozen=True)
class Outcome:
    """The outcome of a test or a correction.

    Attributes:
        problem: why the scene is not clear; None if it is.
        wrote: whether anything was written.
        text: the message to the user about it.
    """

    problem: Problem | None = None
    wrote: bool = False
    text: str = ""


def evaluate_strokes(context: bpy.types.Context) -> None:
    """Evaluate sculpt strokes, which Blender only draws until something else needs the mesh."""
    context.object.update_tag(refresh={"DATA"})
    context.view_layer.update()


def test(context: bpy.types.Context) -> Outcome:
    """Test whether the current scene is clear, except for excluded pairs."""
    settings = _settings(context)
    try:
        pairs = stiv_blender.without_excluded(stiv_blender.check_scene(context, settings).pairs, settings.excluded)
    except ValueError as error:
        return Outcome(Problem(reason=str(error)))
    return Outcome(Problem(tuple(dict.fromkeys(pairs))) if pairs else None)


def correct(context: bpy.types.Context, accepted: stiv_blender.SceneState) -> Outcome:
    """Edit from the accepted state toward the current scene; changes that no edit can make are only tested."""
    changes = stiv_blender.compare(accepted, stiv_blender.read_state(context))
    if changes.unsupported or not changes.changes:
        return _tested_only(context, changes.unsupported)
    try:
        followed = stiv_blender.correct_after_tool(context, _settings(context), accepted, changes)
    except (ValueError, stiv_blender.SceneChangedError) as error:
        return _tested_only(context, str(error))
    found = Outcome()
    if followed.deformers:
        found = _tested_only(context, translate("{} cannot be corrected").format(listed(followed.deformers, translate)))
    if not followed.corrected:
        return found
    names, blocking = listed(followed.names, translate), listed(followed.blocking, translate)
    text = translate("corrected {}, blocked by {}").format(names, blocking)
    return Outcome(found.problem, wrote=True, text=text if blocking else translate("corrected {}").format(names))


def revert(context: bpy.types.Context, accepted: stiv_blender.SceneState, frame: int) -> tuple[str, ...]:
    """Restore the accepted state at its frame; returns the names of the objects that changed.

    Raises ValueError naming an object whose topology changed, before anything is changed.
    """
    current = context.scene.frame_current
    if current == frame:
        return tuple(stiv_blender.revert(context, accepted))
    context.scene.frame_set(frame)
    try:
        return tuple(stiv_blender.revert(context, accepted))
    except ValueError:
        context.scene.frame_set(current)
        raise


def _tested_only(context: bpy.types.Context, reason: str) -> Outcome:
    """The outcome of a test; if the scene is not clear, with the reason why it was not corrected."""
    found = test(context)
    if found.problem is None or not found.problem.pairs or not reason:
        return found
    return Outcome(replace(found.problem, reason=reason))


def _settings(context: bpy.types.Context) -> stiv_blender.EditSettings:
    """The settings of the scene, with collisions on, even if they are off for drags."""
    return replace(edit_settings(context.scene), interference=True)
