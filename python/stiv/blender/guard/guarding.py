# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the result of any tool: corrects changes, places new objects, and names the rest."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

import bpy
import numpy as np

from stiv import InputError, StartIntersectsError
from stiv.blender.guard.accepted_scene import AcceptedScene
from stiv.blender.guard.changes import Changes, compare
from stiv.blender.guard.correction import ToolCorrection, correct_but_known_steps, correction_deadline
from stiv.blender.guard.entering import (
    correct_copies,
    correct_extrusion,
    correct_part,
    find_copied,
    find_in_place,
    find_originals,
    place_freely,
    place_part_freely,
    touches_others,
)
from stiv.blender.guard.known_intersections import (
    find_intersections,
    find_intersections_steps,
    fresh_objects,
    object_pair,
)
from stiv.blender.guard.new_parts import find_new_part, joins_others
from stiv.blender.guard.pose_correction import correct_poses_steps
from stiv.blender.guard.scene_state import SceneState, read_object, read_state, revert
from stiv.blender.scene.elements import FacePair
from stiv.blender.scene.mesh_reading import read_edges
from stiv.blender.scene.references import ObjectReference, SceneChangedError
from stiv.blender.settings import EditSettings
from stiv.deadlines import is_over
from stiv.task import Left, Steps, run


@dataclass
class GuardedResult:
    """A tool's result after the guard.

    Attributes:
        wrote: does the scene differ from the tool's result?
        corrected, placed: names of the objects that an edit corrected, and of new ones put at the nearest free place.
        blocking: names of the objects in contact.
        cut: names of the objects that moved, if a correction stopped where the topology of one changes.
        stopped: did a correction end at the deadline, short of the tool's result?
        notes: about faces that no correction tests and that cut each other now.
        pairs: the intersections that are left, without excluded pairs.
        reason: why a change was not corrected; "" otherwise.
        deformers: see `ToolCorrection`.
    """

    wrote: bool = False
    corrected: list[str] = field(default_factory=list)
    placed: list[str] = field(default_factory=list)
    blocking: list[str] = field(default_factory=list)
    cut: tuple[str, ...] = ()
    stopped: bool = False
    notes: list[str] = field(default_factory=list)
    pairs: Sequence[FacePair] = ()
    reason: str = ""
    deformers: tuple[str, ...] = ()

    def add(self, outcome: ToolCorrection | None) -> None:
        """Add a correction."""
        if outcome is None:
            return
        self.notes += [note for note in outcome.notes if note not in self.notes]
        if outcome.corrected:
            self.wrote, self.cut, self.stopped = True, self.cut or outcome.cut, self.stopped or outcome.stopped
            self.corrected += [name for name in outcome.names if name not in self.corrected]
            self.blocking += [name for name in outcome.blocking if name not in self.blocking]


def guard_result(context: bpy.types.Context, settings: EditSettings, accepted: AcceptedScene) -> GuardedResult:
    """Correct the present scene, starting from the accepted one. All intersections that are left are in `pairs`.

    New objects and extrusions that intersect are corrected or placed. Objects that were only shown stay where they are.
    Raises InputError if the scene cannot be read.
    """
    return run(guard_result_steps(context, settings, accepted))


def guard_result_steps(
    context: bpy.types.Context, settings: EditSettings, accepted: AcceptedScene
) -> Steps[GuardedResult]:
    """Steps of `guard_result`, which end soon after the time budget of the settings.

    Between steps, the scene may show the accepted state. Steps that are closed leave the tool's result. Those ended by
    Left do so only if objects were added or changed their structure; `revert` restores all others.
    """
    end = correction_deadline(settings)
    present = read_state(context)
    changes = compare(accepted.state, present)
    guard = _Guard(context, settings, accepted, present, changes, end, GuardedResult(reason=changes.unsupported))
    try:
        yield from guard.correct()
        return guard.result
    except (GeneratorExit, Left) as ending:
        if changes.unsupported or not isinstance(ending, Left):
            with suppress(InputError, SceneChangedError):
                revert(context, present)
        raise


