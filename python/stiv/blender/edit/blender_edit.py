# SPDX-License-Identifier: GPL-3.0-or-later
"""One edit of the open scene: begin, drag or apply, write, restore."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from typing import Any

import bpy
import numpy as np
from numpy.typing import ArrayLike

import stiv
from stiv.blender.controls.bone_set import BoneWriter, DressedWriter
from stiv.blender.controls.control_set import ControlSet, Participant
from stiv.blender.controls.motion import Motion
from stiv.blender.controls.participants import find_participants
from stiv.blender.controls.placement_writer import PlacementWriter
from stiv.blender.edit.cutting_start import start_as_one_steps
from stiv.blender.edit.edit_notes import EditNotes
from stiv.blender.edit.increments import Path, split_motion
from stiv.blender.edit.late_seams import LateSeams
from stiv.blender.edit.motion_goal import MotionGoal
from stiv.blender.edit.results import (
    intersecting_objects,
    round_to_storage,
    unguarded_result,
)
from stiv.blender.edit.sessions import restore_controls, split_controls, write_controls
from stiv.blender.edit.snapshot import EditSnapshot, find_moving_vertices, take_snapshot_steps
from stiv.blender.edit.solver import EditSolver
from stiv.blender.edit.standstill import objects_in_contact
from stiv.blender.edit.state_writer import StateWriter, TakenState, WriteReport
from stiv.blender.edit.summary import Summary, summarise
from stiv.blender.edit.touching_start import PartedStart, Parting, start_clear_steps
from stiv.blender.edit.typed_values import apply_increments
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.exclusions import intersects_itself
from stiv.blender.scene.obstacle_choice import find_obstacles
from stiv.blender.scene.stack_twin import kept_twins
from stiv.blender.scene.static_reading import forget_static_meshes
from stiv.blender.settings import EditSettings, check_kind
from stiv.task import Steps, run

Start = Callable[[Callable[..., Steps[EditSnapshot]]], Steps[PartedStart]]


def obstacles_beside(
    context: bpy.types.Context, settings: EditSettings, participants: Sequence[Participant]
) -> frozenset[str]:
    """The names of the objects that are obstacles beside the surface of an edit; empty if they are small."""
    reshaped = {each.reference.name for each in participants if each.role != "rigid"}
    obstacles = find_obstacles(context, [each.reference.find() for each in participants], reshaped, settings)
    if not obstacles:
        forget_static_meshes()
    return obstacles


class BlenderEdit:
    """An edit from the snapshot of the scene to the last state written. It holds no references to Blender's data
    between calls.

    Methods whose name ends with ``_steps`` return the same work for a stiv.blender.Task, which solves in jobs.

    Attributes:
        dropped_exclusions: message about excluded pairs that are stale; "" if there are none.
        guard: the evaluations that stay free of intersections.
        carried: names of the objects whose strands follow the moving objects, and are therefore no obstacles.
    """

    def __init__(
        self, snapshot: EditSnapshot, solver: EditSolver, late_seams: LateSeams, parting: Parting | None = None
    ) -> None:
        """solver: started from the snapshot. late_seams: begin the edit again where a seam opens. parting: made before
        the snapshot.
        """
        self._late_seams, self._parting = late_seams, parting
        self._begin_from(snapshot, solver)

    def _begin_from(self, snapshot: EditSnapshot, solver: EditSolver) -> None:
        """Take a start, and forget all that depends on another one."""
        settings = snapshot.settings
        self.dropped_exclusions, self._snapshot = snapshot.dropped_exclusions, snapshot
        self.guard, self.carried = snapshot.guard, snapshot.carried
        self._start, self._settings = snapshot.start, settings
        self._taken: TakenState | None = None
        self._began_free = settings.interference
        self._unguarded = None if settings.interference else self._start
        self._solver = solver
        self._goal = MotionGoal(solver, snapshot.control_sets, snapshot.start, settings)
        self._writer = StateWriter(snapshot.control_sets, solver, settings, snapshot.frame)
        self._notes = EditNotes(solver, snapshot.dropped_exclusions, settings.threads)
        self._moving_vertices = find_moving_vertices(solver.assembly, solver.control_sets)

    @classmethod
    def begin(cls, context: bpy.types.Context, settings: EditSettings, kind: str) -> BlenderEdit:
        """Read the scene for an edit of this kind ("move", "rotate", "scale").

        Changes nothing, except that selected objects which only touch others are parted from them, by about the
        rounding of their coordinates. `restore` restores that too.

        In large scenes, objects that certainly stay as they are become obstacles beside the surface.
        Raises InputError naming object, element and ways out, StartIntersectsError if the start intersects.
        """
        return run(cls.begin_steps(context, settings, kind))

    @classmethod
    def begin_steps(cls, context: bpy.types.Context, settings: EditSettings, kind: str) -> Steps[BlenderEdit]:
        """Steps of `begin`; the first ones read the scene."""
        check_kind(kind)
        participants = find_participants(context, settings)
        obstacles = obstacles_beside(context, settings, participants)
        return cls.begin_with_steps(
            context, settings, kind, participants, obstacles=obstacles, start=start_as_one_steps
        )

    @classmethod
    def begin_with(
        cls,
        context: bpy.types.Context,
        settings: EditSettings,
        kind: str,
        participants: Sequence[Participant],
        adapt: Callable[[ControlSet], ControlSet] = lambda control_set: control_set,
        obstacles: Collection[str] = (),
    ) -> BlenderEdit:
        """Begin with given participants. `adapt` may change the weights and goal rule of each control set.

        obstacles: names of objects that are obstacles beside the surface, of `obstacles_beside`.
        """
        return run(cls.begin_with_steps(context, settings, kind, participants, adapt, obstacles))

    @classmethod
    def begin_with_steps(
        cls,
        context: bpy.types.Context,
        settings: EditSettings,
        kind: str,
        participants: Sequence[Participant],
        adapt: Callable[[ControlSet], ControlSet] = lambda control_set: control_set,
        obstacles: Collection[str] = (),
        start: Start = start_clear_steps,
    ) -> Steps[BlenderEdit]:
        """Steps of `begin_with`. start: makes the steps that start a solver, from those that read the scene."""

        def read(torn: Sequence[Floats]) -> Steps[EditSnapshot]:
            chosen = [replace(each, torn=tuple(torn)) if each.role == "bones" else each for each in participants]
            return take_snapshot_steps(bpy.context, settings, kind, chosen, adapt, obstacles)

        with kept_twins():
            reading = partial(take_snapshot_steps, context, settings, kind, participants, adapt, obstacles)
            snapshot, solver, parting = yield from start(reading)
        return cls(snapshot, solver, LateSeams(read), parting)

    @property
    def start_digest(self) -> str:
        """Equal for edits that start with the same controls, moving surfaces and placements."""
        return self._snapshot.digest

    @property
    def summary(self) -> Summary:
        """The participants and their warnings. Examines every triangle, so a drag does not call it."""
        summary = summarise(self.assembly, self.control_sets, self._snapshot.hidden, self.guard)
        return replace(summary, warnings=(*self.start_notes, *summary.warnings))

    @property
    def keeps_intersections(self) -> bool:
        """Are there intersections that stay, and may only shrink?"""
        return len(self._solver.excluded) > 0

    def intersects_itself(self, name: str) -> bool:
        """Does an object of this name intersect itself at the start? It can then deform little."""
        return intersects_itself(self._solver.intersecting, name)

    @property
    def start_notes(self) -> tuple[str, ...]:
        """Notes about stale exclusions, intersections at the start, untested loose parts, seams, and shared meshes."""
        return self._notes.start_notes

    @property
    def fold_note(self) -> str:
        """The message on faces at joints that cut into each other now, and did not at the start; "" without any.

        Edits of bones do not test them (`EditSettings.joint_region`).
        """
        return self._notes.fold_note if self.interference else ""

    @property
    def torn_seam_note(self) -> str:
        """The message on faces at seams that the edit has torn, if they cut each other now; "" without any."""
        return self._notes.torn_seam_note if self.interference else ""

    @property
    def untested_notes(self) -> tuple[str, ...]:
        """The messages on faces that the edit does not test, if they cut each other now."""
        return tuple(note for note in (self.fold_note, self.torn_seam_note) if note)

    @property
    def passenger_note(self) -> str:
        """The message on selected objects without a surface that cannot move along; "" without any."""
        return self._notes.passenger_note

    def standstill_note(self, result: stiv.EditResult) -> str:
        """Why nothing has moved, from the last result; "" if something has, nothing was to move, or it is not known."""
        if self._unguarded is not None:
            return ""
        return self._notes.standstill_note(result, self.moving, self._start, self._goal)

    def objects_in_contact(self, result: stiv.EditResult) -> list[str]:
        """Names of the objects in contact in a result, those that do not move if there are any."""
        return objects_in_contact(result, self.assembly, self.moving)

    @property
    def reset_note(self) -> str:
        """The message on a placed object that its keyframes reset at the next frame; "" without any."""
        return self._notes.reset_note

    @property
    def control_sets(self) -> tuple[ControlSet, ...]:
        """The moving and yielding control sets, in the order of the controls."""
        return self._solver.control_sets

    @property
    def controls(self) -> Floats:
        """Accepted controls of all control sets, (m, 3); those of the goal while collisions are off."""
        return self._solver.session.controls if self._unguarded is None else self._unguarded

    @property
    def turned(self) -> float:
        """Largest angle, in radians, by which contact has turned a moving object whose goal has no rotation."""
        sets = self.control_sets
        rows = zip(sets, split_controls(self.controls, sets), split_controls(self.goal, sets), strict=True)
        return max((each.rule.turned(present, goal) for each, present, goal in rows), default=0.0)

    @property
    def surface(self) -> Floats:
        """Surface of `controls`, (N, 3)."""
        if self._unguarded is not None:
            return self._solver.deformation.surface(self._unguarded)
        return self._solver.session.surface

    def surface_of(self, controls: Floats) -> Floats:
        """Surface, (N, 3), of any controls, (m, 3), accepted or not; the accepted one if their topology differs."""
        with kept_twins():
            try:
                return self._solver.deformation.surface(controls)
            except stiv.InfeasibleError:
                return self.surface

    def least_distance(self) -> stiv.LeastDistance | None:
        """Least distance between objects in the accepted state; None without a session.

        While a job uses the session, that of the state that was taken last.
        """
        if not self._solver.has_session:
            return None
        try:
            return self._solver.session.least_distance()
        except stiv.InputError:
            if self._taken is None:
                raise
        obstacles = [each.obstacle for each in self.assembly.obstacles]
        return stiv.least_distance(self._taken.surface, self.assembly.surface, obstacles=obstacles)

    @property
    def assembly(self) -> Assembly:
        """Objects and faces of the surface, including the extra triangles of bent faces."""
        return self._solver.assembly

    @property
    def goal(self) -> Floats:
        """The goal of all controls, (m, 3)."""
        return self._goal.controls

    def aim_at(self, motion: Motion) -> None:
        """Take the goal of a motion without solving for it."""
        self._goal.controls = self._goal.controls_for(motion)

    def moving_points(self, controls: Floats) -> Floats:
        """The points of the surface, (n, 3), that follow the controls, (m, 3)."""
        return self.surface_of(controls)[self._moving_vertices]

    @property
    def moving(self) -> frozenset[str]:
        """Names of the objects whose surface follows the transform."""
        meshes = self.assembly.meshes
        return frozenset(
            meshes[index].owner.name
            for control_set in self.control_sets
            if control_set.rule.moves
            for index in control_set.surfaces
        )

    def resume_from(self, controls: ArrayLike, motion: Motion | ArrayLike | None = None) -> bool:
        """Resume from controls, (m, 3), that an edit with the same start accepted for a motion.

        Returns False, with nothing changed, if they intersect in this edit.
        """
        accepted = np.asarray(controls, np.float64)
        if accepted.shape != self._start.shape:
            return False
        if motion is not None:
            run(self._goal.limit_steps(self._goal.motion_of(motion)))
        if self._unguarded is not None:
            self._unguarded = accepted
            return True
        with kept_twins():
            try:
                self._solver.restart_from(accepted, accepted)
            except (stiv.InfeasibleError, stiv.StartIntersectsError):
                self._solver.restart_from(self._start, self._start)
                return False
        return True

    @property
    def interference(self) -> bool:
        """Are collisions on? Changed by `set_interference`."""
        return self._unguarded is None

    def set_interference(self, on: bool) -> str:
        """Switch collisions on or off; returns why the present state was rejected, or "".

        Off: drags reach their goals with the status "unguarded", and `write` tests nothing. On: the edit resumes from
        the present state if that is free of intersections, in Blender's evaluation too. Otherwise it returns to the
        last state before collisions were switched off, which the next `write` shows; without one, collisions stay off.
        Raises SceneChangedError.
        """
        if on == self.interference:
            return ""
        if not on:
            self._unguarded = self.controls
            return ""
        present, self._unguarded = self.controls, None
        last_accepted = self._solver.session.controls if self._solver.has_session else None
        try:
            self._solver.restart_from(present, self.goal)
            reason = self._writer.write_and_verify(present).message
        except stiv.StartIntersectsError as error:
            reason = f"{intersecting_objects(error.pairs, self.assembly)} intersect here"
        if not reason:
            return ""
        if last_accepted is None:
            self._solver.discard_session()
            self._unguarded = present
            return f"collisions stay off: {reason}"
        self._solver.restart_from(last_accepted, last_accepted)
        return f"back to the last state without intersections: {reason}"

    def drag(self, motion: Motion | ArrayLike, **execution: Any) -> stiv.EditResult:
        """Solve for an absolute goal: a motion, or its matrix (4, 4), of the selection since the start.

        `cancel` and `progress` are those of stiv.EditSession. Raises InputError if the matrix is not finite.
        """
        return run(self.drag_steps(motion, execution.pop("time_budget", None)), **execution)

    def drag_steps(
        self, motion: Motion | ArrayLike, time_budget: float | None = None, hand_over: float | None = None
    ) -> Steps[stiv.EditResult]:
        """Steps of `drag`; `time_budget` and `hand_over` are those of stiv.EditSession.drag."""
        chosen_motion = self._goal.motion_of(motion)
        yield from self._goal.limit_steps(chosen_motion)
        self.aim_at(chosen_motion)
        self._goal.motion = chosen_motion
        if self._unguarded is not None:
            self._unguarded = round_to_storage(self.control_sets, split_controls(self.goal, self.control_sets))
            return unguarded_result(self._solver.deformation, self._unguarded)
        with kept_twins():
            result = yield from self._solver.solve(self.goal, time_budget=time_budget, hand_over=hand_over)
            if not (yield from self._reopen(result)):
                return result
        return (yield from self.drag_steps(motion, time_budget, hand_over))

    def drag_to(self, goal: Floats, **execution: Any) -> stiv.EditResult:
        """Solve for a goal of all controls, (m, 3)."""
        return run(self.drag_to_steps(goal), **execution)

    def drag_to_steps(self, goal: Floats, time_budget: float | None = None) -> Steps[stiv.EditResult]:
        """Steps of `drag_to`; `time_budget` is that of stiv.EditSession.drag."""
        self._goal.controls = goal
        with kept_twins():
            result = yield from self._solver.solve(goal, time_budget=time_budget)
            if not (yield from self._reopen(result)):
                return result
        return (yield from self.drag_to_steps(goal, time_budget))

    def _reopen(self, result: stiv.EditResult) -> Steps[bool]:
        """Steps that begin again if an open seam stopped the edit. They return whether they did.

        An edit that began with collisions off does not: its start may intersect. If they are cancelled, the edit stays
        where the seam stopped it.
        """
        if not self._began_free:
            return False
        try:
            begun = yield from self._late_seams.begin_again_steps(self.control_sets, result)
        except stiv.CancelledError:  # Blender shows the start
            self._writer.write(self._solver.trail.written)
            return False
        if begun is not None:
            goal = self._goal
            self._begin_from(*begun)
            self._goal.controls, self._goal.motion = goal.controls, goal.motion
        return begun is not None

    def apply(self, motion: Motion | ArrayLike, path: Path | None = None, **execution: Any) -> stiv.EditResult:
        """Solve for a typed value: approach it in increments of the size of a drag's, then settle.

        Where contact holds bones for several increments, only the last one follows: each takes long, and they never
        go around an obstacle. A time budget of the settings limits the whole call; the result then has the status
        "budget".

        path: from fractions to matrices, for rotations of more than half a turn; None uses the shortest path.
        """
        return run(self.apply_steps(motion, path), **execution)

    def apply_steps(self, motion: Motion | ArrayLike, path: Path | None = None) -> Steps[stiv.EditResult]:
        """Steps of `apply`. If they are cancelled, the increments so far remain."""
        chosen_motion = self._goal.motion_of(motion)
        with kept_twins():
            increments = [*split_motion(chosen_motion, path, self.assembly.positions[self._moving_vertices])]
            is_pose = any(each.posed is not None for each in self.control_sets)
            return (yield from apply_increments(self, increments, is_pose, self._settings.time_budget))

    def settle(self, **execution: Any) -> stiv.EditResult:
        """Solve again toward the last goal."""
        return run(self.settle_steps(), **execution)

    def settle_steps(self) -> Steps[stiv.EditResult]:
        """Steps of `settle`."""
        if self._unguarded is not None:
            return unguarded_result(self._solver.deformation, self._unguarded)
        with kept_twins():
            return (yield from self._solver.solve(None))

    def confirm_steps(self) -> Steps[stiv.EditResult]:
        """Steps that confirm a settled drag: see stiv.EditSession.confirm."""
        if self._unguarded is not None:
            return unguarded_result(self._solver.deformation, self._unguarded)
        with kept_twins():
            return (yield from self._solver.confirm())

    def write(self) -> WriteReport:
        """Write the accepted controls, read Blender's evaluation back and test it (see `StateWriter`).

        Nothing is tested while collisions are off. Raises SceneChangedError if an object was removed or changed.
        """
        return run(self.write_steps())

    def write_steps(self, end: float | None = None) -> Steps[WriteReport]:
        """Steps of `write`; the scene shows the last written state between them.

        end: the deadline of solves that are repeated; None for one time budget from now.
        """
        if self._unguarded is not None:
            self._writer.write(self._unguarded)
            return WriteReport(True)
        with kept_twins():
            return (yield from self._writer.write_accepted(self.goal, end))

    def take_state(self) -> TakenState | None:
        """Take the accepted state, so that the next solve can begin before it is written.

        None if it must be written first: collisions are off, or solves evaluate stacks of modifiers in Blender.
        """
        evaluates = any(each.observed or each.placed or each.posed for each in self.control_sets)
        if self._unguarded is not None or evaluates:
            return None
        session = self._solver.session
        deviations = session.deviation_test(self._writer.threads_beside)
        self._taken = TakenState(
            session.controls, session.surface, self.goal, self._solver.trail, self.turned, deviations
        )
        return self._taken

    def write_taken(self, taken: TakenState) -> WriteReport | None:
        """Write a state that was taken while a job may use the session.

        None if it fails the test: call `write` when the session is free, or `write_shown`. Raises SceneChangedError.
        """
        return WriteReport(True) if self._writer.write_taken(taken) else None

    def write_shown(self) -> bool:
        """Return to the state that was shown before `write_taken` failed, while a job may use the session.

        Returns whether it passes the test again; otherwise call `write` when the session is free. Raises
        SceneChangedError.
        """
        return self._writer.write_shown()

    @contextmanager
    def start_shown(self) -> Iterator[None]:
        """Blender shows the start inside, and the present state again afterwards. Raises SceneChangedError."""
        present = self.controls
        self._show_start()
        try:
            yield
        finally:
            write_controls(self.control_sets, present, self._start)

    def finish(self) -> None:
        """Leave the session to the next edit, which uses it if nothing else changes. End the use of this edit."""
        self._solver.keep_session()

    def insert_keyframes(self, context: bpy.types.Context) -> None:
        """Insert keyframes for posed bones and placed objects, as Auto Keying does. Other controls get none."""
        for control_set in self.control_sets:
            if isinstance(control_set.writer, BoneWriter | DressedWriter | PlacementWriter):
                control_set.writer.insert_keyframes(context)

    def is_shown(self) -> bool:
        """Does Blender's present evaluation pass the test against the accepted state? Writes nothing."""
        return self._writer.verify(self.surface).passed

    def restore(self) -> None:
        """Restore the scene from before the edit exactly. Raises SceneChangedError.

        Collisions are off again if the edit began with them off.
        """
        self._show_start()
        self._goal.controls = self._start
        if self._unguarded is not None or not self._began_free:
            self._unguarded = self._start
        if self._began_free:
            self._solver.restart_from(self._start, self.goal)
        else:
            self._solver.discard_session()

    def _show_start(self) -> None:
        """Restore the scene from before the edit, which may differ from its start by a parting."""
        restore_controls(self.control_sets)
        if self._parting is not None:
            self._parting.restore()
