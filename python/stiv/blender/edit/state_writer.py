# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes accepted states into Blender, reads the evaluation back, and tests it."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain

import bpy
import numpy as np

import stiv
from stiv.blender.controls.control_set import ControlSet
from stiv.blender.edit.obstacle_watch import ObstacleWatch
from stiv.blender.edit.results import merge_results
from stiv.blender.edit.sessions import stack_controls, write_controls
from stiv.blender.edit.solver import EditSolver
from stiv.blender.edit.trail import AcceptedState, Trail, find_latest_steps, is_late
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.elements import FacePair
from stiv.blender.scene.near_assembly import NearAssembly, near_assembly
from stiv.blender.settings import EditSettings
from stiv.blender.verify.verification import Verification, Verifier
from stiv.deadlines import deadline_after, is_over
from stiv.task import Call, Steps

MAX_HALVINGS = 8  # of a step that fails the test in Blender's evaluation
MAX_FLIP_RETRIES = 4  # times that an edit is solved again because Blender flipped triangles of bent faces
FALLING_BACK_TIME = 0.5  # seconds after the deadline in which an older state that passes may be found
NUDGES = (2.0**-19, 2.0**-17)  # of the largest coordinate: 16 to 128 times its rounding in single precision


@dataclass(frozen=True)
class WriteReport:
    """The result of writing the accepted state.

    Attributes:
        passed: Blender shows the state, or one on the path to it, without intersections; False: the previous state.
        intersections: pairs that intersect in the state that was rejected.
        message: why the edit is not shown completely; "" if it is.
        result: of all calls since the last write if these were solved again; None otherwise.
    """

    passed: bool
    intersections: Sequence[FacePair] = ()
    message: str = ""
    result: stiv.EditResult | None = None


@dataclass(frozen=True)
class TakenState:
    """An accepted state, taken from the session before this solves on: it is written while a job uses the session.

    Attributes:
        controls: (m, 3), accepted.
        surface: (N, 3), of these controls.
        goal: of all controls, (m, 3), toward which they were solved.
        trail: that of the solver; another one if the edit has begun again since.
        turned: as `BlenderEdit.turned`.
        deviations: the test of surfaces that deviate from this one by rounding; None if the session has none.
    """

    controls: Floats
    surface: Floats
    goal: Floats
    trail: Trail
    turned: float
    deviations: stiv.DeviationTest | None = None


@dataclass(frozen=True)
class ShownState:
    """The last state that passed the test.

    Attributes:
        trail: that of the solver since then.
        controls: (m, 3), as written: those accepted, or nudged ones.
        surface: (N, 3), as accepted.
        deviations: as in TakenState.
    """

    trail: Trail
    controls: Floats
    surface: Floats
    deviations: stiv.DeviationTest | None


def nudged(controls: Floats, last: Floats) -> Iterator[Floats]:
    """Controls, (m, 3), that are a few roundings nearer to the last ones.

    Where surfaces nearly touch, it depends on rounding whether they intersect in Blender's evaluation.
    """
    size = float(np.abs(controls).max(initial=0.0))
    for nudge in NUDGES:
        reach = nudge * size
        yield np.asarray(controls + np.clip(last - controls, -reach, reach), np.float64)