@dataclass(frozen=True)
class _Guard:
    """Corrects a tool's result until a deadline.

    Attributes:
        present: the tool's result.
        changes: from the accepted state to it.
        end: the deadline.
        result: filled by the corrections.
    """

    context: bpy.types.Context
    settings: EditSettings
    accepted: AcceptedScene
    present: SceneState
    changes: Changes
    end: float
    result: GuardedResult

    def correct(self) -> Steps[None]:
        """Steps that correct the scene; the intersections that are left are in the result."""
        changes, result = self.changes, self.result
        start = self.accepted.state
        if changes.unsupported:
            result.pairs = yield from find_intersections_steps(self.context, self.settings)
            yield None
            yield from self._correct_new_geometry()
            start = _start_of(changes, self.accepted.state, read_state(self.context))
        if changes.posed and changes.changes:
            _restore_poses(self.context, self.accepted.state, changes.posed)
        if changes.changes and not (yield from self._correct_overlapping_part()):
            yield from self._correct_moved(start)
        if changes.posed:
            yield from self._correct_poses()
        tested = changes.unsupported and not changes.changes and not result.wrote
        followed = changes.changes or changes.posed
        if not tested and (not followed or result.reason or result.deformers or self.accepted.known.pairs):
            yield None
            result.pairs = yield from find_intersections_steps(self.context, self.settings)

    def _correct_overlapping_part(self) -> Steps[bool]:
        """Steps that correct a translation of whole components of a mesh that intersects itself.

        False if it is something else.
        """
        if self.changes.unsupported or len(self.changes.changes) != 1:
            return False
        change = self.changes.changes[0]
        reference, part = change.reference, change.points
        before = self.accepted.state[reference.session_uid].points
        if part is None or before is None or (reference.name, reference.name) not in self.accepted.known.objects:
            return False
        ob = reference.find()
        if ob.type != "MESH" or joins_others(read_edges(ob.data), part):
            return False
        corrected = yield from correct_part(
            self.context, self.settings, self.accepted.known, reference, part, before[part], self.end
        )
        if corrected:
            self.result.wrote = True
            self.result.corrected.append(reference.name)
        return corrected is not None

    def _correct_moved(self, start: SceneState) -> Steps[None]:
        supported = replace(self.changes, unsupported="")
        try:
            outcome = yield from correct_but_known_steps(
                self.context, self.settings, self.accepted.known, start, supported, self.end
            )
        except (InputError, SceneChangedError) as error:
            self.result.reason = str(error)
            return
        self.result.deformers = outcome.deformers
        self.result.add(outcome)

    def _correct_poses(self) -> Steps[None]:
        """Correct poses and values of shape keys, from the accepted ones toward those of the tool."""
        left_out = self.accepted.known.left_out(self.settings)
        try:
            outcome = yield from correct_poses_steps(
                self.context, left_out, self.accepted.state, self.present, self.changes.posed, self.end
            )
        except (InputError, SceneChangedError) as error:
            self.result.reason = self.result.reason or str(error)
            return
        self.result.add(outcome)

    def _correct_new_geometry(self) -> Steps[None]:
        """Correct extrusions and new objects that intersect, by the pairs of the result."""
        fresh = self.accepted.known.fresh(self.result.pairs)
        names = {name for pair in fresh for name in object_pair(pair)}
        created = {each.name: each for each in self.changes.added if each.session_uid not in self.accepted.objects}
        try:
            for reference in _users_of_meshes(self.changes.rebuilt, names):
                yield None
                if is_over(self.end):
                    break
                yield from self._correct_rebuilt(reference)
            if touches_others(fresh, created):
                entering = [created[name].session_uid for name in sorted(names & created.keys())]
                yield from self._correct_new_objects(set(created), entering, fresh)
        except (InputError, SceneChangedError) as error:
            self.result.reason = str(error)

    def _correct_rebuilt(self, reference: ObjectReference) -> Steps[None]:
        """Correct an extrusion, or a part that was added and did not come from an object that is gone, as in Join."""
        context, settings, accepted, end = self.context, self.settings, self.accepted, self.end
        before, after = accepted.state[reference.session_uid], read_object(reference.find())
        added = None if self.changes.removed else find_new_part(before, after, read_edges(reference.find().data))
        if added is None:
            self.result.add((yield from correct_extrusion(context, settings, accepted, reference, end)))
            return
        source, known, corrected = find_copied(accepted, reference, added), accepted.known, False
        if source is not None and after.points is not None:
            origins = after.points[source]
            if np.array_equal(after.points[added], origins):
                self.result.reason = f"{reference.name}: the copy is in the place of its source; move it"
                return
            corrected = bool((yield from correct_part(context, settings, known, reference, added, origins, end)))
        is_left = reference.name in fresh_objects(context, settings, known)
        placed = is_left and (yield from place_part_freely(context, settings, known, reference, added, end))
        self.result.wrote |= corrected or placed
        if placed or corrected:
            (self.result.placed if placed else self.result.corrected).append(reference.name)

    def _correct_new_objects(self, created: set[str], entering: list[int], fresh: Sequence[FacePair]) -> Steps[None]:
        """Correct copies from the places of their originals, then place new objects that still intersect.

        created: names of all new objects. entering: session numbers of those that intersect. fresh: their
        intersections.
        """
        context, settings, accepted = self.context, self.settings, self.accepted
        present = read_state(context)
        in_place = find_in_place(accepted, present, entering)
        if in_place is not None:
            self.result.reason = "{}: is in the place of {}; move it".format(*in_place)
            return
        originals = find_originals(accepted, present, entering)
        through = {
            frozenset({present[copy].reference.name, accepted.state[original].reference.name})
            for copy, original in originals.items()
        }
        blocking = [pair for pair in fresh if frozenset(object_pair(pair)) not in through]
        if originals and touches_others(blocking, created):
            with suppress(StartIntersectsError):  # what the copy passes there, its original does not
                self.result.add((yield from correct_copies(context, settings, accepted, originals, self.end)))
            yield None
            if not touches_others(accepted.known.fresh(find_intersections(context, settings)), created):
                return
        if (yield from place_freely(context, settings, accepted.known, created, self.end)):
            self.result.wrote = True
            self.result.placed += sorted(created)


def _start_of(changes: Changes, accepted: SceneState, present: SceneState) -> SceneState:
    """The present state, with moved objects at their accepted places."""
    moved = {each.reference.session_uid for each in changes.changes}
    return {number: accepted[number] if number in moved else state for number, state in present.items()}


def _restore_poses(context: bpy.types.Context, state: SceneState, posed: Sequence[ObjectReference]) -> None:
    """Restore accepted poses, from which other changes are corrected first."""
    for reference in posed:
        state[reference.session_uid].pose.restore(reference.find())
    context.view_layer.update()


def _users_of_meshes(references: Sequence[ObjectReference], names: Collection[str]) -> list[ObjectReference]:
    """The first named user of each mesh: its correction is that of all."""
    found: dict[int, ObjectReference] = {}
    for reference in references:
        ob = reference.find()
        if reference.name in names and ob.type == "MESH":
            found.setdefault(ob.data.session_uid, reference)
    return list(found.values())
