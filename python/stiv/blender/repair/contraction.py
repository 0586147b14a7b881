# SPDX-License-Identifier: GPL-3.0-or-later
"""Contracts selected meshes toward their skeletons; the result may intersect, and the report says so."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import compress
from typing import Any

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.controls.cage import CageWriter
from stiv.blender.repair.repair import run_to_end
from stiv.blender.repair.reshaping import (
    OUT_OF_TIME_REASONS,
    ReshapeReport,
    ReshapeSnapshot,
    take_reshape_snapshot,
)
from stiv.blender.repair.rest_shape import read_rest_shape, store_rest_shape
from stiv.blender.scene.arrays import Floats, Singles
from stiv.blender.scene.face_pairs import find_face_pairs
from stiv.blender.settings import EditSettings
from stiv.blender.verify.verification import read_shown
from stiv.deadlines import deadline_after, is_over, time_left
from stiv.edit_session import Progress
from stiv.task import Call, Steps, run


@dataclass(frozen=True)
class ContractionSettings:
    """Choices for a contraction.

    Attributes:
        edit: roles, ignored pairs, threads; its time_budget limits the whole contraction, which ends with the steps so
            far.
        steps: number of steps, each twice as strong as the one before; the maximum with `until_free`.
        smoothing: strength of the first step.
        until_free: stop when clear, and use the step with the fewest intersections.
        new_original: store the present shape as rest shape, even if there is one already.
    """

    edit: EditSettings = field(default_factory=EditSettings)
    steps: int = 1
    smoothing: float = 1.0
    until_free: bool = False
    new_original: bool = False


class BlenderContraction:
    """A contraction of meshes of a scene. Call `solve`, then `write`, as for BlenderRepair."""

    def __init__(self, snapshot: ReshapeSnapshot, settings: ContractionSettings) -> None:
        self._snapshot = snapshot
        self._settings = settings
        stored = [None if settings.new_original else _stored_rest_shape(writer) for writer in snapshot.writers]
        self._needs_rest_shape = [local is None for local in stored]
        self._rest_shapes = snapshot.world(stored)
        self._before = len(find_face_pairs(snapshot.assembly, snapshot.assembly.positions, settings.edit.threads))
        self._controls: Floats | None = None
        self._end, self._out_of_time = deadline_after(settings.edit.time_budget), False

    @classmethod
    def begin(cls, context: bpy.types.Context, settings: ContractionSettings | None = None) -> BlenderContraction:
        """Read the scene. Raises InputError naming object and ways out, with nothing changed."""
        chosen = settings or ContractionSettings()
        if chosen.steps < 1:
            raise InputError(f"steps: {chosen.steps} is less than 1")
        return cls(take_reshape_snapshot(context, chosen.edit), chosen)

    def solve(self, **execution: Any) -> None:
        """Contract; `cancel` and `progress` are those of stiv.EditSession."""
        run(self.solve_steps(), **execution)

    def solve_steps(self) -> Steps[None]:
        """Steps of `solve`."""
        if self._settings.until_free:
            found = yield from self._until_free()
            self._out_of_time = found.out_of_time
            self._controls = found.positions if found.pairs or found.out_of_time else None
            return
        self._controls = None
        now = self._snapshot.start
        for step in range(self._settings.steps):
            strength = self._settings.smoothing * 2**step
            now = yield Call(
                _contraction_step, stiv.start_contraction_step, self._snapshot.cage, now,
                start=self._rest_shapes, smoothing=strength, moves=self._snapshot.moves,
            )  # fmt: skip
            if now is None:
                return
            if is_over(self._end) and step + 1 < self._settings.steps:
                self._out_of_time = True
                break
        self._controls = now

    def write(self) -> ReshapeReport:
        """Write the contracted shape, store the rest shape, and count the intersections that Blender shows."""
        controls, snapshot = self._controls, self._snapshot
        if controls is None:
            return ReshapeReport("cancelled", False, "cancelled", (), self._before)
        changed = not np.array_equal(controls, snapshot.start)
        if self._out_of_time and not changed:
            return ReshapeReport("budget", False, OUT_OF_TIME_REASONS["budget"], (), self._before)
        snapshot.show(controls)
        shown = read_shown(bpy.context, snapshot.assembly)
        pairs = find_face_pairs(snapshot.assembly, shown, self._settings.edit.threads)
        for writer in compress(snapshot.writers, self._needs_rest_shape):
            store_rest_shape(writer.reference.find(), writer.original)
        status = "budget" if self._out_of_time else "contracted"
        return ReshapeReport(status, changed, "", pairs, self._before, snapshot.deviation(controls))

    def restore(self) -> None:
        """Restore everything exactly."""
        self._snapshot.restore()

    def _until_free(self) -> Steps[stiv.ContractionResult]:
        options = stiv.ContractionOptions(
            smoothing=self._settings.smoothing, max_steps=self._settings.steps, time_budget=time_left(self._end)
        )
        with self._snapshot.naming_topology_changes():
            found: stiv.ContractionResult = yield Call(
                stiv.contract, stiv.start_contract, self._snapshot.assembly.surface, self._snapshot.start, options,
                deformation=self._snapshot.deformation, cage=self._snapshot.cage, moves=self._snapshot.moves,
                storage=self._snapshot.frames, threads=self._settings.edit.threads,
            )  # fmt: skip
        return found


def contract_scene(
    context: bpy.types.Context, settings: ContractionSettings | None = None, **execution: Any
) -> ReshapeReport:
    """Contract the selected meshes, as the operator `stiv.contract` does; `cancel` and `progress` as in `solve`.

    Raises InputError and SceneChangedError, with nothing changed.
    """
    return run_to_end(BlenderContraction.begin(context, settings), **execution)


def _contraction_step(
    *given: Any, cancel: stiv.CancelToken | None = None, progress: Progress | None = None, **named: Any
) -> Floats | None:
    """One step; None if cancelled."""
    if progress is not None:
        progress("contraction", 0.0)
    return None if cancel is not None and cancel.cancelled else stiv.contraction_step(*given, **named)


def _stored_rest_shape(writer: CageWriter) -> Singles | None:
    """The rest shape of a mesh, if it fits the present mesh."""
    local = read_rest_shape(writer.reference.find())
    return local if local is not None and len(local) == len(writer.original) else None
