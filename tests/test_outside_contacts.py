# SPDX-License-Identifier: GPL-3.0-or-later
"""Contacts of bodies beside each other, in each other, and across each other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from touching_bodies import CUBE, flat, scene

import stiv
from blend_fixtures.scenes.shape import joined
from stiv.outside_contacts import touching_from_outside


def touch_from_outside(first: Any, second: Any) -> bool:
    """Whether two bodies that meet are beside each other in their contact."""
    surface, q, is_first = scene(first, second)
    pairs = stiv.find_intersections(q, surface)
    assert len(pairs) > 0
    sides = is_first[surface.triangles[pairs][:, :, 0]]
    corners = q[surface.triangles[np.where(sides[:, :1], pairs, pairs[:, ::-1])]]
    (found,) = touching_from_outside(corners[:, 0], corners[:, 1], np.zeros(len(pairs), np.int32))
    return bool(found)


ROOM = joined([flat(20, 0, 0, -1), CUBE.moved((2, 0, 0)), CUBE.moved((0, 2, 0))])
SLOT = joined([flat(20, 0, 0, -1), CUBE.moved((2, 0, 0)), CUBE.moved((-2, 0, 0))])


@pytest.mark.parametrize(
    ("second", "touches"),
    [
        (flat(20, 0, 0, -1), True),
        (CUBE.moved((2, 0.3, 0.4)), True),
        (CUBE.moved((2, 2, 0)), True),
        (CUBE.moved((2, 2, 2)), True),
        (ROOM, True),
        (SLOT, True),
        (flat(20, 0, 0, 0), False),
        (CUBE, False),
        (CUBE.scaled(0.5).moved((0, 0, 0.5)), False),
        (CUBE.moved((0, 0, 1)), False),
    ],
)
def test_contacts_from_outside_are_those_of_bodies_beside_each_other(second: Any, touches: bool) -> None:
    assert touch_from_outside(CUBE, second) is touch_from_outside(second, CUBE) is touches


def test_a_body_that_a_sheet_cuts_along_its_edges_does_not_touch_from_outside() -> None:
    assert not touch_from_outside(joined([CUBE, CUBE.moved((0, 0, 2))]), flat(20, 0, 0, 1))


@given(st.integers(0, 2**32 - 1))
def test_contacts_of_boxes_on_a_lattice_are_those_without_a_common_inside(seed: int) -> None:
    chance = np.random.default_rng(seed)
    low = chance.integers(-2, 3, (2, 3))
    high = low + chance.integers(1, 4, (2, 3))
    first, second = (CUBE.scaled((b - a) / 2).moved((a + b) / 2) for a, b in zip(low, high, strict=True))
    overlap = (high.min(axis=0) - low.max(axis=0)).min()
    if overlap >= 0 and len(stiv.find_intersections(*scene(first, second)[1::-1])) > 0:
        assert touch_from_outside(first, second) is bool(overlap == 0)
