# SPDX-License-Identifier: GPL-3.0-or-later
"""Twenty thousand random and adversarial queries against rational arithmetic, and under transformations."""

from fractions import Fraction

import numpy as np
import pytest

import stiv
from tests.detection.awkward_queries import SORTS, Points, make
from tests.oracles.first_contact import WIDTH, first_contact

COUNT = 1000
KINDS = ["vf", "ee"]
UNDECIDED = 0.02
"""Near misses by 2^-50 that may be reported, because the budget of a pair ends before they differ from contacts."""
CORNERS = {"vf": ([0, 2, 3, 1], [0, 2, 1, 3]), "ee": ([1, 0, 2, 3], [0, 1, 3, 2], [2, 3, 0, 1])}


def impacts(kind: str, points: Points) -> Points:
    return stiv.time_of_impact(kind, points[:, :4], points[:, 4:], threads=1)


def seed(sort: str) -> int:
    return list(SORTS).index(sort)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("sort", SORTS)
def test_no_contact_is_missed_none_is_late_and_none_is_made_up(sort: str, kind: str) -> None:
    points = make(sort, COUNT, seed(sort))
    early, made_up = [], []
    for query, time in zip(points.tolist(), impacts(kind, points), strict=True):
        truth = first_contact(kind, query[:4], query[4:])
        if truth is not None:
            assert np.isfinite(time), f"missed: {query}"
            assert Fraction(time) <= truth + WIDTH, f"late: {query}"
            early.append(float(truth) - time)
        elif np.isfinite(time):
            made_up.append(query)
    assert len(early) > COUNT // 100
    assert np.median(early) < 1e-9
    if sort != "grazing":
        assert not made_up
        assert np.max(early) < 1e-5
    assert len(made_up) <= UNDECIDED * COUNT
    assert np.mean(np.array(early) < 1e-5) >= 1 - UNDECIDED


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("sort", SORTS)
def test_order_of_vertices_and_axes_and_direction_of_time_change_no_result(sort: str, kind: str) -> None:
    points = make(sort, 4 * COUNT, seed(sort) + 100)
    hits = np.isfinite(impacts(kind, points))
    assert COUNT // 50 < np.sum(hits) < 4 * COUNT
    ends = [4, 5, 6, 7, 0, 1, 2, 3]
    others = [points[:, [*order, *(4 + k for k in order)]] for order in CORNERS[kind]]
    others += [points[:, :, [1, 2, 0]], points[:, :, [1, 0, 2]], points[:, ends], -points]
    for other in others:
        assert np.mean(np.isfinite(impacts(kind, other)) != hits) <= (UNDECIDED if sort == "grazing" else 0)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("sort", SORTS)
def test_scale_changes_no_result(sort: str, kind: str) -> None:
    points = make(sort, 4 * COUNT, seed(sort) + 200)
    times = impacts(kind, points)
    for exponent in (-24, 24):
        assert np.array_equal(impacts(kind, np.ldexp(points, exponent)), times)
    # Other factors round coordinates, which separates or joins pairs that barely touch, except for whole
    # numbers.
    if sort in ("general", "sliver"):
        for scale in (1e-7, 1e7):
            assert np.array_equal(np.isfinite(impacts(kind, points * scale)), np.isfinite(times))
    elif sort != "grazing":
        assert np.array_equal(np.isfinite(impacts(kind, points * 1e7)), np.isfinite(times))
