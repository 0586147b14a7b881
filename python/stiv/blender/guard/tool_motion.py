# SPDX-License-Identifier: GPL-3.0-or-later
"""The motion by which a tool transformed an object, from the object's states before and after.

Blender stores single precision. Here, rotations about a pivot and scales along an object's axes are exact again. Their
corrections then change nothing but the angle or the factors.
"""

import numpy as np

from stiv.blender.controls.directions import FreeDirections
from stiv.blender.controls.motion import Motion
from stiv.blender.controls.rotations import nearest_rotation, rotation_vector
from stiv.blender.guard.changes import Change
from stiv.blender.guard.scene_state import ObjectState
from stiv.blender.scene.arrays import Floats

ROUNDING = 1e-6  # relative error of placements that Blender stores


def tool_motion(change: Change, before: ObjectState, after: ObjectState) -> Motion:
    """The motion from a state to another one."""
    matrix = after.world @ np.linalg.inv(before.world)
    vector = rotation_vector(nearest_rotation(_frame(after) @ _frame(before).T))
    angle = float(np.linalg.norm(vector))
    turns = change.turned and angle > ROUNDING
    motion = None
    if turns and not change.scaled:
        motion = _rotation(change, before, after, vector / angle, angle)
    elif change.scaled and not turns:
        motion = _scale(change, before, after)
    return Motion.of(matrix) if motion is None else motion


def _rotation(change: Change, before: ObjectState, after: ObjectState, axis: Floats, angle: float) -> Motion | None:
    """The rotation about a pivot; None if the object also moves along the axis."""
    start, end = before.world[:3, 3], after.world[:3, 3]
    shift = end - start
    pivot = start
    if change.moved:
        rounding = ROUNDING * (np.linalg.norm(shift) * (1 + 1 / angle) + max(np.abs(start).max(), np.abs(end).max()))
        if abs(shift @ axis) > rounding:
            return None
        across = shift - axis * (shift @ axis)
        pivot = (start + end) / 2 + np.cross(axis, across) / (2 * np.tan(angle / 2))
    return _about(pivot, nearest_rotation(_frame(after) @ _frame(before).T))


def _scale(change: Change, before: ObjectState, after: ObjectState) -> Motion | None:
    """The scale along the object's axes; None if it began with a factor of 0."""
    if 0.0 in before.scale:
        return None
    factors = np.asarray(after.scale, np.float64) / np.asarray(before.scale, np.float64)
    start, shift = before.world[:3, 3], after.world[:3, 3] - before.world[:3, 3]
    if np.ptp(factors) <= ROUNDING * np.abs(factors).max():
        factor = float(factors.mean())
        pivot = start - shift / (factor - 1) if change.moved and factor != 1 else start
        return _about(pivot, factor * np.eye(3))
    axes, chosen = _frame(before), factors != 1
    across = shift - FreeDirections(axes, chosen).along(shift)
    along_axes = np.abs(across).max() <= ROUNDING * (np.abs(shift).max() + np.abs(start).max())
    free = FreeDirections(axes, chosen) if along_axes else None
    matrix = np.eye(4)
    matrix[:3, :3] = axes @ np.diag(factors) @ axes.T
    matrix[:3, 3] = start + shift - matrix[:3, :3] @ start
    return Motion(matrix, start, free=free)


def _about(pivot: Floats, linear: Floats) -> Motion:
    matrix = np.eye(4)
    matrix[:3, :3] = linear
    matrix[:3, 3] = pivot - linear @ pivot
    return Motion(matrix, pivot)


def _frame(state: ObjectState) -> Floats:
    """The rotation of an object's axes in the world, (3, 3)."""
    columns = state.world[:3, :3] / np.maximum(np.linalg.norm(state.world[:3, :3], axis=0), np.finfo(np.float64).tiny)
    return nearest_rotation(columns * [1, 1, -1 if np.linalg.det(columns) < 0 else 1])
