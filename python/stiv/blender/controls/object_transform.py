# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads, writes and restores an object's location, rotation and scale."""

from dataclasses import dataclass

import bpy
import mathutils
import numpy as np

from stiv import InputError
from stiv.blender.controls.parent_space import ParentSpace, keep_locked, read_parent_space
from stiv.blender.controls.rotations import euler_angles, is_rotation, nearest_rotation
from stiv.blender.scene.arrays import Floats, as_matrix, invert

RIGHT_ANGLE = 1e-5  # cosine of an angle that still is one
ROUNDING = 2.0**-48  # relative error of a location in the parent's space
ROTATION_PROPERTIES = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}


@dataclass(frozen=True)
class ObjectTransform:
    """An object's transform at the start.

    Attributes:
        location, rotation, scale: the object's own properties; rotation in its own rotation mode.
        world: world matrix, (4, 4).
        above: matrix of the parent and its inverse, (4, 4), from `basis` to the world.
        basis: matrix of location, rotation and scale, including deltas, (4, 4).
        space: how Blender rounds places below a parent; None without a parent, or where it is unknown.
    """

    location: tuple[float, ...]
    rotation_property: str
    rotation: tuple[float, ...]
    scale: tuple[float, ...]
    world: Floats
    parent_matrix: Floats
    basis: Floats
    space: ParentSpace | None = None

    def can_hold_rotations(self) -> bool:
        """Can the object's own rotation express every rotation in the world?"""
        parent_matrix = self.parent_matrix[:3, :3]
        size = np.cbrt(abs(np.linalg.det(parent_matrix)))
        return is_rotation(parent_matrix / size * np.sign(np.linalg.det(parent_matrix)))

    def changed(self, ob: bpy.types.Object) -> list[str]:
        """Names of the properties that differ from those at the start."""
        start = {"location": self.location, self.rotation_property: self.rotation, "scale": self.scale}
        return [name for name, values in start.items() if tuple(getattr(ob, name)) != values]

    def restore(self, ob: bpy.types.Object) -> None:
        """Restore location, rotation and scale exactly."""
        ob.location = self.location
        setattr(ob, self.rotation_property, self.rotation)
        ob.scale = self.scale


def read_transform(ob: bpy.types.Object) -> ObjectTransform:
    """Read the object's transform; its scale must not be zero."""
    world, basis = as_matrix(ob.matrix_world), as_matrix(ob.matrix_basis)
    name = ROTATION_PROPERTIES.get(ob.rotation_mode, "rotation_euler")
    parent_matrix = np.eye(4) if np.array_equal(world, basis) else world @ invert(basis)
    return ObjectTransform(
        tuple(ob.location), name, tuple(getattr(ob, name)), tuple(ob.scale), world, parent_matrix, basis,
        read_parent_space(ob),
    )  # fmt: skip


def check_axes(name: str, world: Floats, right_angle: float = RIGHT_ANGLE) -> None:
    """Raise InputError for an object with this world matrix, (4, 4), unless its axes are at right angles.

    right_angle: cosine of an angle that still is one.
    """
    axes = world[:3, :3] / np.maximum(np.linalg.norm(world[:3, :3], axis=0), np.finfo(float).tiny)
    products = axes.T @ axes
    if np.abs(products - np.diag(np.diag(products))).max() > right_angle:
        raise InputError(f"{name}: its parent shears it; apply its transform")


def are_parallel(one: Floats, other: Floats) -> bool:
    """Have two frames of unit axes, (3, 3) each, the same axes, up to their direction?"""
    return bool(np.abs(np.abs(one.T @ other) - np.eye(3)).max() <= RIGHT_ANGLE)


def write_transform(ob: bpy.types.Object, start: ObjectTransform, motion: Floats, factors: Floats) -> None:
    """Move the object by `motion`, (4, 4), since the start: rigidly, or scaled by `factors` along its axes.

    The world matrix becomes motion @ start.world. A rotation changes the object's own rotation, factors its own scale.
    """
    inner = invert(start.parent_matrix) @ motion @ start.parent_matrix
    shift = (inner @ start.basis)[:3, 3] - start.basis[:3, 3]
    size = max(float(np.abs(each[:3, 3]).max()) for each in (motion, start.basis, start.parent_matrix))
    shift[np.abs(shift) <= ROUNDING * size] = 0.0
    location = np.asarray(start.location) + shift
    if start.space is not None and np.array_equal(motion[:3, :3], np.eye(3)):
        place = start.world[:3, 3]
        ob.location = keep_locked(start.space, location, place, place + motion[:3, 3])
    else:
        ob.location = location
    ob.scale = np.asarray(start.scale) * factors
    if np.array_equal(factors, np.ones(3)) and not np.array_equal(motion[:3, :3], np.eye(3)):
        _write_rotation(ob, start, nearest_rotation(inner[:3, :3]))
    else:
        setattr(ob, start.rotation_property, start.rotation)


def _write_rotation(ob: bpy.types.Object, start: ObjectTransform, turn: Floats) -> None:
    """The complete rotation is delta @ own; own becomes delta' @ turn @ delta @ own."""
    setattr(ob, start.rotation_property, start.rotation)
    own = _own_rotation(ob)
    lengths = np.asarray(start.scale) * np.asarray(ob.delta_scale)
    delta = nearest_rotation(start.basis[:3, :3] / lengths @ own.T)
    _set_own_rotation(ob, nearest_rotation(delta.T @ turn @ delta @ own))


def _own_rotation(ob: bpy.types.Object) -> Floats:
    if ob.rotation_mode == "QUATERNION":
        return as_matrix(ob.rotation_quaternion.normalized().to_matrix())
    if ob.rotation_mode == "AXIS_ANGLE":
        angle, *axis = ob.rotation_axis_angle
        return as_matrix(mathutils.Matrix.Rotation(angle, 3, mathutils.Vector(axis)))
    return as_matrix(ob.rotation_euler.to_matrix())


def _set_own_rotation(ob: bpy.types.Object, matrix: Floats) -> None:
    """Set the rotation, (3, 3), in the object's mode, using the representation nearest to the present one."""
    rotation = mathutils.Matrix(matrix.tolist())
    if ob.rotation_mode == "QUATERNION":
        quaternion = rotation.to_quaternion()
        ob.rotation_quaternion = -quaternion if quaternion.dot(ob.rotation_quaternion) < 0 else quaternion
    elif ob.rotation_mode == "AXIS_ANGLE":
        axis, angle = rotation.to_quaternion().to_axis_angle()
        ob.rotation_axis_angle = (angle, *axis)
    else:
        ob.rotation_euler = euler_angles(matrix, ob.rotation_mode, np.array(ob.rotation_euler))
