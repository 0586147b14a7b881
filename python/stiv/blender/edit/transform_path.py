# SPDX-License-Identifier: GPL-3.0-or-later
"""A path from rest to an affine transform, along which a typed value is approached."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from stiv.blender.controls.rotations import nearest_rotation, rotation_matrix, rotation_vector
from stiv.blender.scene.arrays import Floats, transform_points

Path = Callable[[float], Floats]  # from a fraction in [0, 1] to a transform, (4, 4); 0 is rest

LARGEST_TURN = 0.1  # radians in one step
SAMPLES = 16  # of a path, to measure its length


def transform_at(matrix: Floats, fraction: float) -> Floats:
    """The transform, (4, 4), a fraction of the way from rest: points on arcs about the transform's fixed point.

    The linear part is split into rotation and stretch (polar); the fixed point, nearest to the origin, solves
    (1 - A) x = b in the sense of least squares, and what is left of b is a translation. The rotation goes the shorter
    way round.
    """
    if fraction >= 1:
        return matrix
    linear, shift = matrix[:3, :3], matrix[:3, 3]
    rotation = nearest_rotation(linear)
    stretch = rotation.T @ linear
    part = np.eye(4)
    stretched = np.eye(3) + fraction * (stretch - np.eye(3))
    part[:3, :3] = rotation_matrix(fraction * rotation_vector(rotation)) @ stretched
    fixed = np.linalg.pinv(np.eye(3) - linear, rcond=1e-9) @ shift
    left = shift - (fixed - linear @ fixed)
    part[:3, 3] = fixed - part[:3, :3] @ fixed + fraction * left
    return part


def increments(path: Path, points: Floats, longest: float, most: int) -> int:
    """In how many steps to go, so that no point, (n, 3), moves much farther than `longest` in one; at most `most`."""
    if len(points) == 0 or longest <= 0:
        return 1
    matrices = [path(k / SAMPLES) for k in range(SAMPLES + 1)]
    places = [transform_points(matrix, points) for matrix in matrices]
    length = sum(float(np.linalg.norm(after - before, axis=1).max()) for before, after in pairwise(places))
    turn = sum(_angle(after[:3, :3] @ np.linalg.pinv(before[:3, :3])) for before, after in pairwise(matrices))
    return int(np.clip(np.ceil(max(length / longest, turn / LARGEST_TURN)), 1, most))


def _angle(linear: Floats) -> float:
    return float(np.linalg.norm(rotation_vector(nearest_rotation(linear))))
