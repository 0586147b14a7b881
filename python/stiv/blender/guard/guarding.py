# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the result of any tool: corrects changes, places new objects, and names the rest."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field, replace

import bpy

from stiv import InputError
from stiv.blender.guard.accepted_scene import AcceptedScene
from stiv.blender.guard.changes import Changes, compare
from stiv.blender.guard.correction import ToolCorrection, correct_after_tool
from stiv.blender.guard.entering import correct_copies, correct_extrusion, find_originals, is_in_place, place_freely
from stiv.blender.guard.known_intersections import find_intersections, fresh_objects
from stiv.blender.guard.scene_state import SceneState, read_state
from stiv.blender.scene.elements import FacePair
from stiv.blender.scene.references import ObjectReference, SceneChangedError
from stiv.blender.settings import EditSettings


@dataclass
class GuardedResult:
    """A tool's result after the guard.

    Attributes:
        wrote: does the scene differ from the tool's result?
        corrected, placed: names of the objects that an edit corrected, and of new ones put at the nearest free place.
        blocking: names of the objects in contact.
        pairs: the intersections that are left, without excluded pairs.
        reason: why a change was not corrected; "" otherwise.
        deformers: see `ToolCorrection`.
    """

    wrote: bool = False
    corrected: list[str] = field(default_factory=list)
    placed: list[str] = field(default_factory=list)
    blocking: list[str] = field(default_factory=list)
    pairs: tuple[FacePair, ...] = ()
    reason: str = ""
    deformers: tuple[str, ...] = ()

    def add(self, outcome: ToolCorrection | None) -> None:
        """Add a correction."""
        if outcome is not None and outcome.corrected:
            self.wrote = True
            self.corrected += [name for name in outcome.names if name not in self.corrected]
            self.blocking += [name for name in outcome.blocking if name not in self.blocking]


def guard_result(context: bpy.types.Context, settings: EditSettings, accepted: AcceptedScene) -> GuardedResult:
    """Correct the present scene, starting from the accepted one. All intersections that are left are in `pairs`.

    New objects and extrusions that intersect are corrected or placed. Objects that were only shown stay where they are.
    Raises InputError if the scene cannot be read.
    """
    changes = compare(accepted.state, read_state(context))
    result = GuardedResult(reason=changes.unsupported)
    start = accepted.state
    if changes.unsupported:
        _guard_new_geometry(context, settings, accepted, changes, result)
        start = _start_of(changes, accepted.state, read_state(context))
    if changes.changes:
        _guard_moved(context, settings, accepted, start, changes, result)
    if changes.unsupported or not changes.changes or result.reason or result.deformers or accepted.known.pairs:
        result.pairs = find_intersections(context, settings)
    return result


def _start_of(changes: Changes, accepted: SceneState, present: SceneState) -> SceneState:
    """The present state, with moved objects at their accepted places."""
    moved = {each.reference.session_uid for each in changes.changes}
    return {number: accepted[number] if number in moved else state for number, state in present.items()}


def _guard_moved(
    context: bpy.types.Context,
    settings: EditSettings,
    accepted: AcceptedScene,
    start: SceneState,
    changes: Changes,
    result: GuardedResult,
) -> None:
    try:
        left_out = accepted.known.left_out(settings)
        outcome = correct_after_tool(context, left_out, start, replace(changes, unsupported=""))
    except (InputError, SceneChangedError) as error:
        result.reason = str(error)
        return
    result.deformers = outcome.deformers
    result.add(outcome)


def _guard_new_geometry(
    context: bpy.types.Context,
    settings: EditSettings,
    accepted: AcceptedScene,
    changes: Changes,
    result: GuardedResult,
) -> None:
    fresh = fresh_objects(context, settings, accepted.known)
    created = [each for each in changes.added if each.session_uid not in accepted.objects]
    try:
        for reference in changes.rebuilt:
            if reference.name in fresh:
                result.add(correct_extrusion(context, settings, accepted, reference))
        if not fresh.isdisjoint({each.name for each in created}):
            _guard_new_objects(context, settings, accepted, created, fresh, result)
    except (InputError, SceneChangedError) as error:
        result.reason = str(error)


def _guard_new_objects(
    context: bpy.types.Context,
    settings: EditSettings,
    accepted: AcceptedScene,
    created: Collection[ObjectReference],
    fresh: set[str],
    result: GuardedResult,
) -> None:
    """Correct copies from the places of their originals, then place new objects that still intersect."""
    present, names = read_state(context), {each.name for each in created}
    entering = [each for each in created if each.name in fresh]
    originals = find_originals(accepted, present, [each.session_uid for each in entering])
    for copy, original in originals.items():
        if is_in_place(present[copy], accepted.state[original]):
            first, second = present[copy].reference.name, accepted.state[original].reference.name
            result.reason = f"{first}: is in the same place as {second}; move it"
            return
    if originals:
        result.add(correct_copies(context, settings, accepted, originals))
        fresh = fresh_objects(context, settings, accepted.known)
    if not fresh.isdisjoint(names) and place_freely(context, settings, accepted.known, names):
        result.wrote = True
        result.placed += sorted(each.name for each in entering)
