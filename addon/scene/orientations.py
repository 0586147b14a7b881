# SPDX-License-Identifier: GPL-3.0-or-later
"""The axes of Blender's transform orientations, as unit columns (3, 3) in world space."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np

from ..transform.frame import orthonormal
from ..transform.view import Vector


def axes_of(context: bpy.types.Context, name: str) -> Vector:
    """Axes of an orientation by its name; those of the world for one that is not supported."""
    read = {"LOCAL": active_axes, "VIEW": view_axes, "CURSOR": _cursor, "PARENT": _parent, "NORMAL": _normal}.get(name)
    if read is not None:
        return read(context)
    custom = context.scene.transform_orientation_slots[0].custom_orientation if name != "GLOBAL" else None
    return np.eye(3) if custom is None else orthonormal(np.array(custom.matrix))


def is_supported(name: str) -> bool:
    """Whether `axes_of` gives the axes of an orientation."""
    return name != "GIMBAL"


def active_axes(context: bpy.types.Context) -> Vector:
    """The axes of the active object, or of the active bone in Pose Mode."""
    return (
        _bone_axes(context, context.active_pose_bone) if context.mode == "POSE" else _object_axes(context.active_object)
    )


def _bone_axes(context: bpy.types.Context, bone: bpy.types.PoseBone | None) -> Vector:
    if bone is None:
        return _object_axes(context.active_object)
    return orthonormal(np.array(bone.id_data.matrix_world @ bone.matrix)[:3, :3])


def _object_axes(obj: bpy.types.Object | None) -> Vector:
    return np.eye(3) if obj is None else orthonormal(np.array(obj.matrix_world)[:3, :3])


def view_axes(context: bpy.types.Context) -> Vector:
    """(3, 3) unit columns right, up and toward the viewer; the identity without a view."""
    data = context.region_data
    return np.eye(3) if data is None else orthonormal(np.linalg.inv(np.array(data.view_matrix))[:3, :3])


def _cursor(context: bpy.types.Context) -> Vector:
    return orthonormal(np.array(context.scene.cursor.matrix)[:3, :3])


def _parent(context: bpy.types.Context) -> Vector:
    if context.mode == "POSE":
        return _bone_axes(context, getattr(context.active_pose_bone, "parent", None))
    return _object_axes(getattr(context.active_object, "parent", None))


def _normal(context: bpy.types.Context) -> Vector:
    """The axes of the object; in Edit Mode of a mesh, z is the mean normal of the selection and x is horizontal."""
    obj = context.active_object
    if context.mode != "EDIT_MESH" or obj is None:
        return active_axes(context)
    normals = [np.array(vertex.normal) for vertex in bmesh.from_edit_mesh(obj.data).verts if vertex.select]
    inverse = np.linalg.pinv(np.array(obj.matrix_world)[:3, :3])
    z = inverse.T @ np.sum(normals, axis=0) if normals else np.zeros(3)
    length = np.linalg.norm(z)
    if not length > 0.0:
        return active_axes(context)
    z = z / length
    x = np.cross(z, [0.0, 0.0, 1.0]) if abs(z[2]) < 0.999 else np.array([1.0, 0.0, 0.0])
    return np.asarray(orthonormal(np.column_stack([z, x, np.cross(z, x)]))[:, [1, 2, 0]])
