# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes over many points, compared with one point or quad at a time."""

import math
from fractions import Fraction

import numpy as np
import pytest

import stiv
from stiv.points import apply_linear, find_folded, largest_difference, transform_points

RANDOM = np.random.default_rng(3)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("count", [0, 1, 2, 57])
def test_points_map_in_any_layout(dtype: type, count: int) -> None:
    """Rational arithmetic bounds the error; the rounding of each step leads to the same bits in all layouts."""
    matrix, points = np.eye(4), RANDOM.normal(size=(count, 3)).astype(dtype)
    matrix[:3] = RANDOM.normal(size=(3, 4))
    mapped = transform_points(matrix, points)
    assert mapped.shape == (count, 3) and mapped.dtype == np.float64
    for row, point in zip(mapped.tolist(), points.tolist(), strict=True):
        for value, coefficients in zip(row, matrix.tolist(), strict=False):
            terms = [Fraction(a) * Fraction(x) for a, x in zip(coefficients, [*point, 1], strict=True)]
            assert abs(Fraction(value) - sum(terms)) <= Fraction(2.0**-50) * sum(map(abs, terms))
    for layout in (np.asfortranarray(points), np.repeat(points, 2, axis=0)[::2], points.astype(np.float64)):
        assert np.array_equal(transform_points(matrix, layout), mapped)
    matrix[:3, 3] = 0
    assert np.array_equal(apply_linear(matrix[:3, :3], points), transform_points(matrix, points))


def test_the_largest_difference() -> None:
    first = RANDOM.normal(size=(33, 3))
    second = first.copy()
    assert largest_difference(first, second) == 0
    second[32, 1] += 3
    assert largest_difference(first, second) == abs(first[32, 1] - second[32, 1])
    second[0, 0] = math.nan
    assert math.isnan(largest_difference(first, second))
    with pytest.raises(stiv.InputError, match="differ"):
        largest_difference(first, first[1:])


def test_folded_quads() -> None:
    """Each quad of many as its own normals decide, away from the limit."""
    points = RANDOM.normal(size=(400, 3)).astype(np.float32)
    corners = RANDOM.permuted(np.arange(400, dtype=np.int32)).reshape(4, 100)
    a, b, c, d = points.astype(np.float64)[corners]
    one, two = np.cross(b - a, c - a), np.cross(c - a, d - a)
    cosines = np.einsum("ij,ij->i", one, two) / np.linalg.norm(one, axis=1) / np.linalg.norm(two, axis=1)
    for cosine in (-0.5, 0.001, 0.7):
        assert (np.abs(cosines - cosine) > 1e-4).all()
        assert np.array_equal(find_folded(points, corners, cosine, 0.0), np.flatnonzero(cosines < cosine))
    with pytest.raises(stiv.InputError, match="corners"):
        find_folded(points, corners[:3], 0.5, 0.0)
    with pytest.raises(stiv.InputError, match="corners"):
        find_folded(points[:100], corners, 0.5, 0.0)
