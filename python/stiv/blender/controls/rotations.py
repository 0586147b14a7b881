# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotation vectors and rotation matrices."""

import numpy as np

from stiv.blender.scene.arrays import Floats

SINGLE = 2.0**-23  # spacing of single-precision numbers at 1
OPPOSITE = 1e-7  # sine of the angle below which unit vectors are parallel or opposite


def rotation_matrix(vector: Floats) -> Floats:
    """The rotation by |vector| radians about vector, (3, 3) (Rodrigues)."""
    angle = float(np.linalg.norm(vector))
    if angle == 0:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    rotation: Floats = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return rotation


def rotation_vector(matrix: Floats) -> Floats:
    """The vector of a rotation, with an angle in [0, pi]; computed from the unit quaternion, stable for all angles."""
    quaternion = _quaternion(matrix)
    length = float(np.linalg.norm(quaternion[1:]))
    if length == 0:
        return np.zeros(3)
    vector: Floats = quaternion[1:] * (2 * np.arctan2(length, quaternion[0]) / length)
    return vector


def nearest_equivalent(vector: Floats, last: Floats) -> Floats:
    """The vector of the same rotation nearest to `last`, by full turns: a drag may exceed one turn."""
    angle = float(np.linalg.norm(vector))
    reference = last if angle == 0 else vector
    length = float(np.linalg.norm(reference))
    if length == 0:
        return vector
    axis = reference / length
    turns = round((float(last @ axis) - (float(vector @ axis))) / (2 * np.pi))
    return vector + axis * (2 * np.pi * turns)


def euler_angles(matrix: Floats, order: str, near: Floats) -> Floats:
    """The Euler angles, (3,), of a rotation in Blender's order ("XYZ" turns about X first), nearest to other angles.

    Exact to double precision also where the middle angle is close to a right angle, unlike Blender's own conversion.
    """
    i, j, k = ("XYZ".index(axis) for axis in order)
    parity = 1 if (j - i) % 3 == 1 else -1
    middle = np.arctan2(-matrix[k, i], np.hypot(matrix[i, i], matrix[j, i]))
    if np.hypot(matrix[i, i], matrix[j, i]) < 1e-12:
        first, last = np.arctan2(-matrix[j, k], matrix[j, j]), 0.0
    else:
        first, last = np.arctan2(matrix[k, j], matrix[k, k]), np.arctan2(matrix[j, i], matrix[i, i])
    found = []
    for angles in ((first, middle, last), (first + np.pi, np.pi - middle, last + np.pi)):
        signed = np.zeros(3)
        signed[[i, j, k]] = np.array(angles) * parity
        found.append(signed + 2 * np.pi * np.round((near - signed) / (2 * np.pi)))
    return min(found, key=lambda each: float(np.abs(each - near).sum()))


def rotation_between(start: Floats, end: Floats) -> Floats:
    """The least rotation, (3, 3), that takes a unit vector, (3,), to another one; any half turn for opposite ones."""
    axis, cosine = np.cross(start, end), float(start @ end)
    sine = float(np.linalg.norm(axis))
    if sine < OPPOSITE:
        if cosine > 0:
            return np.eye(3)
        axis, sine = np.cross(start, np.eye(3)[int(np.argmin(np.abs(start)))]), 0.0
    return rotation_matrix(axis / np.linalg.norm(axis) * np.arctan2(sine, cosine))


def nearest_rotation(matrix: Floats) -> Floats:
    """The rotation nearest to a linear map, (3, 3): its polar factor without reflection."""
    u, _, vt = np.linalg.svd(matrix)
    signs = np.array([1.0, 1.0, np.sign(np.linalg.det(u @ vt)) or 1.0])
    rotation: Floats = (u * signs) @ vt
    return rotation


def is_rotation(matrix: Floats, tolerance: float = 1e-5) -> bool:
    """Does a (3, 3) matrix preserve lengths and orientation, up to single precision?"""
    return bool(np.abs(matrix @ matrix.T - np.eye(3)).max() <= tolerance and np.linalg.det(matrix) > 0)


def fixed_point(matrix: Floats) -> Floats:
    """The point nearest to the origin, (3,), that an affine map, (4, 4), keeps; the origin if it keeps none.

    Rounded to ten digits, so that all rotations about one axis give the same point.
    """
    moves = np.eye(3) - matrix[:3, :3]
    if not moves.any():
        return np.zeros(3)
    point: Floats = np.linalg.pinv(moves, rcond=1e-9) @ matrix[:3, 3]
    residual = np.abs(moves @ point - matrix[:3, 3]).max()
    largest = float(np.abs(point).max())
    if largest == 0 or residual > 1e-9 * np.abs(matrix[:3, 3]).max():
        return np.zeros(3)
    return np.round(point, 10 - int(np.ceil(np.log10(largest)))) + 0.0  # no -0


def affine_about(centre: Floats, linear: Floats, target: Floats) -> Floats:
    """The affine map, (4, 4), with a given linear part, that maps `centre` to `target`."""
    matrix = np.eye(4)
    matrix[:3, :3] = linear
    matrix[:3, 3] = target - linear @ centre
    return matrix


def remove_rounding(vector: Floats, unit: float = 0.0) -> Floats:
    """Set components of a vector, (3,), to 0 that vanish in single precision beside its length, or beside `unit`.

    Solves leave such components without a motion. Blender's fields would show them, as -0.
    """
    cleaned: Floats = np.where(np.abs(vector) > SINGLE * max(float(np.linalg.norm(vector)), unit), vector, 0.0)
    return cleaned


def _quaternion(r: Floats) -> Floats:
    """(w, x, y, z) with w >= 0 (Shepperd 1978: the largest component first)."""
    squares = np.array([1 + np.trace(r), *(1 + 2 * r.diagonal() - np.trace(r))])
    k = int(np.argmax(squares))
    skew = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    if k == 0:
        quaternion = np.array([squares[0], *skew])
    else:
        row = (r + r.T)[k - 1]
        quaternion = np.array([skew[k - 1], *row])
        quaternion[k] = squares[k]
    quaternion /= np.linalg.norm(quaternion)
    return quaternion if quaternion[0] >= 0 else -quaternion
