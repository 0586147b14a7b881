# SPDX-License-Identifier: GPL-3.0-or-later
"""What a tool of any kind made of the scene, taken as the goal of edits from the last accepted state."""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np

from stiv.blender.controls.control_set import Part
from stiv.blender.controls.joined_seams import seam_note
from stiv.blender.controls.motion import Motion
from stiv.blender.controls.movers import Mover
from stiv.blender.controls.participants import has_surface, mover_of, once
from stiv.blender.controls.points import PointGoal, point_weights
from stiv.blender.edit.blender_edit import BlenderEdit
from stiv.blender.edit.sessions import stacked
from stiv.blender.guard.changes import Change, Changes, compare
from stiv.blender.guard.scene_state import SceneState, read_state
from stiv.blender.scene.arrays import Floats, Indices, transform_points
from stiv.blender.scene.evaluated_scene import is_visible
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings

STEP = 0.02  # longest step of the way to a goal, in diagonals of what moves
MOST_STEPS = 100
WITHOUT_EFFECT = ("CAMERA", "LIGHT", "LIGHT_PROBE", "SPEAKER")  # on the surfaces of other objects
TIME_LIMIT = 5.0  # seconds for one tool; what was accepted by then is shown


@dataclass(frozen=True)
class Followed:
    """What became of a tool's result.

    Attributes:
        corrected: is anything shown that differs from it?
        names: objects that the tool changed.
        blocking: objects that were in the way.
        message: why not all is shown that could be, empty if it is.
        deformers: objects without a surface that the tool changed too, and that may deform others. They are not
            followed: the scene has to be tested.
    """

    corrected: bool
    names: tuple[str, ...]
    blocking: tuple[str, ...] = ()
    message: str = ""
    deformers: tuple[str, ...] = ()


def follow(context: bpy.types.Context, settings: EditSettings, accepted: SceneState, changes: Changes) -> Followed:
    """Edit from the accepted state toward the scene as it is now, and show what comes of it.

    changes: of `compare`, with no obstacle. A result that needs no correction is left as it is, bit by bit. Raises
    InputError, StartIntersectsError and SceneChangedError; the tool's result then stands.
    """
    followed = [change for change in changes.changes if _takes_part(change, settings)]
    names = tuple(name for change in followed if settings.cage_of(name := change.reference.name) == name)
    deformers = tuple(change.reference.name for change in changes.changes if _may_deform_others(change))
    if not followed:
        return Followed(False, names, deformers=deformers)
    wanted = read_state(context)
    try:
        _restore(context, accepted, followed)
        outcomes = list(_passes(context, settings, wanted, names, time.monotonic() + TIME_LIMIT))
        if all(outcome.reached for outcome in outcomes) and _is_free_as_it_was(context, wanted, followed, outcomes):
            return Followed(False, names, deformers=deformers)
    except Exception:
        _restore(context, wanted, followed)
        raise
    blocking = sorted({name for outcome in outcomes for name in outcome.blocking})
    message = next((outcome.message for outcome in outcomes if outcome.message), "")
    return Followed(True, names, tuple(blocking), message, deformers)


@dataclass(frozen=True)
class _Outcome:
    edit: BlenderEdit
    reached: bool
    blocking: tuple[str, ...]
    message: str


def _takes_part(change: Change, settings: EditSettings) -> bool:
    """Can the change bring surfaces together? Cameras and lights are no concern."""
    name = change.reference.name
    return settings.takes_part(settings.shown_by(name)) and has_surface(change.reference.find())


def _may_deform_others(change: Change) -> bool:
    """Armatures, hooks, empties that modifiers look at, and the like."""
    ob = change.reference.find()
    return ob.type not in WITHOUT_EFFECT and not has_surface(ob)


def _restore(context: bpy.types.Context, state: SceneState, changes: Sequence[Change]) -> None:
    """Put back what was changed."""
    for change in changes:
        each = state[change.reference.session_uid]
        if change.placed:
            each.restore_placement()
        if change.points is not None:
            each.restore_points()
    context.view_layer.update()


def _is_free_as_it_was(
    context: bpy.types.Context, wanted: SceneState, changes: Sequence[Change], outcomes: Sequence[_Outcome]
) -> bool:
    """Put the tool's own result back, to the last bit, and test that; if it fails, what was solved for stays."""
    solved = read_state(context)
    _restore(context, wanted, changes)
    if not outcomes or outcomes[-1].edit.is_shown():
        return True
    _restore(context, solved, changes)
    return False


def _passes(
    context: bpy.types.Context, settings: EditSettings, wanted: SceneState, names: Sequence[str], deadline: float
) -> Iterator[_Outcome]:
    """Edits one after the other, for what one cannot tell: turned and then scaled, parents before their children."""
    done: set[tuple[int, str]] = set()
    while True:
        present = read_state(context)
        left = [
            change for change in compare(present, wanted).changes
            if change.reference.name in names and (change.reference.session_uid, _kind(change, done)) not in done
        ]  # fmt: skip
        now = _first(left, wanted)
        if not now:
            return
        kind = "scale" if all(_kind(change, done) == "scale" for change in now if change.placed) else "rotate"
        now = [change for change in now if not change.placed or _kind(change, done) == kind]
        done |= {(change.reference.session_uid, _kind(change, done)) for change in now}
        yield _edit(context, settings, present, wanted, now, kind, deadline)


