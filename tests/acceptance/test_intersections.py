# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact static test against rational arithmetic, for all ways in which two triangles can share corners."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from acceptance import shapes
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from oracles import rational

import stiv
from tests.examples import examples

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

SHARING: dict[str, tuple[list[int], list[int]]] = {
    "nothing": ([0, 1, 2], [3, 4, 5]),
    "vertex": ([0, 1, 2], [3, 0, 4]),
    "edge": ([0, 1, 2], [1, 3, 0]),
    "all": ([0, 1, 2], [2, 0, 1]),
    "nothing, repeated corner": ([0, 1, 2], [3, 4, 4]),
    "vertex, repeated corner": ([0, 1, 2], [0, 0, 3]),
    "vertex repeated in both": ([0, 1, 1], [2, 0, 2]),
    "edge, repeated corner": ([0, 1, 2], [1, 0, 1]),
    "edge of two segments": ([0, 1, 0], [1, 0, 1]),
    "vertex alone": ([0, 1, 2], [2, 2, 2]),
}


def coarse_grid(random: np.random.Generator, count: int) -> Floats:
    """Corners on a 3 x 3 x 3 grid: most contacts are degenerate, and coincident corners are frequent."""
    return random.integers(0, 3, (count, 6, 3)).astype(np.float64)


def one_plane(random: np.random.Generator, count: int) -> Floats:
    """Corners on a 4 x 4 grid within a slanted plane."""
    grid = random.integers(0, 4, (count, 6, 2))
    return (grid @ np.array([[1, 2, -1], [3, 0, 2]])).astype(np.float64)


def one_line(random: np.random.Generator, count: int) -> Floats:
    """Corners on a line, some of them one unit off."""
    on_line = random.integers(0, 5, (count, 6, 1)) * np.array([2, -1, 3])
    return (on_line + (random.random((count, 6, 1)) < 0.1) * random.integers(-1, 2, (count, 6, 3))).astype(np.float64)


def fine_grid(random: np.random.Generator, count: int) -> Floats:
    return random.integers(-10, 11, (count, 6, 3)).astype(np.float64)


def rounded_plane(random: np.random.Generator, count: int) -> Floats:
    """Rounded corners in a rotated plane: coplanar up to the last digits, so only exact signs decide."""
    grid = random.integers(0, 4, (count, 6, 2)) * 0.1
    return grid @ np.linalg.qr(random.standard_normal((3, 3)))[0][:2] + 1 / 3


CORNERS = [coarse_grid, one_plane, one_line, fine_grid, rounded_plane]


