# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotation vectors against mathutils."""

import bpy  # noqa: F401
import numpy as np
import pytest
from mathutils import Euler, Matrix, Vector

from stiv.blender.controls.rotations import (
    affine_about,
    euler_angles,
    is_rotation,
    nearest_equivalent,
    nearest_rotation,
    remove_rounding,
    rotation_matrix,
    rotation_vector,
)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.3, 1.5, np.pi - 1e-9, np.pi, 3.0])
@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-0.6, 0.0, 0.8), (0.48, -0.6, 0.64)])
def test_rotation_matrix_and_vector_against_mathutils(angle: float, axis: tuple[float, ...]) -> None:
    matrix = rotation_matrix(angle * np.array(axis))
    assert np.abs(matrix - np.array(Matrix.Rotation(angle, 3, Vector(axis)))).max() < 1e-6
    back = rotation_vector(matrix)
    assert np.abs(rotation_matrix(back) - matrix).max() < 1e-12
    assert np.linalg.norm(back) == pytest.approx(angle, abs=1e-7)


def test_a_drag_may_exceed_one_turn() -> None:
    last, axis = np.zeros(3), np.array([0.6, 0.0, 0.8])
    for degrees in range(10, 1000, 10):
        last = nearest_equivalent(rotation_vector(rotation_matrix(np.radians(degrees) * axis)), last)
        assert last == pytest.approx(np.radians(degrees) * axis, abs=1e-9)


def test_coming_back_from_a_full_turn() -> None:
    assert nearest_equivalent(np.zeros(3), np.array([0, 0, 6.0])) == pytest.approx([0, 0, 2 * np.pi])
    assert nearest_equivalent(np.zeros(3), np.array([0, 0, 0.5])) == pytest.approx([0, 0, 0])


def test_polar_factor_leaves_out_stretch_and_mirror() -> None:
    rotation = rotation_matrix(np.array([0.3, -0.2, 0.9]))
    assert nearest_rotation(rotation @ np.diag([2.0, 3.0, 0.5])) == pytest.approx(rotation)
    assert is_rotation(nearest_rotation(np.diag([1.0, 2.0, -3.0])))


def test_an_affine_map_takes_the_centre_to_its_target() -> None:
    matrix = affine_about(np.array([1.0, 2, 3]), rotation_matrix(np.array([0, 0, 1.0])), np.array([4.0, 5, 6]))
    assert matrix @ [1, 2, 3, 1] == pytest.approx([4, 5, 6, 1])


def test_components_that_vanish_in_single_precision_are_removed() -> None:
    assert remove_rounding(np.array([3.0, -1e-9, 1e-5])).tolist() == [3.0, 0.0, 1e-5]
    assert remove_rounding(np.array([3e-20, 1e-20, 0.0])).tolist() == [3e-20, 1e-20, 0.0]
    assert remove_rounding(np.array([1e-9, 0.0, -2e-6]), unit=1.0).tolist() == [0.0, 0.0, -2e-6]


@pytest.mark.parametrize("order", ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"])
def test_euler_angles_are_exact_near_the_gimbal_lock(order: str) -> None:
    rng = np.random.default_rng(5)
    for off in (0.0, 1e-7, 1e-6, 1e-4, 0.3):
        angles = rng.uniform(-3, 3, 3)
        angles["XYZ".index(order[1])] = np.pi / 2 - off
        turns = {
            axis: rotation_matrix(angle * np.eye(3)[k])
            for k, (axis, angle) in enumerate(zip("XYZ", angles, strict=True))
        }
        matrix = turns[order[2]] @ turns[order[1]] @ turns[order[0]]
        found = euler_angles(matrix, order, angles + rng.uniform(-0.5, 0.5, 3))
        stored = np.array(Euler(found, order).to_matrix())  # Blender's own conversion back, in single precision
        assert np.allclose(stored, matrix, atol=3e-7)