def _kind(change: Change, done: set[tuple[int, str]]) -> str:
    """What is to be done about a change next: points, or turning and moving, and then scaling."""
    if change.points is not None:
        return "points"
    if not change.scaled:
        return "rotate"
    turned_before = (change.reference.session_uid, "rotate") in done
    return "scale" if turned_before or not change.turned else "rotate"


def _first(changes: Sequence[Change], states: SceneState) -> list[Change]:
    """Those whose parents do not change too."""
    changing = {change.reference.session_uid for change in changes}

    def hangs(number: int) -> bool:
        parent = states[number].parent if number in states else 0
        return parent != 0 and (parent in changing or hangs(parent))

    return [change for change in changes if not hangs(change.reference.session_uid)]


def _edit(
    context: bpy.types.Context,
    settings: EditSettings,
    present: SceneState,
    wanted: SceneState,
    changes: Sequence[Change],
    kind: str,
    deadline: float,
) -> _Outcome:
    by_name = {change.reference.name: change for change in changes}
    if kind == "rotate" and not any(change.turned for change in changes):
        kind = "move"  # allowed where nothing can turn, below an unevenly scaled parent
    edit = BlenderEdit.begin_with(
        context, replace(settings, time_budget=TIME_LIMIT), kind,
        _movers(context, settings, by_name), lambda part: _responding(part, by_name, settings),
    )  # fmt: skip
    goal = stacked([_goal(part, by_name, present, wanted) for part in edit.parts])
    results = []
    for step in _steps(edit, goal):
        results.append(edit.drag_to(step))
        if results[-1].status == "budget" or time.monotonic() > deadline:
            break
    reached = all(result.status in ("reached", "unchanged") for result in results)
    if not reached and time.monotonic() < deadline:
        results.append(edit.settle())
    report = edit.write()
    blocking = tuple(name for result in results[-1:] for name in result.blocking)
    message = report.message or "; ".join(part.note for part in edit.parts if part.note)
    return _Outcome(edit, reached and report.passed and report.result is None, blocking, message)


def _movers(context: bpy.types.Context, settings: EditSettings, changes: dict[str, Change]) -> list[Mover]:
    """What changed, by what was changed of it, and what has a role by which it gives way."""
    movers = []
    for ob in context.view_layer.objects:
        if not is_visible(context, ob) or settings.cage_of(ob.name) != ob.name:
            continue
        change = changes.get(ob.name)
        if change is None:
            mover = mover_of(ob, False, settings) if ob.mode == "OBJECT" else None
        else:
            points = "cage" if ob.type == "MESH" else "lattice"
            mover = Mover(ObjectReference.of(ob), "rigid" if change.points is None else points, True)
        movers += [] if mover is None else [mover]
    return once(movers)


def _responding(part: Part, changes: dict[str, Change], settings: EditSettings) -> Part:
    """A part in which the points that the tool moved respond as what is selected does."""
    change = changes.get(part.names[0])
    if change is None or change.points is None:
        return part
    moved = change.points[_followed_vertices(part, change)]
    return replace(
        part,
        weights=point_weights(moved, settings.weight(True), settings.weight(False), part.given),
        rule=PointGoal(moved, part.controls),
        note="" if part.tied is None else seam_note(part.names[0], change.points, part.tied),
    )


def _goal(part: Part, changes: dict[str, Change], present: SceneState, wanted: SceneState) -> Floats:
    """Where the tool put the controls of a part, (m, 3)."""
    change = next((changes[name] for name in part.names if name in changes), None)
    if change is None:
        return part.controls
    before, after = (states[change.reference.session_uid] for states in (present, wanted))
    if part.frame is not None and after.points is not None and change.points is not None:
        return transform_points(part.frame, after.points[_followed_vertices(part, change)])
    matrix = after.world @ np.linalg.inv(before.world)
    return part.rule.goal(part.controls, part.controls, Motion.of(matrix))


def _followed_vertices(part: Part, change: Change) -> Indices:
    """The vertex or point that each control follows, (m,): of a seam one that the tool moved."""
    assert change.points is not None
    if part.tied is None:
        return np.arange(len(change.points), dtype=np.int32)
    followed = part.tied.first.copy()
    moved = np.flatnonzero(change.points)[::-1].astype(np.int32)
    followed[part.tied.index[moved]] = moved
    return followed


def _steps(edit: BlenderEdit, goal: Floats) -> Iterator[Floats]:
    """The straight way to a goal in steps no longer than those of a drag."""
    start = edit.controls
    before = edit.surface
    moves = np.linalg.norm(edit.surface_of(goal) - before, axis=1)
    size = float(np.linalg.norm(np.ptp(before[moves > 0], axis=0))) if moves.any() else 0.0
    count = int(np.clip(np.ceil(moves.max() / (STEP * size)), 1, MOST_STEPS)) if size > 0 else 1
    for k in range(count - 1):
        yield start + (goal - start) * ((k + 1) / count)
    yield goal