def side_by_side(corners: Floats, first: list[int], second: list[int]) -> tuple[Floats, Integers]:
    """Put all pairs into one mesh, with pair k as triangles 2k and 2k + 1; shifts by powers of two are exact."""
    count = len(corners)
    cells = np.stack(np.unravel_index(np.arange(count), (16, 16, count // 256 + 1)), axis=-1)
    shifted = corners + 64.0 * cells[:, None, :]
    faces = np.array([first, second]) + 6 * np.arange(count)[:, None, None]
    return shifted.reshape(-1, 3), faces.reshape(-1, 3)


@pytest.mark.parametrize("sharing", SHARING)
@pytest.mark.parametrize("make", CORNERS)
def test_pairs_equal_rational_arithmetic(make: Callable[[np.random.Generator, int], Floats], sharing: str) -> None:
    count = 400
    vertices, faces = side_by_side(make(np.random.default_rng(len(sharing)), count), *SHARING[sharing])
    expected = {
        (2 * k, 2 * k + 1)
        for k in range(count)
        if rational.triangles_intersect(faces[2 * k], faces[2 * k + 1], vertices)
    }
    found = stiv.find_intersections(vertices, faces)
    assert {(int(a), int(b)) for a, b in found} == expected


def soup(seed: int, triangles: int = 80, size: float = 0.2) -> tuple[Floats, Integers]:
    """Triangles that share corners at random."""
    random = np.random.default_rng(seed)
    vertices = random.random((2 * triangles, 3))
    near = np.argsort(((vertices[:, None] - vertices[None]) ** 2).sum(axis=2), axis=1)[:, :8]
    faces = [random.choice(near[k], 3, replace=False) for k in random.integers(0, len(vertices), triangles)]
    return vertices, np.array(faces)


@settings(max_examples=examples(25), deadline=None)
@given(st.integers(0, 2**32), st.integers(-23, 23))
def test_soups_equal_brute_force_for_any_scale_order_and_thread_count(seed: int, exponent: int) -> None:
    vertices, faces = soup(seed)
    expected = rational.find_intersections(vertices, faces)
    scaled = vertices * 2.0**exponent
    found = stiv.find_intersections(scaled, faces, threads=1)
    assert {(int(a), int(b)) for a, b in found} == expected
    assert found.dtype == np.int32 and np.array_equal(found, stiv.find_intersections(scaled, faces, threads=2))

    random = np.random.default_rng(seed)
    vertex_order, face_order = random.permutation(len(vertices)), random.permutation(len(faces))
    renamed = np.argsort(vertex_order)[random.permuted(faces[face_order], axis=1)]
    shuffled = stiv.find_intersections(scaled[vertex_order], renamed)
    assert {tuple(sorted(face_order[pair].tolist())) for pair in shuffled} == expected


@pytest.mark.parametrize("scale", [1e-7, 1.0, 1e7])
def test_spheres_apart_touching_and_overlapping(scale: float) -> None:
    def count(distance: float) -> int:
        vertices, faces = shapes.two_spheres(distance)
        return len(stiv.find_intersections(scale * vertices, faces))

    assert count(2.0000001) == 0
    assert count(2.0) == 16 * 16  # the poles touch: each face of one fan meets each face of the other
    assert count(1.9) > 16


def test_linked_rings() -> None:
    assert len(stiv.find_intersections(*shapes.linked_tori())) == 0
    vertices, faces = shapes.linked_tori(1.2)
    found = stiv.find_intersections(vertices, faces)
    assert len(found) > 10
    assert {(int(a), int(b)) for a, b in found} == rational.find_intersections(vertices, faces)


def test_cached_trees_follow_the_positions() -> None:
    vertices, faces = soup(3)
    test = stiv.IntersectionTest(stiv.Surface(faces, len(vertices)), threads=1)
    random = np.random.default_rng(4)
    for _ in range(4):
        found = test.find(vertices)
        assert {(int(a), int(b)) for a, b in found} == rational.find_intersections(vertices, faces)
        vertices = vertices + 0.2 * random.standard_normal(vertices.shape)
    with pytest.raises(stiv.InputError, match="vertices"):
        test.find(vertices[1:])


def test_untested_bodies_are_skipped_unless_requested() -> None:
    vertices, faces = shapes.linked_tori(1.2)
    body = np.repeat([0, 1], len(vertices) // 2)
    fixed = [stiv.Body("a", "fixed"), stiv.Body("b", "fixed")]
    surface = stiv.Surface(faces, len(vertices), vertex_body=body, bodies=fixed)
    assert len(stiv.find_intersections(vertices, surface)) == 0
    everything = stiv.find_intersections(vertices, surface, all_bodies=True)
    assert np.array_equal(everything, stiv.find_intersections(vertices, faces))


def test_loose_edges_and_vertices() -> None:
    vertices = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, 0], [1, 1, 1], [2, 1, 0], [9, 9, 9]]
    surface = stiv.Surface([[0, 1, 2]], 7, loose_edges=[[3, 4], [4, 6]])
    edges, points = stiv.find_loose_intersections(vertices, surface)
    assert edges.tolist() == [[0, 0]] and points.tolist() == [[5, 0]]


@given(height=st.floats(1e-6, 1.0), distance=st.floats(1e-6, 1.0))
def test_loose_edges_and_vertices_nearer_than_a_distance(height: float, distance: float) -> None:
    corners = [[0, 0, 0], [4, 0, 0], [0, 4, 0]]
    loose = [[1, 1, height], [1.5, 1, height], [1, 2, height], [-1, -1, 0], [-height / 2, -height / 2, 0]]
    surface = stiv.Surface([[0, 1, 2]], 8, loose_edges=[[3, 4], [6, 0]])
    edges, points = stiv.find_loose_intersections([*corners, *loose], surface, distance=distance)
    assert edges.tolist() == ([[0, 0]] if height < distance else [])  # the other edge is attached, and points away
    near = [[5, 0]] if height < distance else []
    assert points.tolist() == near + ([[7, 0]] if height / math.sqrt(2) < distance else [])


@settings(max_examples=examples(25), deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_no_motion_shorter_than_the_depth_parts_triangles(seed: int) -> None:
    random = np.random.default_rng(seed)
    corners, faces = random.normal(size=(6, 3)), np.array([[0, 1, 2], [3, 4, 5]])
    (depth,) = stiv.intersection_depths(corners, faces, [[0, 1]])
    assert (depth > 0) == (len(stiv.find_intersections(corners, faces)) == 1)

    def intersect_after(motion: Floats) -> bool:
        moved = corners.copy()
        moved[3:] += motion
        return len(stiv.find_intersections(moved, faces)) == 1

    if depth > 0:
        sides = [np.roll(each, -1, axis=0) - each for each in (corners[:3], corners[3:])]
        axes = [np.cross(each[0], each[1]) for each in sides] + [np.cross(a, b) for a in sides[0] for b in sides[1]]
        directions = [sign * axis / np.linalg.norm(axis) for axis in axes for sign in (1, -1)]
        assert not all(intersect_after(1.001 * depth * direction) for direction in directions)
        assert all(intersect_after(0.999 * depth * direction) for direction in directions)


def test_pairs_without_a_depth_are_named() -> None:
    with pytest.raises(stiv.InputError, match="pairs, row 0: index 2"):
        stiv.intersection_depths(np.eye(3), [[0, 1, 2], [0, 2, 1]], [[0, 2]])


@pytest.mark.parametrize(
    ("vertices", "faces", "message"),
    [
        ([[0, 0, 0], [0, np.nan, 0], [1, 0, 0]], [[0, 1, 2]], "vertices, row 1"),
        ([[0, 0, 0], [0, 1, 0], [1, 0, np.inf]], [[0, 1, 2]], "vertices, row 2"),
        (np.zeros((3, 2)), [[0, 1, 2]], r"vertices: shape is \(3, 2\)"),
        (np.zeros((3, 3)), [[0, 1, 2], [0, 1, 3]], "face 1: vertex index 3"),
        (np.zeros((3, 3)), [[0, 1, -1]], "row 0: index -1"),
        (np.zeros((3, 3)), [[0.0, 1.0, 2.0]], "dtype"),
        (np.zeros((3, 3)), [[0, 1]], "triangles: shape"),
    ],
)
def test_bad_input_is_named(vertices: Floats, faces: Integers, message: str) -> None:
    with pytest.raises(stiv.InputError, match=message):
        stiv.find_intersections(vertices, faces)


def test_an_empty_mesh_has_no_intersections() -> None:
    assert stiv.find_intersections(np.zeros((0, 3)), np.zeros((0, 3), np.int32)).shape == (0, 2)
    assert stiv.find_intersections(np.zeros((3, 3)), np.zeros((0, 3), np.int32)).shape == (0, 2)


def folded_sheet(seed: int, reach: int, size: int = 6) -> tuple[Floats, Integers]:
    """Return a connected sheet on an integer grid, some corners moved: folds, collapsed faces, coincident corners."""
    random = np.random.default_rng(seed)
    i, j = (k.ravel() for k in np.mgrid[:size, :size])
    vertices = np.stack([2 * i, 2 * j, np.zeros_like(i)], axis=1)
    stirred = random.random(len(vertices)) < 0.3
    vertices[stirred] += random.integers(-reach, reach + 1, (stirred.sum(), 3))
    corner = (i * size + j).reshape(size, size)
    a, b, c, d = (k.ravel() for k in (corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]))
    return vertices.astype(np.float64), np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


@settings(max_examples=examples(40), deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 4), st.sampled_from([2.0**-23, 1.0, 2.0**23]))
def test_folded_sheets_equal_brute_force(seed: int, reach: int, scale: float) -> None:
    vertices, faces = folded_sheet(seed, reach)
    found = stiv.find_intersections(scale * vertices, faces)
    assert {(int(a), int(b)) for a, b in found} == rational.find_intersections(vertices, faces)
