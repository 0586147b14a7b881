# SPDX-License-Identifier: GPL-3.0-or-later
"""Expands selected meshes toward their rest shape, or the shape of another object, without intersections."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.edit.results import merge_results
from stiv.blender.edit.trail import AcceptedState, find_latest
from stiv.blender.repair.repair import run_to_end
from stiv.blender.repair.reshaping import (
    MAX_FLIP_RETRIES,
    OUT_OF_TIME_REASONS,
    ReshapeReport,
    ReshapeSnapshot,
    take_reshape_snapshot,
)
from stiv.blender.repair.rest_shape import read_rest_shape, remove_rest_shape
from stiv.blender.scene.arrays import Floats, Singles
from stiv.blender.scene.mesh_reading import read_cage
from stiv.blender.settings import EditSettings
from stiv.blender.verify.verification import Verification
from stiv.deadlines import deadline_after, time_left
from stiv.task import Call, Steps, run


@dataclass(frozen=True)
class ExpansionSettings:
    """Choices for an expansion.

    Attributes:
        edit: separation, roles, ignored pairs, smoothness, threads; its time_budget limits the whole expansion, which
            ends with the last accepted state.
        target: name of a mesh object with the same vertices, whose local shape is the goal; it does not participate. ""
            uses the rest shapes that contraction and repair store. Meshes without one keep their shape as goal, and
            yield to the others.
        amount: fraction of the way to the goal, in [0, 1].
        rounds: maximum number of solves; each starts from the previous result, as long as the energy decreases.
    """

    edit: EditSettings = field(default_factory=EditSettings)
    target: str = ""
    amount: float = 1.0
    rounds: int = 1


class BlenderExpansion:
    """An expansion of meshes of a scene. Call `solve`, then `write`, as for BlenderRepair."""

    def __init__(self, snapshot: ReshapeSnapshot, goal: Floats, settings: ExpansionSettings) -> None:
        """Call `begin` instead. goal: of the controls, (m, 3)."""
        self._snapshot = snapshot
        self._goal = np.where(snapshot.moves[:, None], goal, snapshot.start)
        self._settings = settings
        self._results: list[stiv.EditResult] = []
        self._attempts = 0
        self._end = deadline_after(settings.edit.time_budget)

    @classmethod
    def begin(cls, context: bpy.types.Context, settings: ExpansionSettings | None = None) -> BlenderExpansion:
        """Read the scene. Raises InputError naming object and ways out, with nothing changed."""
        chosen = settings or ExpansionSettings()
        if not 0 <= chosen.amount <= 1:
            raise InputError(f"amount: {chosen.amount} is not between 0 and 1")
        if chosen.rounds < 1:
            raise InputError(f"rounds: {chosen.rounds} is less than 1")
        snapshot = take_reshape_snapshot(context, chosen.edit, frozenset({chosen.target} if chosen.target else ()))
        whole = snapshot.world(_targets(snapshot.objects, chosen.target))
        return cls(snapshot, snapshot.start + chosen.amount * (whole - snapshot.start), chosen)

    def solve(self, **execution: Any) -> None:
        """Solve toward the goal, never away from it; `cancel` and `progress` are those of stiv.EditSession.

        Raises StartIntersectsError.
        """
        run(self.solve_steps(), **execution)

    def solve_steps(self) -> Steps[None]:
        """Steps of `solve`."""
        now, least, self._results = self._snapshot.start, self._energy(self._snapshot.start), []
        for _ in range(self._settings.rounds):
            result: stiv.EditResult = yield Call(
                stiv.expand, stiv.start_expand, self._snapshot.assembly.surface, now, self._goal,
                self._edit_options(), deformation=self._snapshot.deformation,
            )  # fmt: skip
            if result.status == "cancelled":
                self._results = [result]
                return
            if result.energy >= least:
                self._end_without_gain(result)
                return
            self._results.append(result)
            now, least = result.controls, result.energy
            if result.status in ("reached", "unchanged", "budget"):
                return

    def write(self) -> ReshapeReport | None:
        """Write the result and test Blender's evaluation; None: `solve` again, because Blender flipped triangles.

        Writes the last state on the path that passes in Blender's evaluation. Raises SceneChangedError.
        """
        last = self._results[-1]
        if last.status == "cancelled":
            return ReshapeReport("cancelled", False, "cancelled")
        path = [controls for result in self._results for controls in result.path]
        if not path:
            return self._written(self._snapshot.start, last.status, OUT_OF_TIME_REASONS.get(last.status, ""))
        verification = self._snapshot.verify(path[-1])
        if verification.passed:
            return self._written(path[-1], last.status, "")
        self._attempts += 1
        if verification.flips and self._attempts <= MAX_FLIP_RETRIES and self._add_flips(verification):
            self._snapshot.restore()
            return None
        places = [AcceptedState(controls, 0, step) for step, controls in enumerate(path[:-1])]
        place = find_latest(places, lambda each: self._snapshot.verify(each.controls).passed)
        if place is None:
            self._snapshot.restore()
            return ReshapeReport("blocked", False, verification.message)
        self._snapshot.show(place.controls)
        return self._written(place.controls, "blocked", f"stopped early: {verification.message}")

    def restore(self) -> None:
        """Restore everything exactly."""
        self._snapshot.restore()

    def _edit_options(self) -> stiv.EditOptions:
        """The options of a solve, with the time that is left."""
        return replace(self._snapshot.edit_options(), time_budget=time_left(self._end))

    def _end_without_gain(self, result: stiv.EditResult) -> None:
        """Leave out a result that does not come closer to the goal, except for the end of the time limit."""
        status = "budget" if result.status == "budget" else "unchanged"
        if not self._results:
            self._results = [replace(result, status=status, path=[])]
        elif status == "budget":
            self._results[-1] = replace(self._results[-1], status=status)

    def _energy(self, controls: Floats) -> float:
        """Half the sum of squared distances to the goal's surface, as in stiv.EditResult."""
        surface = self._snapshot.deformation.surface
        return 0.5 * float(((surface(controls) - surface(self._goal)) ** 2).sum())

    def _add_flips(self, verification: Verification) -> bool:
        """Also keep flipped triangles free of intersections; returns False if they intersect at the start."""
        snapshot = self._snapshot.add_triangles(verification.flips)
        start = snapshot.deformation.surface(snapshot.start)
        if len(stiv.find_intersections(start, snapshot.assembly.surface, threads=self._settings.edit.threads)):
            return False
        self._snapshot = snapshot
        return True

    def _written(self, controls: Floats, status: str, message: str) -> ReshapeReport:
        if not self._settings.target and self._settings.amount == 1 and status == "reached":
            for ob in self._snapshot.objects if self._snapshot.moves.all() else ():
                remove_rest_shape(ob)
        changed = not np.array_equal(controls, self._snapshot.start)
        done = merge_results(self._results)
        return ReshapeReport(status, changed, message, (), 0, self._snapshot.deviation(controls), result=done)


