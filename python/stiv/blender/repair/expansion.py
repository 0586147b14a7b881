# SPDX-License-Identifier: GPL-3.0-or-later
"""Expansion of selected meshes toward the shape kept with them or that of another object, without intersections."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.controls.cage import read_cage
from stiv.blender.edit.results import summed
from stiv.blender.edit.trail import Place, latest
from stiv.blender.repair.repair import carry_out
from stiv.blender.repair.reshaping import MOST_RECUTS, Reshaped, ReshapeReport, read_reshaped, writer_of
from stiv.blender.repair.rest_shape import forget_original, read_original
from stiv.blender.scene.arrays import Floats, Singles
from stiv.blender.settings import EditSettings
from stiv.blender.verify.verification import Verification


@dataclass(frozen=True)
class ExpansionSettings:
    """Choices for an expansion.

    Attributes:
        edit: separation, roles, ignored pairs, smoothness, threads, time budget.
        target: name of a mesh object with the same vertices, whose shape, in its own frame, is gone toward; it does not
            take part itself. Empty: the shape kept with each mesh by contraction or repair; meshes that none is kept
            with are wanted as they are, and give way to the others.
        amount: how much of the way to go, in [0, 1].
        rounds: solved again so many times, from where the one before ended, while that brings it nearer.
    """

    edit: EditSettings = field(default_factory=EditSettings)
    target: str = ""
    amount: float = 1.0
    rounds: int = 1


class BlenderExpansion:
    """An expansion from its beginning to what is written: `solve`, then `write`, as BlenderRepair."""

    def __init__(self, reshaped: Reshaped, goal: Floats, settings: ExpansionSettings) -> None:
        """Use `begin`; `goal` of the controls, (m, 3)."""
        self._reshaped = reshaped
        self._goal = np.where(reshaped.moves[:, None], goal, reshaped.start)
        self._settings = settings
        self._results: list[stiv.EditResult] = []
        self._attempts = 0

    @classmethod
    def begin(cls, context: bpy.types.Context, settings: ExpansionSettings | None = None) -> BlenderExpansion:
        """Read the scene. Raises InputError naming object and ways out, with nothing changed."""
        chosen = settings or ExpansionSettings()
        if not 0 <= chosen.amount <= 1:
            raise InputError(f"amount: {chosen.amount} is not between 0 and 1")
        if chosen.rounds < 1:
            raise InputError(f"rounds: {chosen.rounds} is less than 1")
        reshaped = read_reshaped(context, chosen.edit, frozenset({chosen.target} if chosen.target else ()))
        whole = reshaped.world(_targets(reshaped.objects, chosen.target))
        return cls(reshaped, reshaped.start + chosen.amount * (whole - reshaped.start), chosen)

    def solve(self, **execution: Any) -> None:
        """Go toward the goal, never farther from it; `cancel` and `progress` as of stiv.EditSession.

        Raises StartIntersectsError.
        """
        now, least, self._results = self._reshaped.start, self._energy(self._reshaped.start), []
        for _ in range(self._settings.rounds):
            result = stiv.expand(
                self._reshaped.assembly.surface, now, self._goal, self._reshaped.edit_options(),
                deformation=self._reshaped.deformation, **execution,
            )  # fmt: skip
            if result.status == "cancelled":
                self._results = [result]
                return
            if result.energy >= least:
                self._results = self._results or [replace(result, status="unchanged", path=[])]
                return
            self._results.append(result)
            now, least = result.controls, result.energy
            if result.status in ("reached", "unchanged", "budget"):
                return

    def write(self) -> ReshapeReport | None:
        """Write what was reached, and test what Blender shows; None: `solve` again, faces were cut otherwise.

        Ends at the last state on the way that Blender shows free of intersections. Raises SceneChangedError.
        """
        last = self._results[-1]
        if last.status == "cancelled":
            return ReshapeReport("cancelled", False, "cancelled")
        path = [controls for result in self._results for controls in result.path]
        if not path:
            return self._written(self._reshaped.start, last.status, "")
        verification = self._reshaped.verify(path[-1])
        if verification.passed:
            return self._written(path[-1], last.status, "")
        self._attempts += 1
        if verification.cuts and self._attempts <= MOST_RECUTS and self._take_in(verification):
            self._reshaped.restore()
            return None
        places = [Place(controls, 0, step) for step, controls in enumerate(path[:-1])]
        place = latest(places, lambda each: self._reshaped.verify(each.controls).passed)
        if place is None:
            self._reshaped.restore()
            return ReshapeReport("blocked", False, verification.message)
        self._reshaped.show(place.controls)
        return self._written(place.controls, "blocked", f"stopped on the way: {verification.message}")

    def restore(self) -> None:
        """Put everything back, bit by bit."""
        self._reshaped.restore()

    def _energy(self, controls: Floats) -> float:
        """Half the sum of squared distances of the surface to that of the goal, as of stiv.EditResult."""
        surface = self._reshaped.deformation.surface
        return 0.5 * float(((surface(controls) - surface(self._goal)) ** 2).sum())

    def _take_in(self, verification: Verification) -> bool:
        """Keep further cuts of faces free from now on; False if the start is not free with them."""
        reshaped = self._reshaped.with_cuts(verification.cuts)
        start = reshaped.deformation.surface(reshaped.start)
        if len(stiv.find_intersections(start, reshaped.assembly.surface, threads=self._settings.edit.threads)):
            return False
        self._reshaped = reshaped
        return True

    def _written(self, controls: Floats, status: str, message: str) -> ReshapeReport:
        if not self._settings.target and self._settings.amount == 1 and status == "reached":
            for part in self._reshaped.parts:
                if self._reshaped.moves.all():
                    forget_original(writer_of(part).reference.find())
        changed = not np.array_equal(controls, self._reshaped.start)
        done = summed(self._results)
        return ReshapeReport(status, changed, message, (), 0, self._reshaped.deviation(controls), result=done)


def expand_scene(
    context: bpy.types.Context, settings: ExpansionSettings | None = None, **execution: Any
) -> ReshapeReport:
    """Expand the selected meshes, as the operator `stiv.expand` does; `cancel` and `progress` as elsewhere.

    Raises InputError, StartIntersectsError and SceneChangedError, with everything as it was.
    """
    return carry_out(BlenderExpansion.begin(context, settings), **execution)


def _targets(objects: Sequence[bpy.types.Object], target: str) -> list[Singles | None]:
    """Where the vertices of each object are to go; None where they are. Raises InputError if none is to go anywhere."""
    if target or len(objects) == 1:
        return [_target_of(ob, target) for ob in objects]
    kept = [None if read_original(ob) is None else _target_of(ob, "") for ob in objects]
    return kept if any(each is not None for each in kept) else [_target_of(ob, "") for ob in objects]


def _target_of(ob: bpy.types.Object, target: str) -> Singles:
    """Where an object's vertices are to go, in its frame."""
    if target:
        other = bpy.data.objects.get(target)
        if other is None or other.type != "MESH":
            raise InputError(f'target: there is no mesh object "{target}"')
        if other.mode == "EDIT":
            other.update_from_editmode()
        local = read_cage(other)
        whose = f'object "{target}"'
    else:
        kept = read_original(ob)
        if kept is None:
            raise InputError(
                f'object "{ob.name}": no shape to go back to is kept with it; Contract and Repair keep one, or name a '
                "target object"
            )
        local, whose = kept, "the shape kept with it"
    if len(local) != len(ob.data.vertices):
        raise InputError(
            f'object "{ob.name}" has {len(ob.data.vertices)} vertices, {whose} has {len(local)}; both must be the same'
        )
    if not np.isfinite(local).all():
        raise InputError(f'object "{ob.name}": {whose} has a coordinate that is not finite')
    return local
