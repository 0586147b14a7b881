# SPDX-License-Identifier: GPL-3.0-or-later
"""Location, rotation and scale as controls of rigid groups."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from stiv import InputError
from stiv.blender.controls.control_set import ControlSet
from stiv.blender.controls.motion import Influence, Motion
from stiv.blender.controls.object_transform import ObjectTransform, read_transform, write_transform
from stiv.blender.controls.points import FreeDirections
from stiv.blender.controls.rigid_groups import RigidGroup
from stiv.blender.controls.rotations import (
    affine_about,
    nearest_equivalent,
    nearest_rotation,
    remove_rounding,
    rotation_matrix,
    rotation_vector,
)
from stiv.blender.controls.transform_locks import can_rotate, find_free_directions, restore_locked
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings


def make_rigid_set(
    group: RigidGroup, surfaces: tuple[int, ...], rest: Floats, settings: EditSettings, kind: str
) -> ControlSet:
    """Control set of a rigid group; `rest` are the world positions of its surfaces, (n, 3)."""
    starts = [read_transform(root.reference.find()) for root in group.roots]
    selected = group.roots[0].selected
    scales = kind == "scale" and selected
    axes = _axes(group, starts) if scales else None
    deformation = stiv.rigid(rest) if axes is None else stiv.scaling(rest, axes)
    controls = stiv.rigid_rest_controls(rest) if axes is None else stiv.scaling_rest_controls(rest)
    turns = scales or _may_turn(group, starts, kind if selected else "move", settings)
    objects = [root.reference.find() for root in group.roots]
    free = None if scales else find_free_directions(objects, starts)
    turns = turns and free is None  # rotation about the centre would move the origin along locked axes
    weight = settings.response_weight(True) if selected else 1.0
    max_weights = np.array([1.0, float(turns)]) if free is None else np.array([free.free, np.zeros(3)], np.float64)
    references = tuple(root.reference for root in group.roots)
    return ControlSet(
        tuple(reference.name for reference in references), "rigid", surfaces, deformation, controls,
        weight * max_weights, max_weights, None,
        PlacementGoal(selected, turns, axes, starts[0].world[:3, 3], free),
        PlacementWriter(references, tuple(starts), controls[0], axes),
        weight_axes=None if free is None else np.array([free.axes, np.eye(3)]),
    )  # fmt: skip


@dataclass(frozen=True)
class PlacementGoal:
    """Centre and rotation vector follow the transform; with `axes` (3, 3), centre and scale factors along them.

    `origin`, (3,), is that of the first root, the pivot for individual origins. `free` are the directions that location
    locks leave free, None for all.
    """

    selected: bool
    turns: bool
    axes: Floats | None
    origin: Floats
    free: FreeDirections | None = None

    @property
    def moves(self) -> bool:
        """Is the group selected?"""
        return self.selected

    def goal(self, controls: Floats, last: Floats, motion: Motion) -> Floats:
        """Goal of centre and rotation vector, or centre and scale factors, (2, 3)."""
        if not self.selected:
            return controls
        goal = controls.copy()
        goal[0] = motion.about(controls[0], self.origin) if motion.individual else motion.whole(controls[:1])[0]
        if self.free is not None:
            goal[0] = controls[0] + self.free.along(goal[0] - controls[0])
        linear = motion.linear
        if self.axes is not None:
            goal[1] = np.einsum("ki,kl,li->i", self.axes, linear, self.axes)
            if not goal[1].all():
                raise InputError("a scale of 0 would flatten objects; choose another factor")
        elif self.turns:
            goal[1] = nearest_equivalent(rotation_vector(nearest_rotation(linear)), last[1])
        return goal

    def affected(self, influence: Influence | None) -> NDArray[np.bool_]:
        """Flags of the controls of a selected group, (2,); proportional editing does not affect objects."""
        return np.full(2, self.selected)

    def turned(self, controls: Floats, goal: Floats) -> float:
        """Angle in radians by which a selected group rotates though its goal does not."""
        if not self.selected or self.axes is not None or goal[1].any():
            return 0.0
        return float(np.linalg.norm(controls[1]))


@dataclass(frozen=True)
class PlacementWriter:
    """Writes location, and rotation or scale, of the roots of a group. `centre` is that at the start."""

    references: tuple[ObjectReference, ...]
    starts: tuple[ObjectTransform, ...]
    centre: Floats
    axes: Floats | None

    def write(self, controls: Floats) -> None:
        """Write centre and rotation vector, or centre and scale factors, (2, 3)."""
        if self.axes is None:
            linear, factors = rotation_matrix(remove_rounding(controls[1], unit=1.0)), np.ones(3)
        else:
            linear, factors = (self.axes * controls[1]) @ self.axes.T, controls[1]
        motion = affine_about(self.centre, linear, self.centre + remove_rounding(controls[0] - self.centre))
        for ob, start in self._objects():
            if np.array_equal(motion, np.eye(4)):
                start.restore(ob)
            else:
                write_transform(ob, start, motion, factors)
                if self.axes is None:
                    restore_locked(ob, start)

    def restore(self) -> None:
        """Restore location, rotation and scale."""
        for ob, start in self._objects():
            start.restore(ob)

    def _objects(self) -> list[tuple[bpy.types.Object, ObjectTransform]]:
        return [(reference.find(), start) for reference, start in zip(self.references, self.starts, strict=True)]


def _may_turn(group: RigidGroup, starts: Sequence[ObjectTransform], kind: str, settings: EditSettings) -> bool:
    """Can all roots be rotated? Not while objects slide, below an unevenly scaled parent, or with locks.

    Raises InputError for rotations below that parent; locked objects move without rotation.
    """
    if kind != "rotate" and settings.object_response != "slide_and_turn":
        return False
    if not all(can_rotate(root.reference.find()) for root in group.roots):
        return False
    for root, start in zip(group.roots, starts, strict=True):
        if not start.can_hold_rotations():
            if kind == "rotate":
                raise InputError(f"{root.reference.name}: its parent is scaled unevenly; apply the parent's scale")
            return False
    return True


def _axes(group: RigidGroup, starts: Sequence[ObjectTransform]) -> Floats:
    """World axes of the group's roots as a rotation, (3, 3). Raises InputError if they are not orthogonal."""
    frames = []
    for root, start in zip(group.roots, starts, strict=True):
        columns = start.world[:3, :3] / np.linalg.norm(start.world[:3, :3], axis=0)
        if np.abs(columns.T @ columns - np.eye(3)).max() > 1e-5:
            raise InputError(f"{root.reference.name}: its parent shears it; apply its transform")
        frames.append(nearest_rotation(columns * [1, 1, np.sign(np.linalg.det(columns))]))
    for root, frame in zip(group.roots[1:], frames[1:], strict=True):
        if np.abs(np.abs(frames[0].T @ frame) - np.eye(3)).max() > 1e-5:
            raise InputError(
                f'{root.reference.name}: moves with "{group.roots[0].reference.name}" '
                "but has another rotation; scale it alone"
            )
    return frames[0]
