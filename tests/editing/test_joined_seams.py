# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams in the core: surfaces with joined coincident vertices, on which every face keeps its index."""

import numpy as np
import pytest
from oracles import rational

import stiv
from stiv import edge_contacts as contacts
from stiv.edge_contacts import MOST_RESULTS, edge_contacts
from stiv.seams import Seams, common_seams, find_seams, seam_pairs


def grid(count):
    axis = np.linspace(-1, 1, count + 1)
    q = np.array([(x, y, 0.1 * np.sin(5 * x * y + y)) for y in axis for x in axis])
    i = np.arange(len(q)).reshape(count + 1, count + 1)
    a, b, c, d = i[:-1, :-1].ravel(), i[:-1, 1:].ravel(), i[1:, 1:].ravel(), i[1:, :-1].ravel()
    return q, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]).astype(np.int32)


def unwelded(count):
    q, triangles = grid(count)
    return q[triangles].reshape(-1, 3), np.arange(3 * len(triangles), dtype=np.int32).reshape(-1, 3)


def test_joined_seams_are_clear_and_an_edit_keeps_them_closed():
    q, triangles = unwelded(6)
    wall = np.array([(-9, -9, 0.5), (9, -9, 0.5), (0, 9, 0.5)])
    positions = np.concatenate([q, wall])
    bodies = [stiv.Body("sheet"), stiv.Body("wall", "fixed")]
    surface = stiv.Surface(np.concatenate([triangles, [len(q) + np.arange(3)]]), len(positions), None,
                           np.repeat([0, 1], [len(q), 3]), bodies)  # fmt: skip
    assert len(stiv.find_intersections(positions, surface)) > 100
    joined = stiv.join_seams(surface, positions)
    assert len(joined.surface.triangles) == len(surface.triangles)
    np.testing.assert_array_equal(joined.positions[joined.vertex_map], positions)
    assert len(stiv.find_intersections(joined.positions, joined.surface)) == 0
    sheet = np.arange(49, dtype=np.int32)
    deformation = stiv.concatenate([(stiv.identity(49), sheet)], joined.positions)
    goal = joined.positions[sheet] + (0, 0, 1)
    result = stiv.EditSession(joined.surface, deformation, joined.positions[sheet]).edit(goal)
    assert result.status == "corrected"
    assert result.surface[:49, 2].max() < 0.5
    assert rational.find_intersections(result.surface, joined.surface.triangles) == set()


def test_bodies_are_not_joined_to_each_other_and_duplicate_faces_remain():
    q = np.tile([(0, 0, 0), (1, 0, 0), (0, 1, 0)], (2, 1)).astype(float)
    triangles = np.arange(6).reshape(2, 3)
    same = stiv.join_seams(triangles, q)
    assert same.surface.triangles.tolist() == [[0, 1, 2], [0, 1, 2]]
    assert stiv.find_intersections(same.positions, same.surface).tolist() == [[0, 1]]
    apart = stiv.Surface(triangles, 6, None, np.repeat([0, 1], 3), [stiv.Body("one"), stiv.Body("other")])
    assert stiv.join_seams(apart, q).surface is apart


@pytest.mark.parametrize("scale", [1e-7, 1.0, 1e7])
def test_copies_that_differ_by_rounding_are_found_only_on_open_edges(scale):
    q, triangles = unwelded(8)
    random = np.random.default_rng(1)
    rounded = ((q + random.uniform(-1, 1, q.shape) * 2.0**-22) * scale).astype(np.float32)
    assert len(np.unique(rounded, axis=0)) > 300
    assert find_seams(rounded, triangles) is None or len(find_seams(rounded, triangles).first) > 300
    seams = find_seams(rounded, triangles, 2.0**-19)
    np.testing.assert_array_equal(seams.index[triangles], find_seams(q, triangles).index[triangles])
    assert np.abs(rounded - rounded[seams.leaders]).max() <= 2.0**-18 * np.abs(rounded).max()
    tiny = np.concatenate([2.0**-21 * np.eye(4, 3), [(1, 0, 0), (0, 1, 0), (1, 1, 0)]]) * scale
    closed = np.array([(4, 5, 6), (0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)], np.int32)
    assert find_seams(tiny, closed, 2.0**-19) is None
    assert find_seams(tiny, closed[:4], 2.0**-19).leaders.tolist() == [0, 1, 0, 0, 4, 5, 6]  # 1 is in a closed fan


def test_vertices_of_an_open_mesh_far_from_its_origin_are_not_joined():
    q, triangles = grid(100)
    assert find_seams((50 * q + 1e6).astype(np.float32), triangles, 2.0**-19) is None


def test_pairs_along_seams_share_a_position_but_no_vertex_there():
    q, triangles = unwelded(3)
    seams = find_seams(q, triangles)
    faces = np.arange(len(triangles), dtype=np.int32)
    expected = {
        (a, b) for a in faces.tolist() for b in faces.tolist()
        if a < b and set(seams.index[triangles[a]].tolist()) & set(seams.index[triangles[b]].tolist())
    }  # fmt: skip
    assert set(map(tuple, seam_pairs(seams, triangles, faces).tolist())) == expected
    assert len(seam_pairs(None, triangles, faces)) == 0


