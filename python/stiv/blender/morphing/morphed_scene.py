# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface of all visible objects as a function of sliders, evaluated in the scene itself."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import bpy
import numpy as np

import stiv
from stiv.blender.morphing.key_sliders import KeySlider
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.assembly import assemble
from stiv.blender.scene.guarded_evaluations import read_guarded_scene
from stiv.blender.scene.references import SceneChangedError
from stiv.blender.scene.triangulation_flips import guard_bent_quads
from stiv.blender.settings import EditSettings
from stiv.blender.verify.verification import read_shown

DIFFERENCE = 0.05  # of the range of a slider, for a Jacobian
OWN_SLIDER = 1.0  # range of a slider without a range


class MorphedScene:
    """The surface as a function of sliders.

    Attributes:
        assembly: objects that no slider moves are fixed.
        start: the values at the start, (k,).
        written: the values that Blender shows, (k,).
        lower, upper: limits of the sliders, (k,).
        size: diagonal of the surface that sliders move.
    """

    def __init__(self, context: bpy.types.Context, settings: EditSettings, sliders: Sequence[KeySlider]) -> None:
        """Read the scene. Raises InputError."""
        self._context, self._sliders, self.settings = context, sliders, settings
        self.start = self.written = np.array([each.start for each in sliders])
        self.lower, self.upper = (np.array(ends) for ends in zip(*((s.lower, s.upper) for s in sliders), strict=True))
        scene, _ = read_guarded_scene(context, settings)
        self.assembly = assemble(scene.meshes, ["deformable"] * len(scene.meshes), (), settings.ignored_pairs)
        self._rest = self.assembly.positions
        self._fixed = np.zeros(len(self._rest), bool)
        self.size = 1.0

    def write(self, values: Floats) -> None:
        """Write values, (k,), and update Blender's evaluation."""
        for slider, value, before in zip(self._sliders, values, self.written, strict=True):
            if value != before:
                slider.write(float(value))
        self.written = values
        self._context.view_layer.update()

    def evaluate(self, values: Floats) -> Floats | None:
        """The surface at values, (N, 3); None if its topology, or something that no slider moves, changes."""
        self.write(values)
        try:
            positions = read_shown(self._context, self.assembly)
        except SceneChangedError:
            return None
        return positions if np.array_equal(positions[self._fixed], self._rest[self._fixed]) else None

    def shows(self, values: Floats) -> bool:
        """Are the sliders at values, (k,), and all that they do not move as at the start?"""
        try:
            present = np.array([slider.read_value() for slider in self._sliders])
        except SceneChangedError:
            return False
        return np.array_equal(present, values.astype(np.float32)) and self.evaluate(values) is not None

    def jacobian(self) -> Floats:
        """The derivative of the surface at the present values, (N, 3, k). Writes other values."""
        ranges = np.where(self.upper > self.lower, self.upper - self.lower, OWN_SLIDER)
        at = self.written
        found = stiv.difference_jacobian(
            self.evaluate, at, DIFFERENCE * np.minimum(ranges, OWN_SLIDER), lower=self.lower, upper=self.upper
        )
        self.write(at)
        return found

    def fix_resting_objects(self, goals: Sequence[Floats], jacobian: Floats) -> None:
        """Fix the objects that neither the Jacobian nor any of the goals, (k,), moves."""
        moved = (jacobian != 0).any(axis=(1, 2))
        for goal in goals:
            at_goal = self.evaluate(goal)
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
