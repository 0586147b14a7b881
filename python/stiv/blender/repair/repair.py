# SPDX-License-Identifier: GPL-3.0-or-later
"""Repairs selected meshes: removes their intersections."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import bpy

import stiv
from stiv.blender.repair.reshaping import (
    MAX_FLIP_RETRIES,
    OUT_OF_TIME_REASONS,
    ReshapeReport,
    ReshapeSnapshot,
    take_reshape_snapshot,
)
from stiv.blender.repair.rest_shape import store_rest_shape
from stiv.blender.repair.welding import WeldedMeshes, weld_copies
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.elements import count_faces
from stiv.blender.scene.face_pairs import find_face_pairs
from stiv.blender.settings import EditSettings
from stiv.deadlines import deadline_after, time_left
from stiv.task import Call, Steps, run


@dataclass(frozen=True)
class RepairSettings:
    """Choices for a repair.

    Attributes:
        edit: separation, roles, ignored pairs, threads; its time_budget limits the whole repair, whose result is then
            the best one so far, if there is one.
        max_deviation: maximum root mean square distance from the start, in diagonals of the moving surface.
        weld: merge coincident vertices first; Object Mode only.
    """

    edit: EditSettings = field(default_factory=EditSettings)
    max_deviation: float = 0.05
    weld: bool = False


class BlenderRepair:
    """A repair from the snapshot of the scene to the written state: `solve`, then `write`, until `write` returns a
    report.

    A stiv.blender.Task of `solve_steps` solves in jobs. `restore` undoes an interrupted repair.
    """

    def __init__(self, snapshot: ReshapeSnapshot, settings: RepairSettings, welded: WeldedMeshes | None = None) -> None:
        self._snapshot = snapshot
        self._settings = settings
        self._welded = welded
        self._before = find_face_pairs(snapshot.assembly, snapshot.assembly.positions, settings.edit.threads)
        self._result: stiv.RepairResult | None = None
        self._attempts = 0
        self._end = deadline_after(settings.edit.time_budget)

    @classmethod
    def begin(cls, context: bpy.types.Context, settings: RepairSettings | None = None) -> BlenderRepair:
        """Read the scene. Raises InputError naming object and ways out, with nothing changed."""
        chosen = settings or RepairSettings()
        snapshot = take_reshape_snapshot(context, chosen.edit)
        if not chosen.weld:
            return cls(snapshot, chosen)
        welded = weld_copies(snapshot.objects)
        try:
            return cls(take_reshape_snapshot(context, chosen.edit), chosen, welded)
        except BaseException:
            welded.undo()
            raise

    def solve(self, **execution: Any) -> None:
        """Contract and expand; `cancel` and `progress` are those of stiv.EditSession."""
        run(self.solve_steps(), **execution)

    def solve_steps(self) -> Steps[None]:
        """Steps of `solve`."""
        options = stiv.RepairOptions(
            edit=self._edit_options(), moves=self._snapshot.moves, max_deviation=self._settings.max_deviation
        )
        with self._snapshot.naming_topology_changes():
            self._result = yield Call(
                stiv.repair, stiv.start_repair, self._snapshot.assembly.surface, self._snapshot.start, options,
                deformation=self._snapshot.deformation, cage=self._snapshot.cage,
            )  # fmt: skip

    def write(self) -> ReshapeReport | None:
        """Write the result and test Blender's evaluation; None: `solve` again, because Blender flipped triangles.

        Restores the start exactly if Blender's evaluation intersects. Raises SceneChangedError.
        """
        result = self._result
        assert result is not None
        if result.status == "already_free":
            return self._ended("already_free", "") if not self._before else self._refused(
                "rounding causes intersections; use a larger minimum distance"
            )  # fmt: skip
        if result.status != "repaired":
            return self._refused(OUT_OF_TIME_REASONS.get(result.status, result.message))
        verification = self._snapshot.verify(result.positions)
        if verification.passed:
            return self._repaired(result.positions)
        self._snapshot.restore()
        self._attempts += 1
        if verification.flips and self._attempts <= MAX_FLIP_RETRIES:
            self._snapshot = self._snapshot.add_triangles(verification.flips)
            return None
        return self._refused(f"repaired, but {verification.message}")

    def _edit_options(self) -> stiv.EditOptions:
        """The options of the expansion, with the time that is left."""
        return replace(self._snapshot.edit_options(), time_budget=time_left(self._end))

    def restore(self) -> None:
        """Restore everything exactly."""
        self._snapshot.restore()
        if self._welded is not None:
            self._welded.undo()

    def _repaired(self, controls: Floats) -> ReshapeReport:
        assert self._result is not None
        if self._welded is not None:
            self._welded.apply()
        for writer in self._snapshot.writers:
            store_rest_shape(writer.reference.find(), writer.original)
        deviation = self._snapshot.deviation(controls)
        before, faces = len(self._before), count_faces(self._before)
        contracted = self._result.contracted
        message = OUT_OF_TIME_REASONS["repaired"] if self._result.out_of_time else ""
        return ReshapeReport("repaired", True, message, (), before, deviation, contracted, faces_before=faces)

    def _refused(self, message: str) -> ReshapeReport:
        assert self._result is not None
        status = self._result.status if self._result.status in ("cancelled", "budget") else "refused"
        return self._ended(status, message)

    def _ended(self, status: str, message: str) -> ReshapeReport:
        """Restore the start and report it."""
        self.restore()
        return ReshapeReport(status, False, message, self._before, len(self._before))


def repair_scene(context: bpy.types.Context, settings: RepairSettings | None = None, **execution: Any) -> ReshapeReport:
    """Repair the selected meshes, as the operator `stiv.repair` does; `cancel` and `progress` as in `solve`.

    Raises InputError and SceneChangedError, with nothing changed.
    """
    return run_to_end(BlenderRepair.begin(context, settings), **execution)


def run_to_end(task: Any, **execution: Any) -> ReshapeReport:
    """Solve and write until there is a report; restores everything on any error."""
    try:
        while True:
            task.solve(**execution)
            report: ReshapeReport | None = task.write()
            if report is not None:
                return report
    except BaseException:
        task.restore()
        raise
