# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from stiv_addon.transform.frame import orthonormal, pivot_of

POINTS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [5.0, 3.0, 1.0]])
CURSOR = np.array([9.0, 9.0, 9.0])
ACTIVE = np.array([1.0, 0.0, 0.0])


@pytest.mark.parametrize(
    ("choice", "expected"),
    [
        ("MEDIAN_POINT", (2.0, 1.0, 1.0 / 3.0)),
        ("INDIVIDUAL_ORIGINS", (2.0, 1.0, 1.0 / 3.0)),
        ("BOUNDING_BOX_CENTER", (2.5, 1.5, 0.5)),
        ("CURSOR", (9.0, 9.0, 9.0)),
        ("ACTIVE_ELEMENT", (1.0, 0.0, 0.0)),
    ],
)
def test_the_choice_of_the_scene_is_the_pivot(choice: str, expected: tuple) -> None:
    np.testing.assert_allclose(pivot_of(POINTS, choice, cursor=CURSOR, active=ACTIVE), expected)


def test_without_an_active_element_the_pivot_is_the_median() -> None:
    pivot = pivot_of(POINTS, "ACTIVE_ELEMENT", cursor=CURSOR, active=None)
    np.testing.assert_allclose(pivot, POINTS.mean(axis=0))


def test_nothing_selected_turns_about_the_cursor() -> None:
    pivot = pivot_of(np.empty((0, 3)), "MEDIAN_POINT", cursor=CURSOR, active=None)
    np.testing.assert_array_equal(pivot, CURSOR)


def test_axes_of_a_matrix_in_single_precision_are_orthonormal_in_double() -> None:
    turn, rest = np.radians(30.0), np.eye(3)
    rest[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    axes = orthonormal(rest.astype(np.float32)).astype(float)
    assert np.abs(axes.T @ axes - np.eye(3)).max() < 1e-15
    assert axes == pytest.approx(rest, abs=1e-7)
