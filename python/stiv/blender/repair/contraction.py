# SPDX-License-Identifier: GPL-3.0-or-later
"""Contraction of selected meshes of the open scene toward their skeletons; it may end in anything, and says in what."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.repair.repair import carry_out
from stiv.blender.repair.reshaping import Reshaped, ReshapeReport, read_reshaped, writer_of
from stiv.blender.repair.rest_shape import keep_original, read_original
from stiv.blender.scene.arrays import Floats
from stiv.blender.settings import EditSettings
from stiv.blender.verify.verification import named_pairs, read_shown
from stiv.edit_session import Progress


@dataclass(frozen=True)
class ContractionSettings:
    """Choices for a contraction.

    Attributes:
        edit: roles, ignored pairs, threads.
        steps: how many, each twice as strong as the one before; with `until_free` at most so many.
        smoothing: how strong the first is.
        until_free: stop as soon as nothing intersects, and give the step that left the fewest pairs.
        new_original: keep the shape before as the one to go back to, also where one is kept already.
    """

    edit: EditSettings = field(default_factory=EditSettings)
    steps: int = 1
    smoothing: float = 1.0
    until_free: bool = False
    new_original: bool = False


class BlenderContraction:
    """A contraction from its beginning to what is written: `solve`, then `write`. As BlenderRepair."""

    def __init__(self, reshaped: Reshaped, settings: ContractionSettings) -> None:
        """Use `begin`."""
        self._reshaped = reshaped
        self._settings = settings
        kept = [None if settings.new_original else _kept(ob, reshaped, k) for k, ob in enumerate(reshaped.objects)]
        self._fresh = [local is None for local in kept]
        self._originals = reshaped.world(kept)
        self._before = len(named_pairs(reshaped.assembly, reshaped.assembly.positions, settings.edit.threads))
        self._controls: Floats | None = None

    @classmethod
    def begin(cls, context: bpy.types.Context, settings: ContractionSettings | None = None) -> BlenderContraction:
        """Read the scene. Raises InputError naming object and ways out, with nothing changed."""
        chosen = settings or ContractionSettings()
        if chosen.steps < 1:
            raise InputError(f"steps: {chosen.steps} is less than 1")
        return cls(read_reshaped(context, chosen.edit), chosen)

    def solve(self, *, cancel: stiv.CancelToken | None = None, progress: Progress | None = None) -> None:
        """Contract; `cancel` and `progress` as of stiv.EditSession."""
        if self._settings.until_free:
            self._controls = self._until_free(cancel, progress)
            return
        now, strength = self._reshaped.start, self._settings.smoothing
        for step in range(self._settings.steps):
            if progress is not None:
                progress("contraction", step / self._settings.steps)
            if cancel is not None and cancel.cancelled:
                self._controls = None
                return
            now = stiv.contraction_step(
                self._reshaped.cage, now, start=self._originals, smoothing=strength, moves=self._reshaped.moves
            )
            strength *= 2
        self._controls = now

    def write(self) -> ReshapeReport:
        """Write the contracted shape, keep the one before with the mesh, and count what meets in what Blender shows."""
        controls, reshaped = self._controls, self._reshaped
        if controls is None:
            return ReshapeReport("cancelled", False, "cancelled", (), self._before)
        reshaped.show(controls)
        pairs = named_pairs(reshaped.assembly, read_shown(bpy.context, reshaped.assembly), self._settings.edit.threads)
        for part, is_fresh in zip(reshaped.parts, self._fresh, strict=True):
            if is_fresh:
                keep_original(writer_of(part).reference.find(), writer_of(part).original)
        changed = not np.array_equal(controls, reshaped.start)
        return ReshapeReport("contracted", changed, "", pairs, self._before, reshaped.deviation(controls))

    def restore(self) -> None:
        """Put everything back, bit by bit."""
        self._reshaped.restore()

    def _until_free(self, cancel: stiv.CancelToken | None, progress: Progress | None) -> Floats | None:
        options = stiv.ContractionOptions(smoothing=self._settings.smoothing, max_steps=self._settings.steps)
        found = stiv.contract(
            self._reshaped.assembly.surface, self._reshaped.start, options,
            deformation=self._reshaped.deformation, cage=self._reshaped.cage, moves=self._reshaped.moves,
            storage=self._reshaped.frames, threads=self._settings.edit.threads, cancel=cancel, progress=progress,
        )  # fmt: skip
        return found.positions if found.pairs else None


def contract_scene(
    context: bpy.types.Context, settings: ContractionSettings | None = None, **execution: Any
) -> ReshapeReport:
    """Contract the selected meshes, as the operator `stiv.contract` does; `cancel` and `progress` as elsewhere.

    Raises InputError and SceneChangedError, with everything as it was.
    """
    return carry_out(BlenderContraction.begin(context, settings), **execution)


def _kept(ob: bpy.types.Object, reshaped: Reshaped, part: int) -> Any:
    """The original kept with a mesh, if it fits the mesh as it is."""
    local = read_original(ob)
    return local if local is not None and len(local) == len(writer_of(reshaped.parts[part]).original) else None
