# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths of typed values."""

from itertools import pairwise

import bpy  # noqa: F401
import numpy as np
import pytest
from building import moved, shift, stretch, turn

from stiv.blender.edit.increments import StillIncrements, count_increments, interpolate_transform


def test_translation_is_a_line() -> None:
    assert interpolate_transform(shift(1, 2, 3), 0.25) == pytest.approx(shift(0.25, 0.5, 0.75))


def test_rotation_is_an_arc_about_its_pivot() -> None:
    pivot = (5.0, -2.0, 1.0)
    for fraction in (0.1, 0.5, 0.9):
        assert interpolate_transform(turn(1.2, "Y", pivot), fraction) == pytest.approx(turn(1.2 * fraction, "Y", pivot))


def test_screw_keeps_its_axis() -> None:
    half = interpolate_transform(shift(0, 0, 2) @ turn(1.0, "Z", (3, 4, 0)), 0.5)
    assert half == pytest.approx(shift(0, 0, 1) @ turn(0.5, "Z", (3, 4, 0)))


def test_scaling_keeps_its_pivot() -> None:
    assert interpolate_transform(stretch((3, 1, 2), (1, 2, 3)), 0.5) == pytest.approx(stretch((2, 1, 1.5), (1, 2, 3)))


def test_the_end_is_the_matrix_itself() -> None:
    matrix = turn(2.0, "X", (1, 1, 1))
    assert interpolate_transform(matrix, 1.0) is matrix


@pytest.mark.parametrize("angle", [2.5, 2 * np.pi])
def test_no_increment_exceeds_the_limit(angle: float) -> None:
    points = np.random.default_rng(1).normal(size=(20, 3))

    def arc(fraction: float) -> np.ndarray:
        return turn(angle * fraction, "X", (4, 0, 0))

    count = count_increments(arc, points, 0.1, 1000)
    path = [moved(arc(k / count), points) for k in range(count + 1)]
    assert max(np.linalg.norm(b - a, axis=1).max() for a, b in pairwise(path)) < 0.105
    assert count >= angle / 0.1


def test_increments_of_nothing_and_of_very_much() -> None:
    points = np.eye(3)
    assert count_increments(lambda fraction: shift(), points, 0.1, 1000) == 1
    assert count_increments(lambda fraction: shift(fraction * 1e9), points, 0.1, 50) == 50
    assert count_increments(lambda fraction: stretch(1 - fraction), points, 0.1, 1000) == 10
    assert count_increments(lambda fraction: shift(fraction), np.empty((0, 3)), 0.1, 1000) == 1


@pytest.mark.parametrize("scale", [1e-7, 1.0, 1e7])
def test_increments_in_a_row_that_hold_the_controls_end_the_others(scale: float) -> None:
    asked, held, moved_on = scale * np.eye(3), 1e-5 * scale * np.eye(3), 0.5 * scale * np.eye(3)
    still = StillIncrements()
    for moved_by in (held, held, held, moved_on, held, held, held):
        still.add(moved_by, asked)
        assert not still.are_many
    still.add(0 * held, asked)
    assert still.are_many
