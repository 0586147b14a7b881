# SPDX-License-Identifier: GPL-3.0-or-later
"""Times of impact of single pairs, against rational arithmetic."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stiv
from tests.examples import examples
from tests.oracles.first_contact import WIDTH, first_contact, squared_distance

GRID = st.integers(-3, 3)
EARLY = 5e-3  # grids are full of contacts that touch without crossing; the advance is slow for these
KIND = st.sampled_from(["vf", "ee"])


def points(coordinate: st.SearchStrategy[int], planar: bool = False) -> st.SearchStrategy[list[list[int]]]:
    last = st.just(0) if planar else coordinate
    return st.lists(st.tuples(coordinate, coordinate, last).map(list), min_size=8, max_size=8)


def impact(kind: str, eight: list[list[int]], scale: float = 1.0, offset: float = 0.0) -> float:
    x = np.array(eight, float) * scale + offset
    return float(stiv.time_of_impact(kind, x[None, :4], x[None, 4:], threads=1)[0])


def truth(kind: str, eight: list[list[int]]) -> Fraction | None:
    exact = [tuple(Fraction(c) for c in point) for point in eight]
    return first_contact(kind, exact[:4], exact[4:])


def check(kind: str, eight: list[list[int]], found: float) -> None:
    """Points of a grid either touch or stay apart by far more than rounding, so the result must be exact."""
    expected = truth(kind, eight)
    assert np.isfinite(found) == (expected is not None)
    if expected is not None:
        assert Fraction(found) <= expected + WIDTH
        assert float(expected) - found < EARLY


@settings(max_examples=examples(120), deadline=None, derandomize=True)
@given(KIND, points(GRID))
def test_grids(kind: str, eight: list[list[int]]) -> None:
    check(kind, eight, impact(kind, eight))


@settings(max_examples=examples(120), deadline=None, derandomize=True)
@given(KIND, points(GRID, planar=True))
def test_coplanar_grids(kind: str, eight: list[list[int]]) -> None:
    check(kind, eight, impact(kind, eight))


@settings(max_examples=examples(120), deadline=None, derandomize=True)
@given(KIND, points(GRID), st.sampled_from([2.0**-23, 2.0**23]))
def test_scales(kind: str, eight: list[list[int]], scale: float) -> None:
    check(kind, eight, impact(kind, eight, scale))


@settings(max_examples=examples(120), deadline=None, derandomize=True)
@given(KIND, points(GRID), points(GRID))
def test_common_motion_does_not_matter(kind: str, eight: list[list[int]], shift: list[list[int]]) -> None:
    moved = eight[:4] + [[c + s for c, s in zip(point, shift[0], strict=True)] for point in eight[4:]]
    assert impact(kind, moved) == pytest.approx(impact(kind, eight), abs=1e-12)
    still = eight[:4] + [[c + s for c, s in zip(point, shift[0], strict=True)] for point in eight[:4]]
    expected = 0.0 if truth(kind, eight[:4] + eight[:4]) == 0 else np.inf
    assert impact(kind, still) == expected


@settings(max_examples=examples(80), deadline=None, derandomize=True)
@given(points(GRID), st.permutations([1, 2, 3]))
def test_corners_may_be_permuted(eight: list[list[int]], order: list[int]) -> None:
    corners = [0, *order]
    permuted = [eight[k] for k in corners] + [eight[4 + k] for k in corners]
    assert impact("vf", permuted) == pytest.approx(impact("vf", eight), abs=EARLY)
    for corners in ([1, 0, 2, 3], [0, 1, 3, 2], [2, 3, 0, 1]):
        permuted = [eight[k] for k in corners] + [eight[4 + k] for k in corners]
        assert impact("ee", permuted) == pytest.approx(impact("ee", eight), abs=EARLY)


@settings(max_examples=examples(80), deadline=None, derandomize=True)
@given(KIND, points(GRID), st.sampled_from([0.0625, 0.5, 1.0]))
def test_separation_holds_until_the_time_of_impact(kind: str, eight: list[list[int]], separation: float) -> None:
    x = np.array(eight, float)
    found = float(stiv.time_of_impact(kind, x[None, :4], x[None, 4:], separation, threads=1)[0])
    distances = [(t, distance(kind, eight, t)) for t in np.linspace(0, 1, 65)]
    assert all(d >= separation * (1 - 1e-12) for t, d in distances if t < found)
    if np.isfinite(found):
        assert distance(kind, eight, found) <= separation * 1.1


def distance(kind: str, eight: list[list[int]], time: float) -> float:
    t = Fraction(time)
    at_time = [tuple((1 - t) * a + t * b for a, b in zip(eight[k], eight[k + 4], strict=True)) for k in range(4)]
    return float(squared_distance(kind, at_time)) ** 0.5


def test_grazing_within_and_beyond_the_rounding_bound() -> None:
    start = np.array([[[-1, 0, 1], [0, -1, 0], [0, 1, 0], [0, 0, -1]]] * 2, float)
    end = start.copy()
    end[:, 0, 0] = 1
    start[:, 0, 2] = end[:, 0, 2] = [1e-12, 0]
    times = stiv.time_of_impact("vf", start, end)
    assert np.isinf(times[0])
    assert times[1] <= 0.5 and times[1] > 0.5 - 1e-12


def test_shapes_and_results() -> None:
    assert stiv.time_of_impact("ee", np.zeros((0, 4, 3)), np.zeros((0, 4, 3))).shape == (0,)
    times = stiv.time_of_impact("vf", np.zeros((5, 4, 3)), np.ones((5, 4, 3)))
    assert times.shape == (5,) and times.dtype == np.float64 and not times.any()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("vertex", np.zeros((1, 4, 3)), np.zeros((1, 4, 3))), "kind: 'vertex' is none of 'vf', 'ee'"),
        (("vf", np.zeros((1, 4, 2)), np.zeros((1, 4, 3))), "start: shape is"),
        (("vf", np.zeros((2, 4, 3)), np.zeros((1, 4, 3))), "end: shape is"),
        (("vf", np.array([[[0.0] * 3] * 4, [[np.nan] * 3] * 4]), np.zeros((2, 4, 3))), "start, row 1: "),
        (("vf", np.zeros((1, 4, 3), complex), np.zeros((1, 4, 3))), "start: dtype is complex128"),
        (("vf", np.zeros((1, 4, 3)), np.zeros((1, 4, 3)), -1.0), "separation must be finite and at least 0"),
        (("vf", np.zeros((1, 4, 3)), np.zeros((1, 4, 3)), "far"), "separation: expected a number"),
    ],
)
def test_bad_input_is_named(arguments: tuple[object, ...], message: str) -> None:
    with pytest.raises(stiv.InputError, match=message.replace("(", r"\(")):
        stiv.time_of_impact(*arguments)  # type: ignore[arg-type]
