# SPDX-License-Identifier: GPL-3.0-or-later
"""The session of an edit with its history; opened again when flipped triangles have to stay free of intersections."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import stiv
from stiv.blender.controls.control_set import ControlSet
from stiv.blender.controls.garments import stacked_weights
from stiv.blender.edit.kept_session import SessionInputs, keep_session, take_session
from stiv.blender.edit.sessions import (
    axes_of_all,
    deformation_of,
    make_session,
    session_options,
    stack_controls,
)
from stiv.blender.edit.snapshot import EditSnapshot, Names
from stiv.blender.edit.trail import AcceptedState, Trail, find_latest_steps
from stiv.blender.excluded_faces import Exclusions
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.exclusions import exclude_undecided, has_only_excluded, pairs_of_objects, with_touching
from stiv.blender.scene.loose_parts import find_touching_parts, loose_part_notes, without_loose_parts
from stiv.blender.scene.triangulation_flips import FaceTriangles, add_triangles, guard_bent_quads
from stiv.blender.settings import EditSettings
from stiv.deadlines import is_over, time_left
from stiv.task import Call, Steps, Turns, run

LAST_DRAG_TIME = 0.5  # seconds in which the last drag is solved again after the deadline
CALLS = 4  # of a session between two Jacobians of observed stacks


class SelectionCutsItselfError(Exception):
    """Objects that move rigidly cut each other at the start, and do not move as one yet.

    pairs: of their names, with those that were given.
    """

    def __init__(self, pairs: frozenset[Names]) -> None:
        super().__init__(pairs)
        self.pairs = pairs


class EditSolver:
    """Attributes: `control_sets`, `assembly` with the extra triangles of bent faces, and the `trail`.

    intersecting: the excluded pairs of the settings, and those at the start that needed no decision.
    excluded: the same with pairs beside them that touch at the start.
    touching: pairs of different objects that only touch at the start.
    loose_part_notes: notes on loose edges and vertices that are left out.
    """

    def __init__(
        self,
        assembly: Assembly,
        control_sets: Sequence[ControlSet],
        controls: Floats,
        settings: EditSettings,
        cutting: frozenset[Names] | None = None,
        may_touch: bool = False,
    ) -> None:
        """Take the controls of all control sets at the start, (m, 3). Call `start` before anything else.

        cutting, may_touch: see `EditSnapshot`.
        """
        self.control_sets = tuple(control_sets)
        self._settings = settings
        self._cutting = cutting if settings.interference else None
        self._may_touch, self._touches = may_touch, False
        self.intersecting = self.excluded = settings.excluded
        self.touching = Exclusions()
        self.loose_part_notes: tuple[str, ...] = ()
        self._session: stiv.EditSession | None = None
        self._inputs: SessionInputs | None = None  # of the session, if the next edit may use it
        self._blocked, self._calls = False, 0
        self._at_start = self.assembly = assembly
        self._deformation: stiv.Deformation | None = None  # a kept session has its own
        self.trail = Trail(controls, controls)

    def start(self) -> Steps[None]:
        """Steps that open the session, if collisions are on.

        Raise InputError, StartIntersectsError, and SelectionCutsItselfError for other pairs than those of `cutting`.
        """
        if self._settings.interference:
            turns = Turns()
            self._at_start = guard_bent_quads(self.assembly, self._settings.threads)
            yield from turns.take()
            yield from self._open_session(self._at_start, self.trail.written)
        self._cutting = None  # from now on, no other start is possible

    @property
    def deformation(self) -> stiv.Deformation:
        """Deformation of the surface by the controls of all control sets."""
        if self._deformation is None:
            self._deformation = deformation_of(self.assembly, self.control_sets)
        return self._deformation

    @property
    def has_session(self) -> bool:
        """Is a state known to be free of intersections?"""
        return self._session is not None

    @property
    def touching_others(self) -> list[Names]:
        """The names of an object that moves and one that does not, for each two that touch, ascending."""
        moving = self._moving(self.assembly)
        return sorted(pair for pair in pairs_of_objects(self.touching) if len(moving.intersection(pair)) == 1)

    @property
    def session(self) -> stiv.EditSession:
        """The open session; there is none until collisions are on."""
        assert self._session is not None, "collisions were off from the start"
        return self._session

    def solve(self, goal: Floats | None, **limits: Any) -> Steps[stiv.EditResult]:
        """Steps that drag to a goal, (m, 3), or settle (None); the limits of a drag are those of stiv.EditSession."""
        session = self.session
        if goal is None:
            return (yield from self._carry_out(None, Call(session.settle, session.start_settle)))
        return (yield from self._carry_out(goal, Call(session.drag, session.start_drag, goal, **limits)))

    def confirm(self) -> Steps[stiv.EditResult]:
        """Steps that confirm a settled drag; see stiv.EditSession.confirm."""
        return (yield from self._carry_out(None, Call(self.session.confirm, self.session.start_confirm)))

    def _carry_out(self, goal: Floats | None, call: Call[stiv.EditResult]) -> Steps[stiv.EditResult]:
        self._renew_jacobians()
        result: stiv.EditResult = yield call
        if result.status != "cancelled":  # its goal is no longer wanted
            self.trail.add(goal, result)
        self._blocked = result.status == "blocked"
        return result

    def _renew_jacobians(self) -> None:
        """Renew the Jacobians of observed stacks sometimes, and after a blocked call, at the accepted state."""
        self._calls += 1
        sets = self.control_sets
        observed = [each for made in sets for each in (made.observed, made.placed, made.posed)]
        stacks = [each for each in observed if each is not None]
        if stacks and (self._blocked or self._calls % CALLS == 0):
            self.deformation.surface(self.session.controls)
            for each in stacks:
                each.renew_jacobian()

    def discard_session(self) -> None:
        """Close the session: no state is known to be free of intersections."""
        self._session = None

    def change_response(self, control_sets: Sequence[ControlSet]) -> Steps[None]:
        """Steps that change the response of the same controls; from their start if they deform in another way."""
        pairs = zip(self.control_sets, control_sets, strict=True)
        deforms_alike = all(before.deformation is after.deformation for before, after in pairs)
        before, self.control_sets = self.control_sets, tuple(control_sets)
        if deforms_alike:
            if self._session is not None:
                weights = stacked_weights([each.weights for each in control_sets])
                self._session.set_weights(weights, axes_of_all(control_sets))
            return
        start = stack_controls([each.controls for each in control_sets])
        if self._session is None:
            self._deformation = None
        else:
            try:
                yield from self._open_session(self._at_start, start)
            except BaseException:  # cancelled between steps, or refused: the old session stays
                self.control_sets = before
                raise
        self.trail = Trail(start, start)

    def restart_from(self, controls: Floats, goal: Floats) -> None:
        """Start a new trail at accepted controls, which may be older than the present extra triangles.

        Raises StartIntersectsError, with nothing changed, if the controls intersect.
        """
        try:
            if self._session is None:
                run(self._open_session(self.assembly, controls))
            self.session.restore(controls, goal)
        except stiv.StartIntersectsError:
            if self._session is None or self.assembly is self._at_start:
                raise
            run(self._open_session(self._at_start, controls))
            self.session.restore(controls, goal)
        self.trail = Trail(controls, goal)

    def retry_with(self, flips: Sequence[FaceTriangles], end: float) -> Steps[list[stiv.EditResult] | None]:
        """Steps that add flipped triangles, go back to the last state that is free with them, and repeat the later
        calls from there; after the deadline `end`, only the last drag, and that shortly.

        They return the results of all calls since the last written state, those that were cancelled as well; or None,
        with nothing changed, if there are no flips, or no state of the trail is free with them.
        """
        if not flips:
            return None
        assembly = add_triangles(self.assembly, flips)

        def is_free(state: AcceptedState) -> bool:
            q = self.deformation.surface(state.controls)
            return has_only_excluded(self.excluded, self.touching, assembly, q, self._settings.threads)

        state = yield from find_latest_steps(self.trail.states(), is_free, end)
        if state is None:
            return None
        goal = self.trail.goal_at(state)
        yield from self._open_session(assembly, state.controls)
        self.session.restore(state.controls, goal)
        calls = self.trail.truncate_at(state)
        results = [call.result for call in self.trail.calls]
        last = max((number for number, call in enumerate(calls) if call.goal is not None), default=0)
        for number, call in enumerate(calls):
            is_late = is_over(end)
            if number == last or not is_late:
                budget = min(LAST_DRAG_TIME, self._settings.time_budget) if is_late else time_left(end)
                results.append((yield from self.solve(call.goal, time_budget=budget or None)))
        return results

    def _open_session(self, assembly: Assembly, controls: Floats) -> Steps[None]:
        """Open a session. At its first start, objects may intersect themselves and those that move with them, and
        perhaps touch others.
        """
        make_deformation = cache(lambda: deformation_of(assembly, self.control_sets))
        try:
            opened = yield from self._make_session(assembly, make_deformation, controls)
        except stiv.StartIntersectsError as error:
            if self._session is not None:
                raise
            moving = self._moving(assembly)
            turns = Turns()
            pairs = exclude_undecided(self._settings.excluded, assembly, error.pairs, moving)
            self._check_cutting(assembly, pairs)
            self.intersecting = self.excluded = pairs
            self._touches = self._may_touch
            yield from turns.take()
            loose = find_touching_parts(assembly, moving, self._settings.threads)
            yield from turns.take()
            self.loose_part_notes = loose_part_notes(assembly, loose)
            self._at_start = assembly = without_loose_parts(assembly, loose)
            opened = yield from self._make_session(assembly, make_deformation, controls)
        (self._session, self._deformation), self.assembly = opened, assembly
        self.excluded, self.touching = with_touching(
            self.excluded, assembly, self.session.excluded, self._moving(assembly)
        )

    def _check_cutting(self, assembly: Assembly, pairs: Exclusions) -> None:
        """Raise SelectionCutsItselfError for pairs that should move as one."""
        if self._cutting is None:
            return
        rigid = _moved_by(assembly, [each for each in self.control_sets if each.role == "rigid" and not each.placed])
        found = frozenset(pair for pair in pairs_of_objects(pairs) if rigid.issuperset(pair))
        if not found <= self._cutting:
            raise SelectionCutsItselfError(found | self._cutting)

    def _make_session(
        self, assembly: Assembly, make_deformation: Callable[[], stiv.Deformation], controls: Floats
    ) -> Steps[tuple[stiv.EditSession, stiv.Deformation]]:
        settings = replace(self._settings, excluded=self.excluded)
        options = session_options(assembly, make_deformation, self.control_sets, controls, settings, self._touches)
        self._inputs = None if self._is_changing() else SessionInputs.of(assembly, self.control_sets, options)
        kept = None if self._inputs is None else take_session(self._inputs, controls)
        if kept is not None:
            return kept
        deformation = make_deformation()
        return (yield from make_session(assembly, deformation, controls, options)), deformation

    def _is_changing(self) -> bool:
        """Does the session depend on more than its inputs: exclusions of the start, or values of Blender?"""
        sets = self.control_sets
        return len(self.excluded) > 0 or any(each.observed or each.placed or each.posed for each in sets)

    def keep_session(self) -> None:
        """Leave the session to the next edit. This solver must not be used any more."""
        if self._session is not None and self._inputs is not None and not len(self.touching):
            weights = stacked_weights([each.weights for each in self.control_sets])
            options = replace(self._inputs.options, weights=weights, weight_axes=axes_of_all(self.control_sets))
            keep_session(replace(self._inputs, options=options), self._session, self.deformation)
        self._session = None

    def _moving(self, assembly: Assembly) -> set[str]:
        """Names of the objects that the goal moves."""
        return _moved_by(assembly, self.control_sets)


def _moved_by(assembly: Assembly, control_sets: Sequence[ControlSet]) -> set[str]:
    """Names of the objects that these control sets move to a goal."""
    moving = (each for each in control_sets if each.rule.moves)
    return {assembly.meshes[index].owner.name for each in moving for index in each.surfaces}


def start_solver_steps(snapshot: EditSnapshot) -> Steps[EditSolver]:
    """Steps that start a solver from a snapshot. Raise what `EditSolver.start` raises."""
    solver = EditSolver(
        snapshot.assembly, snapshot.control_sets, snapshot.start, snapshot.settings, snapshot.cutting,
        snapshot.may_touch,
    )  # fmt: skip
    yield from solver.start()
    return solver
