# SPDX-License-Identifier: GPL-3.0-or-later
"""The frame of a transform: pivot and axes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..modal.axis_lock import AxisLock
from .view import Vector, View


@dataclass(frozen=True)
class Frame:
    """Pivot and orientation of a transform, in world space.

    Attributes:
        pivot: (3,) fixed point of rotations and scalings.
        axes: (3, 3) unit columns of the orientation's X, Y and Z.
        view: the view of the pointer; None for transforms by values.
        second_axes: (3, 3) unit columns for an axis key pressed twice.
        individual: each object or island of vertices has its own pivot.

    """

    pivot: Vector
    axes: Vector = field(default_factory=lambda: np.eye(3))
    view: View | None = None
    second_axes: Vector = field(default_factory=lambda: np.eye(3))
    individual: bool = False

    def axes_of(self, axis_lock: AxisLock) -> Vector:
        """The axes of a lock, (3, 3) columns."""
        return self.second_axes if axis_lock.second else self.axes


def about(pivot: Vector, linear: Vector) -> Vector:
    """(4, 4) matrix of a linear map (3, 3) with the fixed point `pivot`."""
    matrix = np.eye(4)
    matrix[:3, :3] = linear
    matrix[:3, 3] = pivot - linear @ pivot
    return matrix


def orthonormal(axes: Vector) -> Vector:
    """Orthonormal columns (3, 3) from the matrix of an object, which may be scaled, mirrored or sheared.

    Gram-Schmidt in the order x, y, in double precision: matrices of Blender 5 are read in single precision, and the
    core asks for more. Degenerate axes give the identity.
    """
    axes = np.asarray(axes, np.float64)
    with np.errstate(invalid="ignore", divide="ignore"):
        x = axes[:, 0] / np.linalg.norm(axes[:, 0])
        y = axes[:, 1] - x * (x @ axes[:, 1])
        y = y / np.linalg.norm(y)
    result = np.column_stack([x, y, np.cross(x, y)])
    valid = np.allclose(result.T @ result, np.eye(3), atol=1e-6)  # false for nan and for normalised rounding noise
    return result if valid else np.eye(3)


def pivot_of(points: Vector, choice: str, *, cursor: Vector, active: Vector | None) -> Vector:
    """The pivot (3,) for points (k, 3) in world space.

    Args:
        points: origins of the selected objects, or selected vertices or lattice points.
        choice: Blender's `transform_pivot_point`; "INDIVIDUAL_ORIGINS" gives the median.
        cursor: (3,) the 3D cursor.
        active: (3,) the active element, None without one.

    """
    if choice == "CURSOR" or len(points) == 0:
        return cursor
    if choice == "ACTIVE_ELEMENT" and active is not None:
        return active
    if choice == "BOUNDING_BOX_CENTER":
        return np.asarray((points.min(axis=0) + points.max(axis=0)) / 2.0)
    return np.asarray(points.mean(axis=0))