def test_seams_of_two_poses():
    one = Seams.of(np.array([0, 1, 1, 0, 4, 4], np.int32))
    other = Seams.of(np.array([0, 1, 1, 3, 1, 1], np.int32))
    assert common_seams(one, other).leaders.tolist() == [0, 1, 1, 3, 4, 4]
    assert common_seams(one, None) is None


FLAT = [(0, 0, 0), (4, 0, 0), (0, 4, 0)]


@pytest.mark.parametrize(
    ("other", "expected"),
    [
        ([(1, 0, 0), (3, 0, 0), (2, -1, 0)], True),  # along a part of an edge
        ([(1, 0, 0), (3, 0, 0), (2, 0, 1)], True),  # the same, perpendicular
        ([(-1, 0, 0), (3, 0, 0), (2, -1, 0)], True),  # edges that overlap in part
        ([(2, 2, 0), (5, 2, 1), (5, 3, 0)], True),  # a corner on an edge
        ([(1, 0, 0), (2, 0, 0), (3, 0, 0)], True),  # without area, on an edge
        ([(1, 0, 0), (3, 0, 0), (2, 1, 0)], False),  # overlap
        ([(1, 1, 0), (5, 1, 1), (5, 3, 1)], False),  # a corner inside
        ([(1, -1, -1), (1, 1, 1), (1, -3, 1)], False),  # edges cross at an inner point of both
        ([(1, -1, 0), (1, 1, 0), (1, 2, 0)], False),  # without area, across an edge
        ([(1, 0, 0), (1, 1, 0), (1, 2, 0)], False),  # without area, from an edge inward
        ([(0, 0, 0), (4, 0, 0), (0, 4, 0)], False),  # duplicate
        ([(0.5, 0.5, -1), (0.5, 0.5, 1), (9, 9, 0)], False),  # crossing
    ],
)
@pytest.mark.parametrize("scale", [2.0**-24, 1.0, 2.0**24])
def test_contacts_along_edges_differ_from_intersections(other, expected, scale):
    q = np.array([*FLAT, *other], float) * scale
    triangles = np.arange(6).reshape(2, 3)
    assert stiv.find_intersections(q, triangles).tolist() == [[0, 1]]
    for turned in ([0, 1, 2, 3, 4, 5], [1, 2, 0, 5, 4, 3], [3, 4, 5, 2, 1, 0]):
        assert edge_contacts(q[turned], triangles, np.array([[0, 1]])).tolist() == [expected]


def test_contacts_of_copies_are_those_of_each_place() -> None:
    """Results are stored by shape, for a limited number of shapes; nobody can change them."""
    random = np.random.default_rng(3)
    pairs = np.array([[0, 1]])
    for _ in range(3):
        for number in range(MOST_RESULTS + 5):
            other = [(1, 0, 0), (3, 0, 0), (2, 1 if number % 3 == 0 else -1, number)]
            q = np.array([*FLAT, *other], float)
            found = edge_contacts(q, np.arange(6).reshape(2, 3), pairs)
            assert found.tolist() == [number > 0 or other[2][1] < 0]
            found[:] = random.integers(2)


@pytest.mark.parametrize(("largest", "noise"), [(2, 0.0), (4, 0.0), (4, 1e-9), (9, 1e-3)])
def test_filters_of_contacts_along_edges_agree_with_exact_arithmetic(
    largest: int, noise: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    random = np.random.default_rng(largest)
    q = random.integers(0, largest + 1, (150, 3)) + noise * random.normal(size=(150, 3))
    triangles = random.integers(0, len(q), (300, 3)).astype(np.int32)
    triangles = triangles[(np.sort(triangles, axis=1)[:, 1:] != np.sort(triangles, axis=1)[:, :-1]).all(axis=1)]
    pairs = stiv.find_intersections(q, triangles)[:4000]
    corners = q[triangles[pairs]]
    filtered = contacts._find(corners)
    for name in ("_overlap_clearly", "_edge_passes_through"):
        monkeypatch.setattr(contacts, name, lambda corners: np.zeros(len(corners), bool))
    assert filtered.tolist() == contacts._find(corners).tolist()
    assert len(pairs) > 1000 and not filtered.all()


def test_seams_are_divided_where_values_differ() -> None:
    """Copies that remain together form seams of their own; values that are not numbers equal nothing."""
    seams = Seams.of(np.array([0, 0, 0, 0, 4, 4, 6], np.int32))
    values = np.array([[0.0, 0], [1, 0], [0.05, 0], [1.05, 0], [2, 2], [2, np.nan], [0, 0]])
    assert seams.limited_to_equal(values, 0.1).leaders.tolist() == [0, 1, 0, 1, 4, 5, 6]
    assert seams.limited_to_equal(values, 0.01) is None
    assert seams.limited_to_equal(np.zeros((7, 3, 2)), 0.0).leaders.tolist() == seams.leaders.tolist()
