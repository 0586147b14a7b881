# SPDX-License-Identifier: GPL-3.0-or-later
"""Modifiers below which each evaluated vertex is an affine function of one vertex of the mesh.

Their derivative is exact, and Blender does not evaluate them during the edit.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from stiv.blender.controls.stack_jacobian import find_frames
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.evaluated_scene import evaluation_tolerance
from stiv.blender.scene.modifier_stack import POSITION_PRESERVING

LARGE = 0.37  # step of the differences, in sizes of the mesh: the larger, the less rounding matters
TRIALS = (0.01, 0.1, 1.0)  # random moves of each vertex, in sizes of the mesh
SCALAR = 1e-5  # deviation of a frame from a multiple of the identity


@dataclass(frozen=True, eq=False)
class AffineMap:
    """An affine function of world positions, (m, 3).

    Attributes:
        start: positions of the vertices, (m, 3), and `shown`: of the evaluated vertices there, (n, 3).
        anchors: the vertex on which each evaluated vertex depends, (n,).
        frames: derivative of each evaluated vertex, (n, 3, 3).
    """

    start: Floats
    shown: Floats
    anchors: Indices
    frames: Floats

    def evaluate(self, positions: Floats) -> Floats:
        """World positions of the evaluated vertices, (n, 3)."""
        moved: Floats = (positions - self.start)[self.anchors]
        return np.asarray(self.shown + np.einsum("nij,nj->ni", self.frames, moved), np.float64)

    def factors(self) -> Floats | None:
        """The factor of each frame that is a multiple of the identity, (n,); None if others are among them."""
        factors: Floats = np.trace(self.frames, axis1=1, axis2=2) / 3
        deviation = np.abs(self.frames - factors[:, None, None] * np.eye(3))
        return factors if deviation.max(initial=0.0) < SCALAR else None


def may_be_affine(modifier: bpy.types.Modifier, is_first: bool) -> bool:
    """May the modifier be affine? Then its topology depends on positions only where it merges vertices.

    Where mirror images merge is known only of the first modifier.
    """
    if isinstance(modifier, bpy.types.ArmatureModifier):
        return not modifier.use_bone_envelopes
    if isinstance(modifier, bpy.types.HookModifier):
        return bool(modifier.falloff_type == "NONE" or modifier.falloff_radius == 0)
    if isinstance(modifier, bpy.types.MirrorModifier):
        return not any(modifier.use_bisect_axis) and (is_first or not modifier.use_mirror_merge)
    if isinstance(modifier, bpy.types.ArrayModifier):
        return modifier.fit_type == "FIXED_COUNT" and not modifier.use_merge_vertices
    if isinstance(modifier, bpy.types.ScrewModifier):
        return not modifier.use_merge_vertices and not modifier.use_normal_calculate
    return modifier.type in POSITION_PRESERVING or modifier.type in ("MESH_DEFORM", "WELD")


def find_affine_map(
    observe: Callable[[Floats], Floats | None], start: Floats, anchors: Indices, trials: Sequence[Floats]
) -> AffineMap | None:
    """The affine function that Blender evaluates, or None if it is another one at any of the trials, (m, 3).

    observe: world positions, (n, 3), or None where the topology differs from that at the start, (m, 3).
    """
    shown = observe(start)
    step = LARGE * float(np.ptp(start, axis=0).max(initial=0.0))
    frames = find_frames(observe, start, step) if step > 0 else None
    if shown is None or frames is None:
        return None
    found = AffineMap(start, shown, anchors, frames)
    pairs = [(found.evaluate(trial), evaluated) for trial in trials if (evaluated := observe(trial)) is not None]
    agree = all(np.abs(mine - theirs).max(initial=0.0) <= evaluation_tolerance(theirs) / 2 for mine, theirs in pairs)
    return found if pairs and agree else None
