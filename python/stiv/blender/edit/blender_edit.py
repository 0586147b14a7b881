# SPDX-License-Identifier: GPL-3.0-or-later
"""One edit of the open scene: begin, drag or apply, write, restore."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import bpy
import numpy as np
from numpy.typing import ArrayLike, NDArray

import stiv
from stiv.blender.controls.control_set import Part
from stiv.blender.controls.motion import Influence, Motion
from stiv.blender.controls.movers import Mover
from stiv.blender.controls.participants import find_movers
from stiv.blender.edit.increments import motions_toward
from stiv.blender.edit.results import summed
from stiv.blender.edit.sessions import split, stacked
from stiv.blender.edit.snapshot import Beginning, moving_vertices, read_beginning
from stiv.blender.edit.solver import Solving
from stiv.blender.edit.state_writer import Showing, WriteReport
from stiv.blender.edit.summary import Summary, summarise
from stiv.blender.edit.transform_path import Path
from stiv.blender.edit.unguarded import as_stored, objects_that_meet, result_at
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.culling import Reach
from stiv.blender.settings import EditSettings, check_kind


class BlenderEdit:
    """An edit from its beginning to its last state written. Keeps no reference of Blender's between calls.

    Attributes:
        dropped: which exclusions of intersections no longer count, empty if all do.
        guard: the evaluations that are kept free of intersections.
        start_digest: equal for edits that begin with the same controls, surfaces that move and placements.
        carried: names of the objects whose strands follow what moves, and are no obstacles.
    """

    def __init__(self, beginning: Beginning) -> None:
        """Use `begin`."""
        settings = beginning.settings
        self.dropped, self.start_digest = beginning.dropped, beginning.digest
        self.guard, self.carried = beginning.guard, beginning.carried
        self._hidden, self._parts = beginning.hidden, beginning.parts
        self._selected_weight = settings.weight(True)
        self._influence: Influence | None = None
        self._start = stacked([part.controls for part in self._parts])
        self._goal = self._start
        self._began_free = settings.interference
        self._unguarded = None if settings.interference else self._start
        self._solving = Solving(beginning.assembly, self._parts, self._start, settings)
        self._showing = Showing(self._parts, self._solving, settings)

    @classmethod
    def begin(cls, context: bpy.types.Context, settings: EditSettings, kind: str) -> BlenderEdit:
        """Read the scene for an edit of this kind ("move", "rotate", "scale"); changes nothing.

        Raises InputError naming object, element and ways out, StartIntersectsError for a start that intersects.
        """
        check_kind(kind)
        return cls.begin_with(context, settings, kind, find_movers(context, settings))

    @classmethod
    def begin_with(
        cls,
        context: bpy.types.Context,
        settings: EditSettings,
        kind: str,
        movers: Sequence[Mover],
        adapt: Callable[[Part], Part] = lambda part: part,
        reach: Reach | None = None,
    ) -> BlenderEdit:
        """The same with movers that were found otherwise; `adapt` may change who responds in a part.

        What does not touch a `reach` does not take part.
        """
        return cls(read_beginning(context, settings, kind, movers, adapt, reach))

    @property
    def summary(self) -> Summary:
        """Who takes part; looks at every triangle, which is why a drag does not ask for it."""
        summary = summarise(self.assembly, self._parts, self._hidden, self.guard)
        return replace(summary, warnings=(self.dropped, *summary.warnings)) if self.dropped else summary

    @property
    def parts(self) -> tuple[Part, ...]:
        """What moves or gives way, in the order of the controls."""
        return self._parts

    @property
    def controls(self) -> Floats:
        """Accepted controls of all parts, (m, 3); those of the goal while interference is off."""
        return self._solving.session.controls if self._unguarded is None else self._unguarded

    @property
    def surface(self) -> Floats:
        """The surface of `controls`, (N, 3)."""
        if self._unguarded is not None:
            return self._solving.deformation.surface(self._unguarded)
        return self._solving.session.surface

    def surface_of(self, controls: Floats) -> Floats:
        """The surface, (N, 3), of controls, (m, 3), accepted or not."""
        return self._solving.deformation.surface(controls)

    def least_distance(self) -> stiv.LeastDistance | None:
        """How near objects are to each other in the accepted state, far obstacles left out; None without a session."""
        return self._solving.session.least_distance() if self._solving.has_begun else None

    @property
    def assembly(self) -> Assembly:
        """The surface's objects and faces, with the cuts of bent faces that are kept free."""
        return self._solving.assembly

    @property
    def goal(self) -> Floats:
        """What the controls of all parts are dragged to, (m, 3)."""
        return self._goal

    def goal_of(self, motion: Motion | ArrayLike) -> Floats:
        """The goal, (m, 3), that a motion would have. Raises InputError as `drag`."""
        return self._goal_of(Motion.of(motion))

    def moving_points(self, controls: Floats) -> Floats:
        """The part of the surface, (n, 3), that follows the controls, (m, 3)."""
        return self.surface_of(controls)[self._moving_vertices]

    @cached_property
    def _moving_vertices(self) -> Indices:
        return moving_vertices(self.assembly, self._parts)

    @property
    def _moving_points_at_rest(self) -> Floats:
        return self.assembly.positions[self._moving_vertices]

    @property
    def moving(self) -> frozenset[str]:
        """Names of the objects whose surface follows the transform."""
        meshes = self.assembly.meshes
        return frozenset(meshes[index].owner.name for part in self._parts if part.rule.moves for index in part.surfaces)

    def take_up(self, controls: ArrayLike) -> bool:
        """Go on from controls, (m, 3), that an edit from the same beginning accepted. False, with nothing changed, if
        they are not free of intersections here.
        """
        accepted = np.asarray(controls, np.float64)
        if accepted.shape != self._start.shape:
            return False
        if self._unguarded is not None:
            self._unguarded = accepted
            return True
        try:
            self._solving.go_on_from(accepted, accepted)
        except stiv.StartIntersectsError:
            self._solving.go_on_from(self._start, self._start)
            return False
        return True

    @property
    def interference(self) -> bool:
        """Is what is written free of intersections? Changed by `set_interference`."""
        return self._unguarded is None

    def set_interference(self, on: bool) -> str:
        """Let surfaces go through each other from now on, or no more; returns why the state is not kept, or "".

        Off: drags go to their goals, whose results have the status "unguarded", and `write` tests nothing. On again:
        a state that is free, on Blender's own evaluation too, is gone on from, wherever surfaces went through each
        other on the way there. From any other the edit goes back to the last state before interference was off, which
        the next `write` shows; where there is none, it stays off. Raises SceneChangedError.
        """
        if on == self.interference:
            return ""
        if not on:
            self._unguarded = self.controls
            return ""
        shown, self._unguarded = self.controls, None
        known = self._solving.session.controls if self._solving.has_begun else None
        try:
            self._solving.go_on_from(shown, self._goal)
            reason = self._showing.show(shown).message
        except stiv.StartIntersectsError as error:
            reason = f"{objects_that_meet(error.pairs, self.assembly.surface)} go through each other here"
        if not reason:
            return ""
        if known is None:
            self._solving.forget()
            self._unguarded = shown
            return f"interference stays off: {reason}"
        self._solving.go_on_from(known, known)
        return f"back to the last state without intersections: {reason}"

    def drag(self, motion: Motion | ArrayLike, **execution: Any) -> stiv.EditResult:
        """Solve for an absolute goal: a motion or its matrix, (4, 4), of what is selected, since the beginning.

        `cancel` and `progress` as of stiv.EditSession. Raises InputError for a matrix that is not finite.
        """
        wanted = Motion.of(motion)
        self._respond(wanted.influence)
        self._goal = self._goal_of(wanted)
        if self._unguarded is not None:
            self._unguarded = as_stored(self._parts, self._split(self._goal))
            return result_at(self._solving.deformation, self._unguarded)
        return self._solving.solve(self._goal, **execution)

    def drag_to(self, goal: Floats, **execution: Any) -> stiv.EditResult:
        """Solve for a goal of the controls of all parts, (m, 3)."""
        self._goal = goal
        return self._solving.solve(goal, **execution)

    def apply(self, motion: Motion | ArrayLike, path: Path | None = None, **execution: Any) -> stiv.EditResult:
        """Solve for the same goal given at once: approached in increments of a drag's size, then settled.

        path: the way to the matrix, for what it cannot tell (more than half a turn); None: the shortest.
        """
        results = []
        for increment in motions_toward(Motion.of(motion), path, self._moving_points_at_rest):
            results.append(self.drag(increment, **execution))
            if results[-1].status in ("cancelled", "budget"):
                return summed(results)
        return summed([*results, self.settle(**execution)])

    def settle(self, **execution: Any) -> stiv.EditResult:
        """Solve again toward the last goal."""
        if self._unguarded is not None:
            return result_at(self._solving.deformation, self._unguarded)
        return self._solving.solve(None, **execution)

    def write(self) -> WriteReport:
        """Write the accepted controls, read Blender's evaluation back and test it (see `Showing`).

        With interference off nothing is tested. Raises SceneChangedError when an object is gone or was changed.
        """
        if self._unguarded is not None:
            self._showing.put(self._unguarded)
            return WriteReport(True)
        return self._showing.show_accepted(self._goal)

    def is_shown(self) -> bool:
        """Does what Blender shows now, whoever wrote it, pass as the accepted state does? Writes nothing."""
        return self._showing.verify(self.surface).passed

    def restore(self) -> None:
        """Put everything back, bit by bit, as it was at the beginning. Raises SceneChangedError.

        An edit that began with interference off has it off again.
        """
        for part in self._parts:
            part.writer.restore()
        bpy.context.view_layer.update()
        self._goal = self._start
        if self._unguarded is not None or not self._began_free:
            self._unguarded = self._start
        if self._began_free:
            self._solving.go_on_from(self._start, self._goal)
        else:
            self._solving.forget()

    def _split(self, controls: Floats) -> list[Floats]:
        return split(controls, self._parts)

    def _respond(self, influence: Influence | None) -> None:
        """Let the points within an influence respond as those that are selected do."""
        if influence != self._influence:
            self._influence = influence
            self._solving.weigh(
                [
                    _chosen(part.rule.reached(influence), self._selected_weight * part.given, part.weights)
                    for part in self._parts
                ]
            )

    def _goal_of(self, motion: Motion) -> Floats:
        last = self._split(self._goal)
        return stacked(
            [part.rule.goal(part.controls, old, motion) for part, old in zip(self._parts, last, strict=True)]
        )


def _chosen(reached: NDArray[np.bool_], weights: Floats, others: Floats) -> Floats:
    """`weights` of the controls that are reached, (m,), and `others` of the rest; (m,) or (m, 3)."""
    return np.asarray(np.where(reached.reshape(-1, *(1 for _ in weights.shape[1:])), weights, others), np.float64)
