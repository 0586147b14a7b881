# SPDX-License-Identifier: GPL-3.0-or-later
"""Splits a typed value into increments as small as those of a drag."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from stiv.blender.controls.motion import Motion
from stiv.blender.controls.rotations import nearest_rotation, rotation_matrix, rotation_vector
from stiv.blender.scene.arrays import Floats, diagonal_of, extents, transform_points

Path = Callable[[float], Floats]  # from a fraction in [0, 1] to a transform, (4, 4); 0 is the identity
LARGEST_TURN = 0.1  # radians for each increment
SAMPLES = 16  # of a path, to measure its length


def interpolate_transform(matrix: Floats, fraction: float) -> Floats:
    """Interpolate a transform, (4, 4), between the identity and the matrix: points move on arcs about the fixed point.

    The polar decomposition splits the linear part into rotation and stretch. The fixed point is the least-squares
    solution of (1 - A) x = b nearest to the origin; the residual of b is a translation. The rotation takes the shorter
    way.
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


def count_increments(path: Path, points: Floats, longest: float, most: int) -> int:
    """Number of increments, at most `most`, such that no point, (n, 3), moves much more than `longest` in one."""
    if len(points) == 0 or longest <= 0:
        return 1
    matrices = [path(k / SAMPLES) for k in range(SAMPLES + 1)]
    turn = _turns(np.array(matrices)[:, :3, :3])
    low, high = extents(points)
    corners = np.array([np.where(choice, high, low) for choice in np.ndindex(2, 2, 2)])
    length = _length_of_few(np.array(matrices), corners)  # no point moves further than a corner of its box
    if length > longest:
        length = _length(matrices, points)
    return int(np.clip(np.ceil(max(length / longest, turn / LARGEST_TURN)), 1, most))


def _length(matrices: Sequence[Floats], points: Floats) -> float:
    states = [transform_points(matrix, points) for matrix in matrices]
    return sum(float(np.linalg.norm(after - before, axis=1).max()) for before, after in pairwise(states))


def _length_of_few(matrices: Floats, points: Floats) -> float:
    """As `_length`, with all states in one array."""
    states = np.einsum("ij,nkj->nik", points, matrices[:, :3, :3]) + matrices[:, None, :3, 3]
    longest: list[float] = np.linalg.norm(np.diff(states, axis=0), axis=2).max(axis=1).tolist()
    return sum(longest)


def _turns(linear: Floats) -> float:
    """Sum of the angles from each linear map, (n, 3, 3), to the next.

    Most typed values are translations, which need no decompositions.
    """
    changes = np.flatnonzero((linear[1:] != linear[:-1]).any(axis=(1, 2)))
    return sum(_turn(linear[k], linear[k + 1]) for k in changes)


def _turn(before: Floats, after: Floats) -> float:
    """Angle between two linear maps."""
    return float(np.linalg.norm(rotation_vector(nearest_rotation(after @ np.linalg.pinv(before)))))


STILL = 1e-4  # of the motion of the goal: controls that move less stay where they are
MOST_STILL = 4  # increments in a row, after which the last one decides


class StillIncrements:
    """Counts increments in a row in which contact holds the controls.

    The goal moves on without them: where they cannot follow a few increments, only the last goal matters, and the way
    to it is as long from here as from the increments between.
    """

    def __init__(self) -> None:
        self._count = 0

    def add(self, moved: Floats, asked: Floats) -> None:
        """Add an increment by the motions of the controls and of their goal, (m, 3) each."""
        is_still = np.abs(moved).max(initial=0) <= STILL * np.abs(asked).max(initial=0)
        self._count = self._count + 1 if is_still else 0

    @property
    def are_many(self) -> bool:
        """May the increments up to the last one be left out?"""
        return self._count >= MOST_STILL


LONGEST = 0.02  # increment, in diagonals of the moving points
MOST = 200  # increments for each value


def split_motion(target: Motion, path: Path | None, points: Floats) -> Iterator[Motion]:
    """Motions of increasing size, the target last, such that no point, (n, 3), moves much more than in a drag.

    path: from fractions to matrices, for rotations of more than half a turn; None uses the shortest path.
    """
    to_matrix: Path = path or (lambda fraction: interpolate_transform(target.matrix, fraction))
    count = count_increments(to_matrix, points, LONGEST * diagonal_of(points), MOST)
    for step in range(1, count):
        fraction = step / count
        rotation = None if target.rotation is None else fraction * target.rotation
        motion = replace(target, matrix=to_matrix(fraction), rotation=rotation)
        if np.linalg.det(motion.linear):  # singular only on the way to a mirror image
            yield motion
    yield target
