# SPDX-License-Identifier: GPL-3.0-or-later
"""The fixed point of a transform, from the positions of what is selected."""

from __future__ import annotations

import numpy as np

from .view import Vector


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
