# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes over all points of large meshes, which take several passes and copies in NumPy."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stiv import _native
from stiv.arrays import Floats, Indices


def transform_points(matrix: Floats, points: NDArray[Any]) -> Floats:
    """Map points, (n, 3), by an affine map, (4, 4), in double precision."""
    return _mapped(matrix[:3], points)


def apply_linear(matrix: Floats, vectors: NDArray[Any]) -> Floats:
    """Map vectors, (n, 3), by a linear map, (3, 3), in double precision."""
    affine = np.zeros((3, 4))
    affine[:, :3] = matrix
    return _mapped(affine, vectors)


def _mapped(affine: Floats, points: NDArray[Any]) -> Floats:
    """Positions that Blender stores in single precision are read in place."""
    if points.dtype == np.float32:
        return _native.transform_single_points(affine, points)
    return _native.transform_points(affine, points)


def largest_difference(first: Floats, second: Floats) -> float:
    """Return the largest difference between two coordinates at the same place, (n, 3) each; NaN if one of them is."""
    return _native.largest_difference(first, second)


def find_folded(points: NDArray[np.float32], corners: Indices, cosine: float, narrow: float) -> Indices:
    """Return the quads, ascending, that are not certainly open along their first diagonal, in single precision.

    Args:
        points: (n, 3).
        corners: (4, k), in the order of the face. The first diagonal connects the first corner and the third.
        cosine: that of the angle between the normals of both halves, at which a quad is no longer open.
        narrow: height of a half above the diagonal, in the largest coordinate, at which it is no longer open.

    """
    return _native.find_folded(points, corners, cosine, narrow)