class StateWriter:
    """Writes solved states. Only states that pass the test in Blender's evaluation remain."""

    def __init__(
        self, control_sets: Sequence[ControlSet], solver: EditSolver, settings: EditSettings, frame: float
    ) -> None:
        """Take the control sets of an edit in their present state, and its solver. frame: of the start."""
        self._watch = ObstacleWatch(frame)
        self._start = stack_controls([each.controls for each in control_sets])
        self._solver = solver
        self._settings = settings
        self._near: NearAssembly | None = None
        self._verifier: Verifier | None = None
        self._verifier_beside: Verifier | None = None
        self._shown: ShownState | None = None
        self._check_beside: stiv.StepCheck | None = None  # of `_verifier_beside`
        self._deviations: stiv.DeviationTest | None = None  # of the state that is being tested beside a solve

    def write_taken(self, taken: TakenState) -> bool:
        """Write a state that was taken from the session, and test Blender's evaluation without the session.

        Returns whether the state remains. Otherwise `write_accepted` must follow once the session is free. Raises
        SceneChangedError if an object was removed or changed.
        """
        if self._solver.trail is not taken.trail:
            return False
        for controls in chain((taken.controls,), nudged(taken.controls, taken.trail.written)):
            self.write(controls)
            if self._is_free_beside(taken.surface, taken.deviations):
                self._solver.trail = Trail(taken.controls, taken.goal)
                self._shown = ShownState(self._solver.trail, controls, taken.surface, taken.deviations)
                return True
        return False

    def write_shown(self) -> bool:
        """Write the last state that passed again, while a job may use the session, and test it again.

        Returns whether it remains. Otherwise `write_accepted` must follow. Raises SceneChangedError.
        """
        shown = self._shown
        if shown is None or shown.trail is not self._solver.trail:
            return False
        self.write(shown.controls)
        return self._is_free_beside(shown.surface, shown.deviations)

    def write_accepted(self, goal: Floats, end: float | None = None) -> Steps[WriteReport]:
        """Steps that write the accepted controls, test Blender's evaluation, and start a new trail to the same goal.

        Blender flips the diagonal of quads that bend far. If that causes intersections, both triangulations are kept
        free from then on, and the path since the last write is solved again. If the test still fails, the last state on
        the path that passes is written. Between steps, the scene shows the last written state. Raise SceneChangedError
        if an object was removed or changed.

        end: the deadline; None for one time budget from now. Then, or cancelled, they search no longer for the last
        such state, and take the best that is known.
        """
        end = deadline_after(self._settings.time_budget) if end is None else end
        verification = self._write_session()
        solved: list[stiv.EditResult] = []
        for _ in range(MAX_FLIP_RETRIES):
            if verification.passed or (solved and is_over(end)):
                break
            self.write(self._solver.trail.written)
            try:
                results = yield from self._solver.retry_with(verification.flips, end)
            except stiv.CancelledError:  # while the session with the flips was made; the old one stays
                results = None
            if results is None:
                break
            solved = results
            verification = self._write_session()
        result = merge_results(solved) if solved else None
        if not verification.passed and not (yield from self._passes_nudged(goal, end)):
            return (yield from self._fall_back(goal, verification, result, end))
        session = self._solver.session
        self._solver.trail = Trail(session.controls, goal)
        deviations = session.deviation_test(self.threads_beside)
        self._shown = ShownState(self._solver.trail, session.controls, session.surface, deviations)
        return WriteReport(True, result=result)

    def _passes_nudged(self, goal: Floats, end: float) -> Steps[bool]:
        """Steps that accept a state that differs by rounding, and write it; they return whether it passes the test."""
        session, last = self._solver.session, self._solver.trail.written
        for controls in nudged(session.controls, last):
            self.write(last)
            if (yield from is_late(end)):
                return False
            yield Call(session.edit, session.start_edit, controls)
            if self._write_session().passed:
                self._solver.restart_from(session.controls, goal)
                return True
        return False

    def _write_session(self) -> Verification:
        self.write(self._solver.session.controls)
        return self.verify(self._solver.session.surface)

    def write_and_verify(self, controls: Floats) -> Verification:
        """Write controls, (m, 3), whose surface is free of intersections, and test Blender's evaluation."""
        self.write(controls)
        return self.verify(self._solver.deformation.surface(controls))

    def verify(self, accepted: Floats) -> Verification:
        """Test Blender's present evaluation against a surface, (N, 3), that is free of intersections."""
        if message := self._watch.message(bpy.context, self._solver.assembly.obstacles):
            return Verification(False, (), message)
        near = self._near_of(accepted)
        excluded, touching = self._solver.excluded, self._solver.touching
        if self._verifier is None or not self._verifier.tests(near.assembly, excluded, touching):
            self._verifier = self._new_verifier(near)
        return self._verifier.verify(bpy.context, near.extended(accepted))

    def write(self, controls: Floats) -> None:
        """Write controls, (m, 3), and update Blender's evaluation; nothing is tested."""
        write_controls(self._solver.control_sets, controls, self._start)

    def _near_of(self, surface: Floats) -> NearAssembly:
        """The assembly near a surface, (N, 3)."""
        self._near = near_assembly(self._solver.assembly, surface)
        return self._near

    def _new_verifier(self, near: NearAssembly) -> Verifier:
        count = len(near.whole.positions)

        def is_step_free(start: Floats, end: Floats) -> bool:
            return self._solver.session.is_step_free(start[:count], end[:count])  # the session reads the obstacles

        excluded, touching = self._solver.excluded, self._solver.touching
        return Verifier(near.assembly, is_step_free, self._settings.threads, excluded, touching)

    @property
    def threads_beside(self) -> int:
        """Threads of tests beside a solve, which needs one."""
        return max(1, (self._settings.threads or os.cpu_count() or 1) - 1)

    def _is_free_beside(self, accepted: Floats, deviations: stiv.DeviationTest | None) -> bool:
        """Test what Blender shows exactly without the session, and not the path to it.

        That path is as long as rounding, and leads nowhere: solves continue from the accepted state.
        """
        if self._watch.message(bpy.context, self._solver.assembly.obstacles):
            return False
        near, excluded, touching = self._near_of(accepted), self._solver.excluded, self._solver.touching
        if self._verifier_beside is None or not self._verifier_beside.tests(near.assembly, excluded, touching):
            self._check_beside = None
            self._verifier_beside = Verifier(
                near.assembly, self._is_end_free, self.threads_beside, excluded, touching, names_pairs=False
            )
        self._deviations = deviations
        return self._verifier_beside.verify(bpy.context, near.extended(accepted)).passed

    def _is_end_free(self, accepted: Floats, shown: Floats) -> bool:
        """The pairs near each other in the accepted state decide, or a search if the shown one deviates by more."""
        is_free = None if self._deviations is None else self._deviations.is_free(shown)
        if is_free is not None:
            return is_free
        if self._check_beside is None:
            assert self._verifier_beside is not None
            self._check_beside = stiv.StepCheck(self._verifier_beside.assembly.surface, self.threads_beside)
        return self._check_beside.is_end_free(accepted, shown)

    def _fall_back(
        self, goal: Floats, failure: Verification, result: stiv.EditResult | None, end: float
    ) -> Steps[WriteReport]:
        """Steps that write the last state of the trail that passes the test, or one on the step after it."""
        states = self._solver.trail.states()
        end = max(end, deadline_after(FALLING_BACK_TIME))
        state = yield from find_latest_steps(states[:-1], self._passes, end)
        if state is not None and state.call < 0 and failure.intersections:
            state = yield from self._bisect_step(goal, state, states[1], end)
        controls = states[0].controls if state is None else state.controls
        self.write(controls)
        self._solver.restart_from(controls, goal)
        on_the_way = state is not None and state.call >= 0
        message = f"stopped early: {failure.message}" if on_the_way else failure.message
        return WriteReport(on_the_way, failure.intersections, message, result)

    def _passes(self, state: AcceptedState) -> bool:
        """Does a state pass the test in Blender's evaluation? The last written state is shown afterwards."""
        passed = self.write_and_verify(state.controls).passed
        self.write(self._solver.trail.written)
        return passed

    def _bisect_step(self, goal: Floats, first: AcceptedState, last: AcceptedState, end: float) -> Steps[AcceptedState]:
        """Steps that bisect a step for a state that passes in Blender's evaluation; its first one if there is none."""
        for halvings in range(1, MAX_HALVINGS + 1):
            if (yield from is_late(end)):
                return first
            self._solver.restart_from(first.controls, goal)
            session = self._solver.session
            between = first.controls + (last.controls - first.controls) / 2**halvings
            yield Call(session.edit, session.start_edit, between)
            state = AcceptedState(session.controls, last.call, last.step)
            if not np.array_equal(state.controls, first.controls) and self._passes(state):
                return state
        return first
