# SPDX-License-Identifier: GPL-3.0-or-later
"""The axes that Blender's transform orientations stand for, as unit columns (3, 3) in world space."""

from __future__ import annotations

from typing import Any

import bmesh
import numpy as np

from ..transform.frame import orthonormal
from ..transform.view import Vector


def axes_of(context: Any, name: str) -> Vector:
    """Axes of an orientation by its name; the world's where it is not followed."""
    read = {"LOCAL": active_axes, "VIEW": _view, "CURSOR": _cursor, "PARENT": _parent, "NORMAL": _normal}.get(name)
    if read is not None:
        return read(context)
    custom = context.scene.transform_orientation_slots[0].custom_orientation if name != "GLOBAL" else None
    return np.eye(3) if custom is None else orthonormal(np.array(custom.matrix))


def is_followed(context: Any, name: str) -> bool:
    """Whether the axes of an orientation are known."""
    return name != "GIMBAL"


def active_axes(context: Any) -> Vector:
    """Those of the active object."""
    thing = context.active_object
    return np.eye(3) if thing is None else orthonormal(np.array(thing.matrix_world)[:3, :3])


def _view(context: Any) -> Vector:
    data = context.region_data
    return np.eye(3) if data is None else orthonormal(np.linalg.inv(np.array(data.view_matrix))[:3, :3])


def _cursor(context: Any) -> Vector:
    return orthonormal(np.array(context.scene.cursor.matrix)[:3, :3])


def _parent(context: Any) -> Vector:
    parent = getattr(context.active_object, "parent", None)
    return np.eye(3) if parent is None else orthonormal(np.array(parent.matrix_world)[:3, :3])


def _normal(context: Any) -> Vector:
    """Of the object; in Edit Mode of a mesh, z is the mean normal of what is selected, and x lies level."""
    thing = context.active_object
    if context.mode != "EDIT_MESH" or thing is None:
        return active_axes(context)
    vertices = [vertex.normal for vertex in bmesh.from_edit_mesh(thing.data).verts if vertex.select]
    inverse = np.linalg.pinv(np.array(thing.matrix_world)[:3, :3])
    z = inverse.T @ np.sum([np.array(normal) for normal in vertices], axis=0) if vertices else np.zeros(3)
    length = np.linalg.norm(z)
    if not length > 0.0:
        return active_axes(context)
    z = z / length
    x = np.cross(z, [0.0, 0.0, 1.0]) if abs(z[2]) < 0.999 else np.array([1.0, 0.0, 0.0])
    return np.asarray(orthonormal(np.column_stack([z, x, np.cross(z, x)]))[:, [1, 2, 0]])
