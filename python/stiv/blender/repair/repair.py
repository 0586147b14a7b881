# SPDX-License-Identifier: GPL-3.0-or-later
"""Repair of the open scene: selected meshes lose the intersections that they have."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import bpy

import stiv
from stiv.blender.repair.reshaping import MOST_RECUTS, Reshaped, ReshapeReport, read_reshaped, writer_of
from stiv.blender.repair.rest_shape import keep_original
from stiv.blender.repair.welding import WeldedMeshes, weld_selected
from stiv.blender.scene.arrays import Floats
from stiv.blender.settings import EditSettings
from stiv.blender.verify.verification import FacePair, named_pairs


@dataclass(frozen=True)
class RepairSettings:
    """Choices for a repair.

    Attributes:
        edit: separation, roles, ignored pairs, threads, time budget.
        max_deviation: what deviates more from the start is refused: root mean square in diagonals of what moves.
        weld: make vertices of a mesh one that lie in exactly the same place, before; Object Mode only.
    """

    edit: EditSettings = field(default_factory=EditSettings)
    max_deviation: float = 0.05
    weld: bool = False


class BlenderRepair:
    """A repair from its beginning to what is written: `solve`, then `write`, again until `write` gives a report.

    `solve` may run in another thread than Blender's. Whatever ends it early, `restore` puts everything back.
    """

    def __init__(self, reshaped: Reshaped, settings: RepairSettings, welded: WeldedMeshes | None = None) -> None:
        """Use `begin`."""
        self._reshaped = reshaped
        self._settings = settings
        self._welded = welded
        self._before = named_pairs(reshaped.assembly, reshaped.assembly.positions, settings.edit.threads)
        self._result: stiv.RepairResult | None = None
        self._attempts = 0

    @classmethod
    def begin(cls, context: bpy.types.Context, settings: RepairSettings | None = None) -> BlenderRepair:
        """Read the scene. Raises InputError naming object and ways out, with nothing changed."""
        chosen = settings or RepairSettings()
        reshaped = read_reshaped(context, chosen.edit)
        if not chosen.weld:
            return cls(reshaped, chosen)
        welded = weld_selected(reshaped.objects)
        try:
            return cls(read_reshaped(context, chosen.edit), chosen, welded)
        except BaseException:
            welded.undo()
            raise

    def solve(self, **execution: Any) -> None:
        """Contract and expand; `cancel` and `progress` as of stiv.EditSession."""
        options = stiv.RepairOptions(
            edit=self._reshaped.edit_options(), moves=self._reshaped.moves, max_deviation=self._settings.max_deviation
        )
        self._result = stiv.repair(
            self._reshaped.assembly.surface, self._reshaped.start, options,
            deformation=self._reshaped.deformation, cage=self._reshaped.cage, **execution,
        )  # fmt: skip

    def write(self) -> ReshapeReport | None:
        """Write what was found, and test what Blender shows; None: `solve` again, Blender cut bent faces otherwise.

        What Blender does not show free of intersections is taken back, bit by bit. Raises SceneChangedError.
        """
        result = self._result
        assert result is not None
        if result.status == "already_free":
            return self._ended("already_free", "") if not self._before else self._refused(
                "what Blender shows differs by rounding from what is computed; use a separation"
            )  # fmt: skip
        if result.status != "repaired":
            return self._refused(result.message)
        verification = self._reshaped.verify(result.positions)
        if verification.passed:
            return self._repaired(result.positions)
        self._reshaped.restore()
        self._attempts += 1
        if verification.cuts and self._attempts <= MOST_RECUTS:
            self._reshaped = self._reshaped.with_cuts(verification.cuts)
            return None
        return self._refused(f"what Blender makes of the repair is not free: {verification.message}")

    def restore(self) -> None:
        """Put everything back, bit by bit."""
        self._reshaped.restore()
        if self._welded is not None:
            self._welded.undo()

    def _repaired(self, controls: Floats) -> ReshapeReport:
        assert self._result is not None
        if self._welded is not None:
            self._welded.keep()
        for part in self._reshaped.parts:
            keep_original(writer_of(part).reference.find(), writer_of(part).original)
        deviation = self._reshaped.deviation(controls)
        return ReshapeReport("repaired", True, "", (), len(self._before), deviation, self._result.contracted)

    def _refused(self, message: str) -> ReshapeReport:
        assert self._result is not None
        status = self._result.status if self._result.status in ("cancelled", "budget") else "refused"
        return self._ended(status, message)

    def _ended(self, status: str, message: str) -> ReshapeReport:
        """Nothing is changed."""
        self.restore()
        pairs: tuple[FacePair, ...] = self._before
        return ReshapeReport(status, False, message, pairs, len(self._before))


def repair_scene(context: bpy.types.Context, settings: RepairSettings | None = None, **execution: Any) -> ReshapeReport:
    """Repair the selected meshes, as the operator `stiv.repair` does; `cancel` and `progress` as of stiv.EditSession.

    Raises InputError and SceneChangedError, with everything as it was.
    """
    return carry_out(BlenderRepair.begin(context, settings), **execution)


def carry_out(task: Any, **execution: Any) -> ReshapeReport:
    """Solve and write until there is a report; on any error everything is put back."""
    try:
        while True:
            task.solve(**execution)
            report: ReshapeReport | None = task.write()
            if report is not None:
                return report
    except BaseException:
        task.restore()
        raise
