# SPDX-License-Identifier: GPL-3.0-or-later
"""Modifiers below which each evaluated vertex is an affine function of one vertex of the mesh, or of those around it.

Their derivative is exact, and Blender does not evaluate them during the edit.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import bpy
import numpy as np

import stiv
from stiv.blender.controls.stack_jacobian import find_frames
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.evaluated_scene import evaluation_tolerance
from stiv.blender.scene.mesh_reading import read_edges
from stiv.blender.scene.modifier_stack import POSITION_PRESERVING

LARGE = 0.37  # step of the differences, in sizes of the mesh: the larger, the less rounding matters
TRIALS = (0.01, 0.1, 1.0)  # random moves of each vertex, in sizes of the mesh
SCALAR = 1e-5  # deviation of a frame from a multiple of the identity
MAX_ITERATIONS = 10  # of Smooth modifiers: the weights of each vertex grow with their square
Rows = tuple[Indices, Indices, Floats]  # a derivative: first entry of each row, controls, weights or blocks of 3 x 3


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

    def rows(self) -> Rows:
        """The derivative: weights if each frame is a multiple of the identity, blocks otherwise."""
        indptr = np.arange(len(self.anchors) + 1, dtype=np.int32)
        factors: Floats = np.trace(self.frames, axis1=1, axis2=2) / 3
        deviation = np.abs(self.frames - factors[:, None, None] * np.eye(3))
        return indptr, self.anchors, factors if deviation.max(initial=0.0) < SCALAR else self.frames


@dataclass(frozen=True, eq=False)
class LinearMap:
    """Changes of world positions by weights, (n, m), from `start`, (m, 3), and `shown`, (n, 3), there."""

    start: Floats
    shown: Floats
    weights: stiv.Weights

    def evaluate(self, positions: Floats) -> Floats:
        """World positions of the evaluated vertices, (n, 3)."""
        return np.asarray(self.shown + stiv.linear(self.weights).surface(positions - self.start), np.float64)

    def rows(self) -> Rows:
        """The derivative."""
        return self.weights.indptr, self.weights.indices, self.weights.data


ExactMap = AffineMap | LinearMap
Observe = Callable[[Floats], Floats | None]


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


def find_affine_map(observe: Observe, start: Floats, anchors: Indices, trials: Sequence[Floats]) -> AffineMap | None:
    """The affine function that Blender evaluates, or None if it is another one at any of the trials, (m, 3).

    observe: world positions, (n, 3), or None where the topology differs from that at the start, (m, 3).
    """
    shown = observe(start)
    step = LARGE * float(np.ptp(start, axis=0).max(initial=0.0))
    frames = find_frames(observe, start, step) if step > 0 else None
    if shown is None or frames is None:
        return None
    found = AffineMap(start, shown, anchors, frames)
    return found if _agrees(found, observe, trials) else None


def find_smoothing_map(
    observe: Observe, start: Floats, ob: bpy.types.Object, block: Sequence[bpy.types.Modifier], trials: Sequence[Floats]
) -> LinearMap | None:
    """The function of a block that only smooths, or None if there is another modifier, or Blender evaluates another."""
    if not block or not all(map(_is_smoothing, block)) or sum(each.iterations for each in block) > MAX_ITERATIONS:
        return None
    shown = observe(start)
    stages = [_smoothing(ob, each) for each in block for _ in range(each.iterations)]
    if shown is None or len(shown) != len(start) or not stages:
        return None
    found = LinearMap(start, shown, stiv.linear_weights(stiv.compose(*stages) if len(stages) > 1 else stages[0])[0])
    return found if _agrees(found, observe, trials) else None


def _is_smoothing(modifier: bpy.types.Modifier) -> bool:
    if not isinstance(modifier, bpy.types.SmoothModifier):
        return False
    return not modifier.vertex_group and modifier.use_x and modifier.use_y and modifier.use_z


def _smoothing(ob: bpy.types.Object, modifier: bpy.types.SmoothModifier) -> stiv.Deformation:
    """One iteration: each vertex moves toward the mean of the midpoints of its edges."""
    edges, count = read_edges(ob.data), len(ob.data.vertices)
    first, second = np.concatenate([edges, edges[:, ::-1], np.arange(count)[:, None].repeat(2, axis=1)]).T
    degree = np.bincount(edges.ravel(), minlength=count)
    own = np.where(degree > 0, 1 - modifier.factor / 2, 1.0)
    others = modifier.factor / 2 / np.maximum(degree, 1)
    values = np.where(first == second, own[first], others[first])
    order = np.argsort(first, kind="stable")
    starts = np.append(0, np.cumsum(np.bincount(first, minlength=count))).astype(np.int32)
    return stiv.linear(stiv.Weights(starts, second[order].astype(np.int32), values[order], (count, count)))


def _agrees(found: ExactMap, observe: Observe, trials: Sequence[Floats]) -> bool:
    pairs = [(found.evaluate(trial), evaluated) for trial in trials if (evaluated := observe(trial)) is not None]
    return bool(pairs) and all(
        np.abs(mine - theirs).max(initial=0.0) <= evaluation_tolerance(theirs) / 2 for mine, theirs in pairs
    )
