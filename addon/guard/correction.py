# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests, corrects and restores the scene for the guard, without any interface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy

from .. import stiv_blender
from ..modal.header_texts import naming
from ..operators.reports import message_text, topology_text
from ..scene.edit_settings import edit_settings
from ..translations import translate

TIME_LIMIT = 20.0  # seconds for one correction, which Esc stops; then what is accepted so far is written


@dataclass(frozen=True)
class Outcome:
    """The outcome of a test or a correction.

    Attributes:
        pairs: what cuts or touches now, without excluded pairs.
        reason: why a change was not corrected; "" otherwise.
        failed: the scene could not be tested, for this reason.
        wrote: whether anything was written.
        text: the message to the user about it.
    """

    pairs: Sequence[stiv_blender.FacePair] = ()
    reason: str = ""
    failed: bool = False
    wrote: bool = False
    text: str = ""

    @property
    def cutting(self) -> stiv_blender.FacePairs:
        """The pairs without those of objects that only touch."""
        return stiv_blender.FacePairs.of(self.pairs).cutting()


def evaluate_strokes(context: bpy.types.Context) -> None:
    """Evaluate sculpt strokes, which Blender only draws until something else needs the mesh."""
    context.object.update_tag(refresh={"DATA"})
    context.view_layer.update()


def test(context: bpy.types.Context) -> Outcome:
    """Find what intersects in the current scene, except for excluded pairs."""
    try:
        return Outcome(stiv_blender.find_intersections(context, _settings(context)))
    except ValueError as error:
        return Outcome(reason=message_text(error), failed=True)


def correct_steps(context: bpy.types.Context, accepted: stiv_blender.AcceptedScene) -> stiv_blender.Steps[Outcome]:
    """Steps that edit from the accepted scene toward the current one, and place new objects."""
    settings = replace(_settings(context), time_budget=TIME_LIMIT)
    try:
        guarded = yield from stiv_blender.guard_result_steps(context, settings, accepted)
    except ValueError as error:
        return Outcome(reason=message_text(error), failed=True)
    cutting = stiv_blender.FacePairs.of(guarded.pairs).cutting()
    reason = message_text(guarded.reason) if cutting else ""
    if cutting and guarded.deformers:
        reason = _naming(translate("{} cannot be corrected"), guarded.deformers)
    return Outcome(guarded.pairs, reason, wrote=guarded.wrote, text=_text(guarded))


def stop(context: bpy.types.Context, accepted: stiv_blender.AcceptedScene) -> Outcome:
    """Restore the accepted scene; added objects and changed structures stay, and are tested."""
    try:
        stiv_blender.revert(context, accepted.state)
    except ValueError as error:
        return replace(test(context), reason=message_text(error))
    added = any(ob.session_uid not in accepted.objects for ob in context.view_layer.objects)
    outcome = test(context) if added else Outcome(accepted.known.pairs)
    return replace(outcome, wrote=True, text=translate("stopped, back to the state before"))


def _text(guarded: stiv_blender.GuardedResult) -> str:
    texts = []
    if guarded.blocking:
        text = translate("corrected {}, blocked by {}")
        texts.append(_naming(text, guarded.corrected, guarded.blocking))
    elif guarded.corrected:
        texts.append(_naming(translate("corrected {}"), guarded.corrected))
    if guarded.cut:
        texts.append(topology_text(guarded.cut))
    if guarded.stopped:
        texts.append(translate("stopped after {} seconds, short of the goal").format(f"{TIME_LIMIT:g}"))
    if guarded.placed:
        texts.append(_naming(translate("put {} at the nearest free place"), guarded.placed))
    return "; ".join([*texts, *map(message_text, guarded.notes)])


def _naming(text: str, *lists: Sequence[str]) -> str:
    return naming(text, translate, stiv_blender.fit_message, *lists)


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


def _settings(context: bpy.types.Context) -> stiv_blender.EditSettings:
    """The settings of the scene, with collisions on, even if they are off for drags."""
    return replace(edit_settings(context.scene), interference=True)
