# SPDX-License-Identifier: GPL-3.0-or-later
"""Location, rotation and scale of objects as controls: groups that keep their shape, or are scaled along their axes."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from stiv import InputError
from stiv.blender.controls.control_set import Part
from stiv.blender.controls.location_locks import FreeDirections, free_directions, keep_locked
from stiv.blender.controls.motion import Influence, Motion
from stiv.blender.controls.object_transform import ObjectTransform, read_transform, write_transform
from stiv.blender.controls.rigid_groups import RigidGroup
from stiv.blender.controls.rotations import (
    about,
    nearest_rotation,
    nearest_turn,
    rotation_matrix,
    rotation_vector,
    without_rounding,
)
from stiv.blender.controls.transform_locks import may_turn
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings


def rigid_part(group: RigidGroup, surfaces: tuple[int, ...], rest: Floats, settings: EditSettings, kind: str) -> Part:
    """A group of objects as one part; `rest` are the world positions of its surfaces, (n, 3)."""
    starts = [read_transform(root.reference.find()) for root in group.roots]
    selected = group.roots[0].selected
    scales = kind == "scale" and selected
    axes = _axes(group, starts) if scales else None
    deformation = stiv.rigid(rest) if axes is None else stiv.scaling(rest, axes)
    controls = stiv.rigid_rest_controls(rest) if axes is None else stiv.scaling_rest_controls(rest)
    turns = scales or _may_turn(group, starts, kind if selected else "move")
    objects = [root.reference.find() for root in group.roots]
    free = None if scales else free_directions(objects, starts)
    turns = turns and free is None  # a turn about the centre would move the origin along locked axes
    weight = settings.weight(True) if selected else 1.0
    given = np.array([1.0, float(turns)]) if free is None else np.array([free.free, np.zeros(3)], np.float64)
    references = tuple(root.reference for root in group.roots)
    return Part(
        tuple(reference.name for reference in references), "rigid", surfaces, deformation, controls,
        weight * given, given, None,
        PlacementGoal(selected, turns, axes, starts[0].world[:3, 3], free),
        PlacementWriter(references, tuple(starts), controls[0], axes),
        weight_axes=None if free is None else np.array([free.axes, np.eye(3)]),
    )  # fmt: skip


@dataclass(frozen=True)
class PlacementGoal:
    """Centre and rotation vector follow the transform, or with `axes` (3, 3) centre and factors along them.

    `origin`, (3,), is that of the first root, about which it turns and grows where each object has its own. `free` are
    the directions that locked axes of the location leave, None: all.
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
                raise InputError("a scale of 0 would press objects flat; deform them instead, or choose another factor")
        elif self.turns:
            goal[1] = nearest_turn(rotation_vector(nearest_rotation(linear)), last[1])
        return goal

    def reached(self, influence: Influence | None) -> NDArray[np.bool_]:
        """Centre and rotation or factors of a selected group, (2,); objects are not moved by nearness."""
        return np.full(2, self.selected)


@dataclass(frozen=True)
class PlacementWriter:
    """Writes location, and rotation or scale, of the roots of a group. `centre` is that of the start."""

    references: tuple[ObjectReference, ...]
    starts: tuple[ObjectTransform, ...]
    centre: Floats
    axes: Floats | None

    def write(self, controls: Floats) -> None:
        """Write centre and rotation vector, or centre and scale factors, (2, 3)."""
        if self.axes is None:
            linear, factors = rotation_matrix(without_rounding(controls[1], unit=1.0)), np.ones(3)
        else:
            linear, factors = (self.axes * controls[1]) @ self.axes.T, controls[1]
        motion = about(self.centre, linear, self.centre + without_rounding(controls[0] - self.centre))
        for ob, start in self._objects():
            if np.array_equal(motion, np.eye(4)):
                start.restore(ob)
            else:
                write_transform(ob, start, motion, factors)
                if self.axes is None:
                    keep_locked(ob, start)

    def restore(self) -> None:
        """Put back location, rotation and scale of the start."""
        for ob, start in self._objects():
            start.restore(ob)

    def _objects(self) -> list[tuple[bpy.types.Object, ObjectTransform]]:
        return [(reference.find(), start) for reference, start in zip(self.references, self.starts, strict=True)]


def _may_turn(group: RigidGroup, starts: Sequence[ObjectTransform], kind: str) -> bool:
    """Can all roots hold a rotation? One below an unevenly scaled parent, or with locks, cannot.

    Raises InputError for rotations, where the parent is the reason; what is locked is moved without being turned.
    """
    if not all(may_turn(root.reference.find()) for root in group.roots):
        return False
    for root, start in zip(group.roots, starts, strict=True):
        if not start.holds_rotations():
            if kind == "rotate":
                raise InputError(
                    f'object "{root.reference.name}": its parent is scaled unevenly, so that it cannot be rotated '
                    "without being sheared; apply the parent's scale, or clear the parent"
                )
            return False
    return True


def _axes(group: RigidGroup, starts: Sequence[ObjectTransform]) -> Floats:
    """World axes of the group's roots as a rotation, (3, 3). Raises InputError where they are not at right angles."""
    frames = []
    for root, start in zip(group.roots, starts, strict=True):
        columns = start.world[:3, :3] / np.linalg.norm(start.world[:3, :3], axis=0)
        if np.abs(columns.T @ columns - np.eye(3)).max() > 1e-5:
            raise InputError(
                f'object "{root.reference.name}": is sheared by its parent and cannot be scaled along its axes; '
                "apply its transform, or deform it instead"
            )
        frames.append(nearest_rotation(columns * [1, 1, np.sign(np.linalg.det(columns))]))
    for root, frame in zip(group.roots[1:], frames[1:], strict=True):
        if np.abs(np.abs(frames[0].T @ frame) - np.eye(3)).max() > 1e-5:
            raise InputError(
                f'object "{root.reference.name}": moves as one with object "{group.roots[0].reference.name}", which is '
                "turned otherwise, so they cannot be scaled together; give them a common parent"
            )
    return frames[0]
