# SPDX-License-Identifier: GPL-3.0-or-later
"""Corrects the result of any tool: it is the goal of edits from the last accepted state."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import bpy
import numpy as np

from stiv import InputError, StartIntersectsError
from stiv.blender.controls.control_set import Participant
from stiv.blender.controls.editable import check_placement
from stiv.blender.controls.participants import (
    EDITABLE_TYPES,
    make_participant,
    may_have_surface,
    merge_participants,
    moves_surface,
)
from stiv.blender.edit.blender_edit import BlenderEdit, obstacles_beside
from stiv.blender.edit.results import is_cut_by_topology
from stiv.blender.edit.sessions import stack_controls
from stiv.blender.edit.touching_start import start_apart_steps
from stiv.blender.guard.changes import Change, Changes, compare
from stiv.blender.guard.known_intersections import KnownIntersections, ObjectPair, find_intersections_steps
from stiv.blender.guard.scene_state import SceneState, read_state
from stiv.blender.guard.tool_goals import ToolGoals, controls_after, with_response
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.evaluations import is_visible
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings
from stiv.deadlines import deadline_after, is_over, time_left
from stiv.task import Left, Steps, run
from stiv.touching import rounding_of

STEP = 0.02  # maximum step toward a goal, in diagonals of the moving surface
MAX_STEPS = 100
WITHOUT_EFFECT = ("CAMERA", "LIGHT", "LIGHT_PROBE", "SPEAKER")  # on the surfaces of other objects
TIME_LIMIT = 5.0  # seconds for one correction without a budget; then what is accepted so far is written
SOLVING = 0.75  # of the time that is left: solves. The rest is for writing, which may solve again
NEAR = 32  # roundings; an edit keeps a distance of 16 from what it slides along
SETTLING_TIME = 0.5  # seconds of one call that settles; it is repeated while there is time


@dataclass(frozen=True)
class ToolCorrection:
    """The correction of a tool's result.

    Attributes:
        corrected: does the scene differ from the tool's result?
        names: objects that the tool changed.
        blocking: objects in contact.
        cut: names of the objects that follow the controls, if it stopped where the topology of one changes.
        stopped: did it end at the deadline, short of the tool's result?
        message: why the correction is incomplete; "" if it is complete.
        notes: about faces that no edit tests and that cut each other now, see `BlenderEdit.untested_notes`.
        deformers: changed objects without a surface that may deform others. They are not corrected, so the scene has to
            be tested.
    """

    corrected: bool
    names: tuple[str, ...]
    blocking: tuple[str, ...] = ()
    message: str = ""
    deformers: tuple[str, ...] = ()
    cut: tuple[str, ...] = ()
    stopped: bool = False
    notes: tuple[str, ...] = ()


def correct_after_tool(
    context: bpy.types.Context, settings: EditSettings, accepted: SceneState, changes: Changes
) -> ToolCorrection:
    """Edit from the accepted state toward the present scene, and write the result.

    changes: of `compare`, without an unsupported one. A result that needs no correction stays as it is exactly. Raises
    InputError, StartIntersectsError and SceneChangedError; the tool's result then remains.
    """
    return run(correct_after_tool_steps(context, settings, accepted, changes))


def correct_after_tool_steps(
    context: bpy.types.Context,
    settings: EditSettings,
    accepted: SceneState,
    changes: Changes,
    end: float | None = None,
    touching: Collection[ObjectPair] = (),
) -> Steps[ToolCorrection]:
    """Steps of `correct_after_tool`.

    Between steps, the scene shows the accepted state of the changed objects. Steps that are closed leave the tool's
    result; those ended by Left leave what the scene shows.

    end: the deadline; None for the time budget of the settings from now. touching: the objects that only
    touch in the accepted state; they may touch after the tool as well, but not cut each other.
    """
    end = correction_deadline(settings) if end is None else end
    chosen = [change for change in changes.changes if _participates(context, change, settings)]
    names = tuple(name for change in chosen if settings.cage_of(name := change.reference.name) == name)
    deformers = tuple(
        change.reference.name for change in changes.changes if change not in chosen and _may_deform_others(change)
    )
    if not chosen:
        return ToolCorrection(False, names, deformers=deformers)
    wanted = read_state(context)
    try:
        _restore(context, accepted, chosen)
        outcomes = yield from _passes(context, settings, wanted, names, end, touching)
        if (yield from _keep_tool_result(context, settings, wanted, chosen, outcomes, touching)):
            return ToolCorrection(False, names, deformers=deformers, notes=_notes_of(outcomes))
    except Left:
        raise
    except BaseException:
        _restore(context, wanted, chosen)
        raise
    messages = [outcome.message for outcome in outcomes]
    if context.scene.tool_settings.use_keyframe_insert_auto:  # the tool has keyed what it reached
        for outcome in outcomes:
            outcome.edit.insert_keyframes(context)
    else:
        messages += [outcome.edit.reset_note for outcome in outcomes]
    blocking = sorted({name for outcome in outcomes for name in outcome.blocking})
    message = next(filter(None, messages), "")
    cut = next((outcome.cut for outcome in outcomes if outcome.cut), ())
    stopped = any(outcome.stopped for outcome in outcomes)
    return ToolCorrection(True, names, tuple(blocking), message, deformers, cut, stopped, _notes_of(outcomes))


def correct_but_known_steps(
    context: bpy.types.Context,
    settings: EditSettings,
    known: KnownIntersections,
    accepted: SceneState,
    changes: Changes,
    end: float,
    copies: Mapping[str, str] | None = None,
) -> Steps[ToolCorrection]:
    """Steps of `correct_after_tool` that leave known intersections alone: all of them, where those that only touch do
    not let an edit start.

    copies: names of objects that were copied, by the name of the copy; they may intersect what their originals do.
    """
    correct = partial(correct_after_tool_steps, context, accepted=accepted, changes=changes, end=end)
    touching = known.touching(copies)
    try:
        return (yield from correct(known.left_out(settings, copies, touching=False), touching=touching))
    except StartIntersectsError:
        if not touching:
            raise
    return (yield from correct(known.left_out(settings, copies)))


def correction_deadline(settings: EditSettings) -> float:
    """The deadline of a correction that begins now."""
    return deadline_after(settings.time_budget or TIME_LIMIT)


@dataclass(frozen=True)
class Outcome:
    """The outcome of one edit of a correction.

    Attributes:
        edit: the edit.
        reached: does the scene show its goal?
        near: is it within rounding of it?
        blocking: objects in contact.
        message: why the result could not be written, or notes; may be "".
        cut: as in ToolCorrection.
        stopped: did it end at the deadline, short of its goal?
    """

    edit: BlenderEdit
    reached: bool
    near: bool
    blocking: tuple[str, ...]
    message: str
    cut: tuple[str, ...]
    stopped: bool


def _notes_of(outcomes: Sequence[Outcome]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(note for outcome in outcomes for note in outcome.edit.untested_notes))


def _participates(context: bpy.types.Context, change: Change, settings: EditSettings) -> bool:
    """Can the change cause intersections, and an edit correct them? Cameras and lights cannot."""
    name, ob = change.reference.name, change.reference.find()
    if not settings.participates(settings.shown_by(name)):
        return False
    return may_have_surface(ob) or _moves_followers(context, ob)


def _moves_followers(context: bpy.types.Context, ob: bpy.types.Object) -> bool:
    """Can an object without a surface be moved so that visible ones follow it?"""
    if ob.type in WITHOUT_EFFECT or not is_visible(context, ob) or not moves_surface(context, [ob]):
        return False
    try:
        check_placement(ob, may_be_keyed=True)
    except InputError:
        return False
    return True


def _may_deform_others(change: Change) -> bool:
    """Is it an armature, a hook or another object that may deform others?"""
    ob = change.reference.find()
    return ob.type not in WITHOUT_EFFECT and not may_have_surface(ob)


def _restore(context: bpy.types.Context, state: SceneState, changes: Sequence[Change]) -> None:
    """Restore the changed objects."""
    for change in changes:
        each = state[change.reference.session_uid]
        if change.placed:
            each.restore_placement()
        if change.points is not None:
            each.restore_points()
    context.view_layer.update()


def _keep_tool_result(
    context: bpy.types.Context,
    settings: EditSettings,
    wanted: SceneState,
    changes: Sequence[Change],
    outcomes: Sequence[Outcome],
    touching: Collection[ObjectPair],
) -> Steps[bool]:
    """Steps that restore the tool's own result exactly if it is reached and free, or near and in contact.

    In contact, only objects touch that did before: an edit slides along a surface some roundings above it, and the
    tool's result lies in its plane. Otherwise the scene shows the solved state again, and they return False.
    """
    if not all(outcome.near for outcome in outcomes):
        return False
    solved = read_state(context)
    _restore(context, wanted, changes)
    if not outcomes or (all(outcome.reached for outcome in outcomes) and outcomes[-1].edit.is_shown()):
        return True
    moving = {name for outcome in outcomes for name in outcome.edit.moving}
    found = yield from find_intersections_steps(context, settings, moving)
    if found.touching.intersection(touching).issuperset(found.by_objects()):
        return True
    _restore(context, solved, changes)
    return False


def _passes(
    context: bpy.types.Context,
    settings: EditSettings,
    wanted: SceneState,
    names: Sequence[str],
    end: float,
    touching: Collection[ObjectPair],
) -> Steps[list[Outcome]]:
    """Split changes that one edit cannot make into passes: rotation before scale, parents before children.

    After the deadline, no pass begins; the last outcome has then not reached its goal.
    """
    done: set[tuple[int, str]] = set()
    outcomes: list[Outcome] = []
    while True:
        present = read_state(context)
        remaining = [
            change for change in compare(present, wanted).changes
            if change.reference.name in names and _operation(change, done) not in done
        ]  # fmt: skip
        now = _outermost(remaining, wanted)
        if not now:
            return outcomes
        if outcomes and is_over(end):
            return [*outcomes[:-1], replace(outcomes[-1], reached=False, stopped=True)]
        kind = "scale" if all(_kind(change, done) == "scale" for change in now if change.placed) else "rotate"
        now = [change for change in now if not change.placed or _kind(change, done) == kind]
        done |= {_operation(change, done) for change in now}
        goals = ToolGoals.between(present, wanted, now)
        outcomes.append((yield from _edit(context, settings, goals, kind, end, touching)))


def _operation(change: Change, done: set[tuple[int, str]]) -> tuple[int, str]:
    """The session number of the object, or of the data for points, which users share; and the next operation there."""
    kind = _kind(change, done)
    return (change.reference.find().data.session_uid if kind == "points" else change.reference.session_uid), kind


def _kind(change: Change, done: set[tuple[int, str]]) -> str:
    """The next operation for a change: points, then rotation and location, then scale."""
    if change.points is not None:
        return "points"
    if not change.scaled:
        return "rotate"
    turned_before = (change.reference.session_uid, "rotate") in done
    return "scale" if turned_before or not change.turned else "rotate"


def _outermost(changes: Sequence[Change], states: SceneState) -> list[Change]:
    """The changes of objects whose parents do not change."""
    changing = {change.reference.session_uid for change in changes}

    def has_changing_parent(number: int) -> bool:
        parent = states[number].parent if number in states else 0
        return parent != 0 and (parent in changing or has_changing_parent(parent))

    return [change for change in changes if not has_changing_parent(change.reference.session_uid)]


def _edit(
    context: bpy.types.Context,
    settings: EditSettings,
    goals: ToolGoals,
    kind: str,
    end: float,
    touching: Collection[ObjectPair],
) -> Steps[Outcome]:
    """Steps of one edit. Objects that the changed ones touch belong to the surface: there, cages start in contact."""
    if kind == "rotate" and not any(change.turned for change in goals.changes.values()):
        kind = "move"  # permitted below an unevenly scaled parent, which prevents rotation
    participants = _participants(context, settings, goals.changes)
    touched = [pair for pair in touching if not goals.changes.keys().isdisjoint(pair)]
    edit = yield from BlenderEdit.begin_with_steps(
        context, correction_settings(settings), kind, participants,
        lambda control_set: with_response(control_set, goals, settings),
        obstacles_beside(context, settings, participants).difference(*touched), start_apart_steps,
    )  # fmt: skip
    goal = stack_controls([controls_after(each, goals) for each in edit.control_sets])
    return (yield from move_to_goal(edit, goal, end))


def correction_settings(settings: EditSettings) -> EditSettings:
    """Settings of an edit for `move_to_goal`, which limits the time of all calls but those that settle."""
    return replace(settings, time_budget=SETTLING_TIME)


def move_to_goal(edit: BlenderEdit, goal: Floats, end: float) -> Steps[Outcome]:
    """Steps of an edit toward a goal of all controls, (m, 3), in steps of a drag, and its write.

    The edit has `correction_settings`. The deadline `end` holds for solves; what is accepted then is written. After it,
    the scene shows the start of the edit.
    """
    if is_over(end):
        return Outcome(edit, False, False, (), "", (), True)
    solving_end = deadline_after(SOLVING * time_left(end))
    steps = _steps_to(edit, goal)
    results = []
    for number, step in enumerate(steps):
        yield number / len(steps)
        results.append((yield from edit.drag_to_steps(step, time_left(solving_end))))
        if results[-1].status == "budget" or is_over(solving_end):
            break
    reached = all(result.status in ("reached", "unchanged") for result in results)
    while not reached and not is_over(solving_end):
        results.append((yield from edit.settle_steps()))
        if results[-1].status != "budget":
            break
    yield None
    report = yield from edit.write_steps(end)
    blocking = () if reached else tuple(edit.objects_in_contact(results[-1]))
    message = report.message or "; ".join(each.note for each in edit.control_sets if each.note)
    cut = tuple(sorted(edit.moving)) if any(map(is_cut_by_topology, results[-1:])) else ()
    is_complete = report.passed and report.result is None
    near = is_complete and (reached or _is_near(edit, goal))
    return Outcome(edit, reached and is_complete, near, blocking, message, cut, not reached and is_over(solving_end))


def _is_near(edit: BlenderEdit, goal: Floats) -> bool:
    """Are the accepted controls and their surface within some roundings of the goal and its surface?

    Where the topology changes, the surface of the goal is not that of its controls.
    """
    controls, surface = edit.controls, edit.surface
    tolerance = NEAR * max(rounding_of(controls), rounding_of(surface))
    if np.abs(goal - controls).max(initial=0.0) > tolerance:
        return False
    return bool(np.abs(edit.surface_of(goal) - surface).max(initial=0.0) <= tolerance)


def _participants(context: bpy.types.Context, settings: EditSettings, changes: dict[str, Change]) -> list[Participant]:
    """The changed objects, and those that yield because of their role."""
    participants = []
    for ob in context.view_layer.objects:
        if not is_visible(context, ob) or settings.cage_of(ob.name) != ob.name:
            continue
        change = changes.get(ob.name)
        if change is None:
            participant = make_participant(ob, False, settings) if ob.mode == "OBJECT" else None
        else:
            role = "rigid" if change.points is None else EDITABLE_TYPES[ob.type]
            participant = Participant(ObjectReference.of(ob), role, True)
        participants += [] if participant is None else [participant]
    return merge_participants(participants)


def _steps_to(edit: BlenderEdit, goal: Floats) -> list[Floats]:
    """The straight path to a goal, in steps no longer than those of a drag."""
    start = edit.controls
    before = edit.surface
    moves = np.linalg.norm(edit.surface_of(goal) - before, axis=1)
    size = float(np.linalg.norm(np.ptp(before[moves > 0], axis=0))) if moves.any() else 0.0
    count = int(np.clip(np.ceil(moves.max() / (STEP * size)), 1, MAX_STEPS)) if size > 0 else 1
    return [*(start + (goal - start) * ((k + 1) / count) for k in range(count - 1)), goal]
