# SPDX-License-Identifier: GPL-3.0-or-later
"""What a transform refers to: pivot and axes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..modal.axis_lock import Constraint
from .view import Vector, View


@dataclass(frozen=True)
class Frame:
    """Pivot and orientation of a transform, in world space.

    Attributes:
        pivot: (3,) fixed point of rotations and scalings.
        axes: (3, 3) unit columns that X, Y and Z stand for.
        view: the view that the pointer is in; None where values are given.
        second_axes: (3, 3) those of an axis key pressed twice.
        individual: whether each object or island of vertices has a pivot of its own.

    """

    pivot: Vector
    axes: Vector = field(default_factory=lambda: np.eye(3))
    view: View | None = None
    second_axes: Vector = field(default_factory=lambda: np.eye(3))
    individual: bool = False

    def axes_of(self, constraint: Constraint) -> Vector:
        """The axes that a lock refers to, (3, 3) columns."""
        return self.second_axes if constraint.second else self.axes


def about(pivot: Vector, linear: Vector) -> Vector:
    """(4, 4) matrix of a linear map (3, 3) that leaves `pivot` where it is."""
    matrix = np.eye(4)
    matrix[:3, :3] = linear
    matrix[:3, 3] = pivot - linear @ pivot
    return matrix


def orthonormal(axes: Vector) -> Vector:
    """Unit columns (3, 3) from those of an object's matrix, which may be scaled, mirrored or sheared.

    The first column keeps its direction, the second its plane. Collapsed axes give the world's.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        x = axes[:, 0] / np.linalg.norm(axes[:, 0])
        y = axes[:, 1] - x * (x @ axes[:, 1])
        y = y / np.linalg.norm(y)
    result = np.column_stack([x, y, np.cross(x, y)])
    sound = np.allclose(result.T @ result, np.eye(3), atol=1e-6)  # not for nan, nor where only rounding was normalised
    return result if sound else np.eye(3)


def pivot_of(points: Vector, choice: str, *, cursor: Vector, active: Vector | None) -> Vector:
    """The pivot (3,) for points (k, 3) in world space.

    Args:
        points: origins of the selected objects, or selected vertices or lattice points.
        choice: Blender's `transform_pivot_point`; "INDIVIDUAL_ORIGINS" counts as the median.
        cursor: (3,) the 3D cursor.
        active: (3,) the active element, None where there is none.

    """
    if choice == "CURSOR" or len(points) == 0:
        return cursor
    if choice == "ACTIVE_ELEMENT" and active is not None:
        return active
    if choice == "BOUNDING_BOX_CENTER":
        return np.asarray((points.min(axis=0) + points.max(axis=0)) / 2.0)
    return np.asarray(points.mean(axis=0))
