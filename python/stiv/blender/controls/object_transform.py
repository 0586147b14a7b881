# SPDX-License-Identifier: GPL-3.0-or-later
"""An object's location, rotation and scale: kept for putting back, and changed by a motion in world space."""

from dataclasses import dataclass

import bpy
import mathutils
import numpy as np

from stiv.blender.controls.rotations import is_rotation, nearest_rotation
from stiv.blender.scene.arrays import Floats, as_matrix

ROTATION_PROPERTIES = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}


@dataclass(frozen=True)
class ObjectTransform:
    """What was there at the start.

    Attributes:
        location, rotation, scale: the object's own properties, rotation in its own rotation mode.
        world: world matrix, (4, 4).
        above: from location, rotation and scale (with deltas) to the world: parent and parent inverse, (4, 4).
        basis: location, rotation and scale, deltas included, as a matrix, (4, 4).
    """

    location: tuple[float, ...]
    rotation_property: str
    rotation: tuple[float, ...]
    scale: tuple[float, ...]
    world: Floats
    above: Floats
    basis: Floats

    def holds_rotations(self) -> bool:
        """Is every rotation in the world a rotation of the object's own?"""
        above = self.above[:3, :3]
        size = np.cbrt(abs(np.linalg.det(above)))
        return is_rotation(above / size * np.sign(np.linalg.det(above)))

    def restore(self, ob: bpy.types.Object) -> None:
        """Put location, rotation and scale back, bit by bit."""
        ob.location = self.location
        setattr(ob, self.rotation_property, self.rotation)
        ob.scale = self.scale


def read_transform(ob: bpy.types.Object) -> ObjectTransform:
    """The object's transform as it is now; its size must not be zero."""
    world, basis = as_matrix(ob.matrix_world), as_matrix(ob.matrix_basis)
    name = ROTATION_PROPERTIES.get(ob.rotation_mode, "rotation_euler")
    above = world @ np.linalg.inv(basis)
    return ObjectTransform(tuple(ob.location), name, tuple(getattr(ob, name)), tuple(ob.scale), world, above, basis)


def write_transform(ob: bpy.types.Object, start: ObjectTransform, motion: Floats, factors: Floats) -> None:
    """Let the object follow `motion`, (4, 4), since the start: rigid, or a scaling by `factors` along its axes.

    The world matrix becomes motion @ start.world. A rotation turns the object's own; factors multiply its own scale.
    """
    inner = np.linalg.inv(start.above) @ motion @ start.above
    shift = (inner @ start.basis)[:3, 3] - start.basis[:3, 3]
    ob.location = np.asarray(start.location) + shift
    ob.scale = np.asarray(start.scale) * factors
    if np.array_equal(factors, np.ones(3)) and not np.array_equal(motion[:3, :3], np.eye(3)):
        _write_rotation(ob, start, nearest_rotation(inner[:3, :3]))
    else:
        setattr(ob, start.rotation_property, start.rotation)


def _write_rotation(ob: bpy.types.Object, start: ObjectTransform, turn: Floats) -> None:
    """The whole rotation is delta @ own; own becomes delta' @ turn @ delta @ own."""
    setattr(ob, start.rotation_property, start.rotation)
    own = _own_rotation(ob)
    lengths = np.asarray(start.scale) * np.asarray(ob.delta_scale)
    delta = nearest_rotation(start.basis[:3, :3] / lengths @ own.T)
    _set_own_rotation(ob, mathutils.Matrix((delta.T @ turn @ delta @ own).tolist()))


def _own_rotation(ob: bpy.types.Object) -> Floats:
    if ob.rotation_mode == "QUATERNION":
        return as_matrix(ob.rotation_quaternion.normalized().to_matrix())
    if ob.rotation_mode == "AXIS_ANGLE":
        angle, *axis = ob.rotation_axis_angle
        return as_matrix(mathutils.Matrix.Rotation(angle, 3, mathutils.Vector(axis)))
    return as_matrix(ob.rotation_euler.to_matrix())


def _set_own_rotation(ob: bpy.types.Object, rotation: mathutils.Matrix) -> None:
    """In the object's rotation mode, the representation nearest to the present one."""
    if ob.rotation_mode == "QUATERNION":
        quaternion = rotation.to_quaternion()
        ob.rotation_quaternion = -quaternion if quaternion.dot(ob.rotation_quaternion) < 0 else quaternion
    elif ob.rotation_mode == "AXIS_ANGLE":
        axis, angle = rotation.to_quaternion().to_axis_angle()
        ob.rotation_axis_angle = (angle, *axis)
    else:
        ob.rotation_euler = rotation.to_euler(ob.rotation_mode, ob.rotation_euler)
