# SPDX-License-Identifier: GPL-3.0-or-later
"""The step check against an independent check of all pairs, and against simple motions with known results."""

import numpy as np
import pytest
from acceptance import shapes
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles import path, rational

import stiv
from tests.examples import examples

TETRAHEDRON = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def tetrahedra(seed: int, count: int = 12) -> tuple[shapes.Floats, shapes.Integers]:
    """Small tetrahedra in the unit cube, some of which touch or intersect others."""
    random = np.random.default_rng(seed)
    vertices = random.random((count, 1, 3)) + 0.15 * random.random((count, 4, 3))
    return vertices.reshape(-1, 3), (TETRAHEDRON + 4 * np.arange(count)[:, None, None]).reshape(-1, 3)


def moved(vertices: shapes.Floats, stir: float, seed: int) -> shapes.Floats:
    """Each tetrahedron moves independently and changes its shape."""
    random = np.random.default_rng(seed)
    ways = random.standard_normal((len(vertices) // 4, 1, 3)) + 0.1 * random.standard_normal((len(vertices) // 4, 4, 3))
    return vertices + stir * ways.reshape(-1, 3)


@settings(max_examples=examples(40), deadline=None)
@given(st.integers(0, 2**32), st.sampled_from([0.02, 0.1, 0.5]), st.sampled_from([1e-7, 1.0, 1e7]))
def test_random_steps_equal_an_independent_check(seed: int, stir: float, scale: float) -> None:
    vertices, faces = tetrahedra(seed)
    start, end = scale * vertices, scale * moved(vertices, stir, seed + 1)
    contacts = path.find_contacts(faces, start, end)
    events = stiv.find_interference(faces, start, end)
    assert sorted(map(tuple, events.vertices.tolist())) == sorted(map(tuple, contacts.vertices.tolist()))
    ends_free = not rational.find_intersections(start, faces) and not rational.find_intersections(end, faces)
    assert stiv.is_step_free(faces, start, end) == (ends_free and len(contacts.time) == 0)


def test_a_ring_cannot_leave_its_link() -> None:
    linked, faces = shapes.linked_tori()
    apart, _ = shapes.linked_tori(6.0)
    assert len(stiv.find_intersections(apart, faces)) == 0
    assert not stiv.is_step_free(faces, linked, apart)
    assert not stiv.is_step_free(faces, apart, linked)
    assert len(path.find_contacts(faces, linked, apart).time) > 0
    nudged, _ = shapes.linked_tori(0.2)
    assert stiv.is_step_free(faces, linked, nudged)
    assert len(path.find_contacts(faces, linked, nudged).time) == 0


def test_a_step_with_an_intersecting_start_or_end_is_not_free() -> None:
    crossed, faces = shapes.linked_tori(1.2)
    assert not stiv.is_step_free(faces, crossed, crossed)
    assert not stiv.is_step_free(faces, crossed, shapes.linked_tori(0)[0])


def test_separation_is_respected() -> None:
    start, both = shapes.two_spheres(3.0)
    end, _ = shapes.two_spheres(2.1)
    assert stiv.is_step_free(both, start, end, separation=0.08)
    assert not stiv.is_step_free(both, start, end, separation=0.12)
    assert len(path.find_contacts(both, start, end, separation=0.099).time) == 0
    assert len(path.find_contacts(both, start, end, separation=0.101).time) > 0


def test_the_oracle_finds_the_time_at_which_a_vertex_meets_a_face() -> None:
    triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    start = np.array([*triangle, [0.2, 0.2, 1.0]])
    end = np.array([*triangle, [0.2, 0.2, -2.0]])
    contacts = path.find_contacts([[0, 1, 2]], start, end)
    assert contacts.kind == ["vf"] and contacts.vertices.tolist() == [[3, 0, 1, 2]]
    assert contacts.time == pytest.approx([1 / 3], abs=1e-6)


def test_bad_input_is_named() -> None:
    start, faces = shapes.linked_tori()
    with pytest.raises(stiv.InputError, match="end: shape"):
        stiv.is_step_free(faces, start, start[:-1])
    with pytest.raises(stiv.InputError, match="end, row 7"):
        stiv.is_step_free(faces, start, np.where(np.arange(len(start))[:, None] == 7, np.nan, start))
    with pytest.raises(stiv.InputError, match="separation"):
        stiv.is_step_free(faces, start, start, separation=-1.0)


def test_the_reusable_check_agrees_with_the_one_off_function() -> None:
    triangles = [[0, 1, 2], [3, 4, 5]]
    start = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, 1], [0.3, 0.2, 2], [0.2, 0.3, 2.0]])
    check = stiv.StepCheck(stiv.Surface(triangles))
    for height in (-0.5, -1.5, -4.0, 0.5, -0.99):
        end = start.copy()
        end[3:, 2] += height
        assert check.is_free(start, end) == stiv.is_step_free(triangles, start, end) == (height > -1)
