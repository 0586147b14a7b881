# SPDX-License-Identifier: GPL-3.0-or-later
"""The least translation that parts bodies which only touch: its direction, its size, and when there is none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from touching_bodies import CUBE, flat, scene

import stiv
from blend_fixtures.scenes.primitives import box, icosphere, triangulated
from blend_fixtures.scenes.shape import joined, rotation_matrix
from stiv.touching import are_touching, find_parting, rounding_of

GAP = 2e-6
SEEDS = st.integers(0, 2**32 - 1)


def parting(moving: Any, *others: Any, **options: Any) -> np.ndarray | None:
    """The translation found, after which nothing intersects."""
    surface, q, moves = scene(moving, *others)
    assert len(stiv.find_intersections(q, surface)) > 0
    found = find_parting(surface, q, moves, GAP, **options)
    if found is not None:
        assert len(stiv.find_intersections(q + np.where(moves[:, None], found, 0.0), surface)) == 0
    return found


FLOOR = flat(20, 0, 0, 0)


@pytest.mark.parametrize(
    ("others", "way"),
    [
        ([FLOOR], (0, 0, 1)),
        ([FLOOR, CUBE.moved((2, 0, 1))], (-1, 0, 1)),
        ([FLOOR, CUBE.moved((2, 0.3, 1.2))], (-1, 0, 1)),
        ([FLOOR, CUBE.moved((2, 0, 1)), CUBE.moved((0, -2, 1))], (-1, 1, 1)),
        ([CUBE.moved((0, 0, -1))], (0, 0, 1)),
        ([CUBE.moved((0.5, 0.7, -1))], (0, 0, 1)),
        ([CUBE.moved((0, 0, 3))], (0, 0, -1)),
        ([CUBE.scaled(0.25).moved((0.1, 0.2, 2.25))], (0, 0, -1)),
        ([flat(1, 0, 0, 0)], (0, 0, 1)),
        ([triangulated(box(2, (9, 9, 9))).moved((0, 0, 4.5))], (0, 0, 1)),
    ],
    ids=["floor", "crate", "shifted crate", "corner", "same below", "below", "above", "small above", "rug", "room"],
)
def test_a_cube_leaves_by_the_faces_that_it_touches(others: list[Any], way: tuple[float, ...]) -> None:
    found = parting(CUBE.moved((0, 0, 1)), *others)
    assert found == pytest.approx(GAP * np.array(way), abs=0.01 * GAP)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_rug_stays_outside_a_cube(side: float) -> None:
    rug = flat(1, 0, 0, side) if side > 0 else flat(1, 0, 0, 0).scaled((1, -1, -1)).moved((0, 0, side))
    assert parting(rug, CUBE) == pytest.approx((0, 0, side * GAP), abs=0.01 * GAP)


def test_a_rug_stays_inside_a_room() -> None:
    assert parting(flat(1, 0, 0, -1), CUBE) == pytest.approx((0, 0, GAP), abs=0.01 * GAP)


@pytest.mark.parametrize(
    "others",
    [
        [CUBE.moved((2, 0, 1)), CUBE.moved((-2, 0, 1))],
        [FLOOR, FLOOR.moved((0, 0, 2))],
        [CUBE.moved((0, 0, 1))],
        [FLOOR.moved((0, 0, 1e-4))],
        [FLOOR.moved((0, 0, 0.5))],
        [FLOOR, CUBE.moved((1.5, 0.2, 1.1))],
        [icosphere(3).moved((0, 0, 1.5))],
    ],
    ids=["between walls", "between floors", "duplicate", "cut", "cut through", "cut beside contact", "ball"],
)
def test_nothing_parts_what_cuts_or_is_held(others: list[Any]) -> None:
    assert parting(CUBE.moved((0, 0, 1)), *others) is None


def test_a_body_cut_along_its_own_edges_is_not_touched_only() -> None:
    """Every pair touches in the edges of one plane, but the body lies on both sides of it."""
    assert parting(joined([CUBE, CUBE.moved((0, 0, 2))]), flat(20, 0, 0, 1)) is None


def test_a_ball_on_the_vertex_of_a_fine_mesh() -> None:
    ball = icosphere(4)
    ball = ball.moved((0, 0, -float(ball.vertices[:, 2].min())))
    found = parting(ball, FLOOR)
    assert found == pytest.approx((0, 0, GAP), abs=0.01 * GAP)


def test_locked_directions_are_respected() -> None:
    crate = CUBE.moved((2, 0, 1))
    assert parting(CUBE.moved((0, 0, 1)), FLOOR, free=np.diag((0.0, 0.0, 1.0)))[2] == pytest.approx(GAP)
    assert parting(CUBE.moved((0, 0, 1)), FLOOR, free=np.diag((1.0, 1.0, 0.0))) is None
    assert parting(CUBE.moved((0, 0, 1)), crate, free=np.diag((1.0, 1.0, 0.0)))[0] == pytest.approx(-GAP)


@given(SEEDS)
def test_turned_crates_part_across_their_common_plane(seed: int) -> None:
    """Their corners round to single precision, and so cut each other a little."""
    chance = np.random.default_rng(seed)
    angles, (x, y), place = chance.uniform(-3, 3, 3), chance.uniform(-1.5, 1.5, 2), chance.uniform(-3, 3, 3)
    rest, above = (each.turned(angles).moved(place) for each in (CUBE, CUBE.moved((x, y, 2))))
    surface, q, _ = scene(above, rest)
    if len(stiv.find_intersections(q, surface)) == 0:
        return
    found = parting(above, rest)
    assert found is not None
    assert found @ rotation_matrix(angles)[:, 2] == pytest.approx(np.linalg.norm(found), rel=1e-2)
    assert GAP * 0.99 <= np.linalg.norm(found) <= GAP + 40 * rounding_of(q)


@given(SEEDS)
def test_touching_is_symmetric_and_ends_at_the_tolerance(seed: int) -> None:
    chance = np.random.default_rng(seed)
    base = np.array([[-4.0, -4, 0], [4, -4, 0], [0, 4, 0]])
    corner = np.array([0.0, 0, 0]) + [*chance.uniform(-0.3, 0.3, 2), 0]
    above = np.array([corner, corner + [0.3, 0.1, chance.uniform(1, 2)], corner + [-0.2, 0.4, chance.uniform(1, 2)]])
    for depth, touches in ((1e-6, True), (1e-4, False)):
        first, second = (above - [0, 0, depth])[None], base[None]
        assert are_touching(first, second) is are_touching(second, first) is touches


def test_triangles_without_area_touch_as_segments_and_points() -> None:
    base = np.array([[[-1.0, -1, 0], [1, -1, 0], [0, 1, 0]]])
    segment, point = np.array([[[0.0, 0, 0], [0, 0, 1], [0, 0, 1]]]), np.zeros((1, 3, 3))
    assert are_touching(segment, base) and are_touching(base, segment) and are_touching(point, base)
    assert not are_touching(segment - [0, 0, 0.5], base)