def expand_scene(
    context: bpy.types.Context, settings: ExpansionSettings | None = None, **execution: Any
) -> ReshapeReport:
    """Expand the selected meshes, as the operator `stiv.expand` does; `cancel` and `progress` as in `solve`.

    Raises InputError, StartIntersectsError and SceneChangedError, with nothing changed.
    """
    return run_to_end(BlenderExpansion.begin(context, settings), **execution)


def _targets(objects: Sequence[bpy.types.Object], target: str) -> list[Singles | None]:
    """Goal of each object's vertices; None for its present shape. Raises InputError if no object has a goal."""
    if target or len(objects) == 1:
        return [_target_of(ob, target) for ob in objects]
    stored = [None if read_rest_shape(ob) is None else _target_of(ob, "") for ob in objects]
    return stored if any(each is not None for each in stored) else [_target_of(ob, "") for ob in objects]


def _target_of(ob: bpy.types.Object, target: str) -> Singles:
    """Goal of an object's vertices in its own frame."""
    if target:
        other = bpy.data.objects.get(target)
        if other is None or other.type != "MESH":
            raise InputError(f"{target}: is not a mesh of this file; choose another target")
        if other.mode == "EDIT":
            other.update_from_editmode()
        local = read_cage(other)
        whose = f'"{target}"'
    else:
        stored = read_rest_shape(ob)
        if stored is None:
            raise InputError(f"{ob.name}: it has no rest shape; use Contract or Repair first")
        local, whose = stored, "its rest shape"
    if len(local) != len(ob.data.vertices):
        raise InputError(f"{ob.name}: {len(ob.data.vertices)} vertices, {whose} has {len(local)}; use another target")
    if not np.isfinite(local).all():
        raise InputError(f"{ob.name}: {whose} has a coordinate that is not finite; change it")
    return local
