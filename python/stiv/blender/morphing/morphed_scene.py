# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface of all visible objects as a function of sliders and clothes that yield, evaluated in the scene itself."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import bpy
import numpy as np

import stiv
from stiv.blender.controls.garments import Blocks, Garment, make_garments, rows_of_blocks
from stiv.blender.controls.participants import find_clothes
from stiv.blender.morphing.key_sliders import KeySlider
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.assembly import assemble
from stiv.blender.scene.guarded_evaluations import read_guarded_scene
from stiv.blender.scene.references import SceneChangedError
from stiv.blender.scene.triangulation_flips import guard_bent_quads
from stiv.blender.settings import EditSettings
from stiv.blender.verify.verification import read_shown

DIFFERENCE = 0.05  # of the range of a slider, for a Jacobian
OWN_SLIDER = 1.0  # range of a slider without a range


class MorphedScene:
    """The surface as a function of controls, (m, 3): rows (value, 0, 0) of sliders, then the controls of clothes.

    Attributes:
        assembly: objects that no control moves are fixed.
        garments: clothes that yield, by the settings.
        start: the controls at the start, (m, 3).
        written: the controls that Blender shows, (m, 3).
        lower, upper: limits of the sliders, (k,).
        size: diagonal of the surface that controls move.
    """

    def __init__(self, context: bpy.types.Context, settings: EditSettings, sliders: Sequence[KeySlider]) -> None:
        """Read the scene. Raises InputError."""
        self._context, self._sliders, self.settings = context, sliders, settings
        self.lower, self.upper = (np.array(ends) for ends in zip(*((s.lower, s.upper) for s in sliders), strict=True))
        scene, _ = read_guarded_scene(context, settings)
        owners = {each.owner.name for each in sliders}
        clothes = [each for each in find_clothes(context, settings) if each.reference.name not in owners]
        self.garments: tuple[Garment, ...] = tuple(make_garments(context, clothes, scene.meshes, settings))
        values = np.array([[each.start, 0.0, 0.0] for each in sliders])
        self.start = self.written = np.concatenate([values, *(each.controls.controls for each in self.garments)])
        self.assembly = assemble(scene.meshes, ["deformable"] * len(scene.meshes), (), settings.ignored_pairs)
        self._rest = self.assembly.positions
        self._fixed = np.zeros(len(self._rest), bool)
        self.size = 1.0

    @property
    def count(self) -> int:
        """Number of sliders."""
        return len(self._sliders)

    def write(self, controls: Floats) -> None:
        """Write controls, (m, 3), and update Blender's evaluation."""
        for slider, (value, *_), (before, *_) in zip(self._sliders, controls, self.written, strict=False):
            if value != before:
                slider.write(float(value))
        for garment, own in zip(self.garments, self._parts(), strict=True):
            if np.array_equal(controls[own], self.start[own]):
                garment.controls.writer.restore()
            elif not np.array_equal(controls[own], self.written[own]):
                garment.controls.writer.write(controls[own])
        self.written = controls
        self._context.view_layer.update()

    def evaluate(self, controls: Floats) -> Floats | None:
        """The surface, (N, 3); None if its topology, or something that no control moves, changes."""
        self.write(controls)
        try:
            positions = read_shown(self._context, self.assembly)
        except SceneChangedError:
            return None
        return positions if np.array_equal(positions[self._fixed], self._rest[self._fixed]) else None

    def evaluate_values(self, values: Floats) -> Floats | None:
        """The surface at values of the sliders, (k,), with the clothes as they are."""
        return self.evaluate(self.with_values(self.written, values))

    def with_values(self, controls: Floats, values: Floats) -> Floats:
        """The controls with other values, (k,)."""
        found = controls.copy()
        found[: self.count, 0] = values
        return found

    def shows(self, controls: Floats) -> bool:
        """Are the sliders at these controls, and all that controls do not move as at the start?"""
        try:
            present = np.array([slider.read_value() for slider in self._sliders])
        except SceneChangedError:
            return False
        same = np.array_equal(present, controls[: self.count, 0].astype(np.float32))
        return same and self.evaluate(controls) is not None

    def jacobian(self) -> Floats:
        """The derivative of the surface by the sliders at the present controls, (N, 3, k). Writes other values."""
        ranges = np.where(self.upper > self.lower, self.upper - self.lower, OWN_SLIDER)
        at = self.written
        found = stiv.difference_jacobian(
            self.evaluate_values,
            at[: self.count, 0],
            DIFFERENCE * np.minimum(ranges, OWN_SLIDER),
            lower=self.lower,
            upper=self.upper,
        )
        self.write(at)
        return found

    def blocks(self, jacobian: Floats) -> tuple[Indices, Indices, Floats, tuple[int, int]]:
        """The derivative by all controls, as blocks, at the present ones. jacobian: that by the sliders."""
        at = self.written
        row, slider = (each.astype(np.int32) for each in np.nonzero((jacobian != 0).any(axis=1)))
        found = [Blocks(row, slider, jacobian[row, :, slider][:, :, None] * np.array([1.0, 0, 0]))]
        for garment, own in zip(self.garments, self._parts(), strict=True):

            def evaluate(controls: Floats, own: slice = own) -> Floats | None:
                moved = at.copy()
                moved[own] = controls
                return self.evaluate(moved)

            made = garment.blocks(evaluate, at[own], self._rows(garment))
            found.append(Blocks(made.rows, made.controls + own.start, made.data))
        self.write(at)
        indptr, columns, data = rows_of_blocks(found, len(jacobian), np.arange(len(jacobian), dtype=np.int32))
        return indptr, columns, data, (len(jacobian), len(at))

    def fix_resting_objects(self, goals: Sequence[Floats], jacobian: Floats) -> None:
        """Fix the objects that no clothes and neither the Jacobian nor any of the goals, (k,), move."""
        moved = (jacobian != 0).any(axis=(1, 2))
        for garment in self.garments:
            moved[self._rows(garment)] = True
        for goal in goals:
            at_goal = self.evaluate_values(goal)
            if at_goal is not None:
                moved |= (at_goal != self._rest).any(axis=1)
        self.write(self.start)
        moves = [bool(moved[a:b].any()) for a, b in pairwise(self.assembly.starts)]
        mobility = ["deformable" if each else "fixed" for each in moves]
        meshes, ignored = self.assembly.meshes, self.settings.ignored_pairs
        self.assembly = guard_bent_quads(assemble(meshes, mobility, (), ignored), self.settings.threads)
        self._fixed = ~np.repeat(moves, np.diff(self.assembly.starts))
        if not self._fixed.all():
            self.size = float(np.linalg.norm(np.ptp(self._rest[~self._fixed], axis=0))) or 1.0

    def longest_motion(self, jacobian: Floats, change: Floats) -> float:
        """The longest motion of a vertex by a change of the values, (k,), in sizes of the moving surface."""
        shift = np.einsum("nak,k->na", jacobian[~self._fixed], change)
        return float(np.linalg.norm(shift, axis=1).max(initial=0.0)) / self.size

    def _parts(self) -> list[slice]:
        """Where the controls of each garment are."""
        ends = self.count + np.cumsum([0, *(len(each.controls.controls) for each in self.garments)])
        return [slice(int(first), int(last)) for first, last in pairwise(ends)]

    def _rows(self, garment: Garment) -> Indices:
        starts = self.assembly.starts
        rows = [np.arange(starts[k], starts[k + 1], dtype=np.int32) for k in garment.controls.surfaces]
        return np.concatenate(rows)
