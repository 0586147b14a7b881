# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the result of any tool: corrects what moved, places what is new, and names what still intersects."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field, replace

import bpy

from stiv import InputError
from stiv.blender.guard.changes import Changes, compare
from stiv.blender.guard.correction import ToolCorrection, correct_after_tool
from stiv.blender.guard.entering import correct_copies, correct_extrusion, find_originals, is_in_place, place_freely
from stiv.blender.guard.known_intersections import KnownIntersections, find_intersections, fresh_objects
from stiv.blender.guard.scene_state import SceneState, read_state
from stiv.blender.scene.elements import FacePair
from stiv.blender.scene.references import SceneChangedError
from stiv.blender.settings import EditSettings


@dataclass
class GuardedResult:
    """What the guard made of a tool's result.

    Attributes:
        wrote: does the scene differ from the tool's result?
        corrected, placed: names of the objects that an edit corrected, and of new ones put at the nearest free place.
        blocking: names of the objects in contact.
        pairs: what intersects now, without excluded pairs.
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


def guard_result(
    context: bpy.types.Context,
    settings: EditSettings,
    accepted: SceneState,
    known: KnownIntersections,
    created: Collection[int],
) -> GuardedResult:
    """Correct the present scene, starting from the accepted state. What cannot be corrected stays, and is in `pairs`.

    known: the intersections of the accepted state. created: session numbers of the objects that did not exist in it;
    others that appear were only shown, and stay where they are. Raises InputError if the scene cannot be read.
    """
    changes = compare(accepted, read_state(context))
    result = GuardedResult(reason=changes.unsupported)
    base = accepted
    if changes.unsupported:
        base = _guard_new_geometry(context, settings, accepted, known, changes, created, result)
    if changes.changes:
        _guard_changes(context, settings, base, known, replace(changes, unsupported=""), result)
    if changes.unsupported or not changes.changes or result.reason or result.deformers or known.pairs:
        result.pairs = find_intersections(context, settings)
    return result


def _guard_changes(
    context: bpy.types.Context,
    settings: EditSettings,
    base: SceneState,
    known: KnownIntersections,
    changes: Changes,
    result: GuardedResult,
) -> None:
    """Correct what moved."""
    try:
        outcome = correct_after_tool(context, known.left_out(settings), base, changes)
    except (InputError, SceneChangedError) as error:
        result.reason = str(error)
        return
    result.deformers = outcome.deformers
    _add(result, outcome)


def _add(result: GuardedResult, outcome: ToolCorrection | None) -> None:
    if outcome is not None and outcome.corrected:
        result.wrote = True
        result.corrected += [name for name in outcome.names if name not in result.corrected]
        result.blocking += [name for name in outcome.blocking if name not in result.blocking]


def _guard_new_geometry(
    context: bpy.types.Context,
    settings: EditSettings,
    accepted: SceneState,
    known: KnownIntersections,
    changes: Changes,
    created: Collection[int],
    result: GuardedResult,
) -> SceneState:
    """Correct or place what is new and intersects; returns the state from which the other changes are corrected."""
    fresh = fresh_objects(context, settings, known)
    try:
        for reference in changes.rebuilt:
            if reference.name in fresh:
                _add(result, correct_extrusion(context, settings, known, accepted, reference))
        _guard_new_objects(context, settings, accepted, known, changes, created, result)
    except (InputError, SceneChangedError) as error:
        result.reason = str(error)
    moved = {each.reference.session_uid for each in changes.changes}
    return {number: accepted[number] if number in moved else state for number, state in read_state(context).items()}


def _guard_new_objects(
    context: bpy.types.Context,
    settings: EditSettings,
    accepted: SceneState,
    known: KnownIntersections,
    changes: Changes,
    created: Collection[int],
    result: GuardedResult,
) -> None:
    """Correct copies from the places of their originals, then place new objects that still intersect."""
    new = {each.session_uid: each.name for each in changes.added if each.session_uid in created}
    fresh = fresh_objects(context, settings, known) if new else set()
    entering = {number: name for number, name in new.items() if name in fresh}
    present = read_state(context)
    originals = find_originals(accepted, present, entering)
    for number, original in originals.items():
        if is_in_place(present[number], accepted[original]):
            result.reason = f"{new[number]}: is in the same place as {accepted[original].reference.name}; move it"
            return
    if originals:
        _add(result, correct_copies(context, settings, known, accepted, originals))
        fresh = fresh_objects(context, settings, known)
    if not fresh.isdisjoint(new.values()) and place_freely(context, settings, known, list(new.values())):
        result.wrote = True
        result.placed += sorted(entering.values())
