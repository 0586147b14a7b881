# SPDX-License-Identifier: GPL-3.0-or-later
"""Subdivision without Blender: properties of every cage."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stiv
from tests.deformation.cages import CASES, CageCase, cube, grid, octahedron, torus


def cage_of(case: CageCase) -> stiv.Cage:
    edges = case.face_edges() + case.loose_edges
    return stiv.Cage.of_faces(
        case.faces,
        len(case.vertices),
        np.array(edges).reshape(-1, 2),
        [case.edge_crease.get(edge, 0.0) for edge in edges],
        [case.vertex_crease.get(v, 0.0) for v in range(len(case.vertices))],
    )


@pytest.mark.parametrize("make_case", CASES)
@pytest.mark.parametrize("options", [{}, {"limit_surface": False}, {"simple": True}, {"boundary": "preserve_corners"}])
def test_weights_add_up_to_one(make_case: Callable[[], CageCase], options: dict[str, Any]) -> None:
    """Subdivision therefore commutes with affine maps, and world positions may replace local ones."""
    weights = stiv.subdivision_weights(cage_of(make_case()), 2, **options)
    sums = np.add.reduceat(weights.data, weights.indptr[:-1])
    assert np.abs(sums - 1).max() < 1e-12


def midpoints_and_centres(case: CageCase) -> np.ndarray:
    """One step of Catmull-Clark by the textbook rules, for a closed cage without creases: vertices, edges, faces."""
    vertices, edges = case.vertices, case.face_edges()
    centres = np.array([vertices[list(face)].mean(axis=0) for face in case.faces])
    owners = {edge: [k for k, face in enumerate(case.faces) if set(edge) <= set(face)] for edge in edges}
    edge_points = np.array(
        [(vertices[list(edge)].sum(axis=0) + centres[owners[edge]].sum(axis=0)) / 4 for edge in edges]
    )
    moved = []
    for v, point in enumerate(vertices):
        around = [edge for edge in edges if v in edge]
        count = len(around)
        faces = np.mean([centres[k] for k, face in enumerate(case.faces) if v in face], axis=0)
        middles = np.mean([vertices[list(edge)].mean(axis=0) for edge in around], axis=0)
        moved.append((faces + 2 * middles + (count - 3) * point) / count)
    return np.concatenate([moved, edge_points, centres])


@pytest.mark.parametrize("make_case", [cube, torus])
def test_one_level_by_the_textbook(make_case: Callable[[], CageCase]) -> None:
    case = make_case()
    found = stiv.linear(stiv.subdivision_weights(cage_of(case), 1, limit_surface=False)).surface(case.vertices)
    assert np.abs(found - midpoints_and_centres(case)).max() < 1e-6


def test_limit_of_refinement() -> None:
    """Vertices on the limit surface are the limits of refinement."""
    case = octahedron()
    cage, count = cage_of(case), len(case.vertices)
    limit = stiv.linear(stiv.subdivision_weights(cage, 1, quality=6)).surface(case.vertices)
    refined = stiv.linear(stiv.subdivision_weights(cage, 6, limit_surface=False)).surface(case.vertices)
    assert np.abs(limit[:count] - refined[:count]).max() < 1e-3


@pytest.mark.parametrize("make_case", CASES)
@pytest.mark.parametrize("levels", [1, 2, 3])
def test_faces_keep_the_topology(make_case: Callable[[], CageCase], levels: int) -> None:
    case = make_case()
    cage = cage_of(case)
    quads = stiv.subdivided_faces(cage, levels)
    assert len(quads) == sum(len(face) for face in case.faces) * 4 ** (levels - 1)
    edges = {frozenset(quad[[k - 1, k]].tolist()) for quad in quads for k in range(4)}
    used = {v for face in case.faces for v in face}
    cuts = 2**levels
    inner = sum((cuts - 1) ** 2 if len(f) == 4 else 1 + len(f) * (cuts // 2) * (cuts // 2 - 1) for f in case.faces)
    vertices = len(used) + len(case.face_edges()) * (cuts - 1) + inner
    assert len(set(quads.ravel().tolist())) == vertices
    euler = len(used) - len(case.face_edges()) + len(case.faces)
    assert vertices - len(edges) + len(quads) == euler


def test_catmull_clark_makes_a_closed_oriented_surface() -> None:
    case = cube()
    deformation, triangles = stiv.catmull_clark(cage_of(case), 2)
    q = deformation.surface(case.vertices)
    assert deformation.vertex_count == triangles.max() + 1 == 98
    a, b, c = (q[triangles[:, k]] for k in range(3))
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    assert 1 < volume < 8
    directed = {(int(t[k - 1]), int(t[k])) for t in triangles for k in range(3)}
    assert all((b, a) in directed for a, b in directed)


def test_edges_are_found_from_faces() -> None:
    faces = [(0, 1, 2, 3), (1, 4, 2)]
    with_edges = stiv.Cage.of_faces(faces, 5, [(0, 1), (0, 3), (1, 2), (1, 4), (2, 3), (2, 4)])
    found = stiv.subdivision_weights(stiv.Cage.of_faces(faces), 2)
    assert np.array_equal(found.dense(), stiv.subdivision_weights(with_edges, 2).dense())


@given(st.integers(3, 6), st.integers(0, 2**32 - 1))
def test_affine_maps_pass_through(side: int, seed: int) -> None:
    case = grid(side)
    random = np.random.default_rng(seed)
    matrix, shift = random.normal(size=(3, 3)), random.normal(size=3)
    deformation, _ = stiv.catmull_clark(cage_of(case), 2)
    before = deformation.surface(case.vertices) @ matrix.T + shift
    assert np.abs(deformation.surface(case.vertices @ matrix.T + shift) - before).max() < 1e-12 * np.abs(before).max()


def test_empty_cage() -> None:
    assert stiv.subdivision_weights(stiv.Cage.of_faces([], 0), 2).shape == (0, 0)
    assert stiv.subdivided_faces(stiv.Cage.of_faces([], 3), 1).shape == (0, 4)


@pytest.mark.parametrize(
    ("cage", "message"),
    [
        (stiv.Cage.of_faces([(0, 1, 2), (0, 1)]), "face 1: a face needs at least 3 corners"),
        (stiv.Cage.of_faces([(0, 1, 2, 1)]), "face 0: vertex 1 is a corner twice"),
        (stiv.Cage(3, [0, 1, 3], [0, 3]), "corners, row 2: index 3"),
        (stiv.Cage(3, [0, 1, 2], [0, 4]), "face_starts"),
        (stiv.Cage(3, [0, 1, 2], [1, 3]), "starts of the faces"),
        (stiv.Cage.of_faces([(0, 1, 2)], edges=[(0, 1), (1, 2)]), "face 0: its edge between vertices 2 and 0"),
        (stiv.Cage.of_faces([(0, 1, 2)], edges=[(0, 1), (1, 2), (2, 2)]), "edge 2: both ends"),
        (stiv.Cage.of_faces([(0, 1, 2)], vertex_crease=[0, 2, 0]), "vertex 1: crease"),
        (stiv.Cage.of_faces([(0, 1, 2)], vertex_crease=[0, 2]), "2 creases for 3"),
        (stiv.Cage.of_faces([(0, 1, 2)], edge_crease=[0, 0, 0]), "`edges` is required"),
    ],
)
def test_bad_cages_are_named(cage: stiv.Cage, message: str) -> None:
    with pytest.raises(stiv.InputError, match=message):
        stiv.subdivision_weights(cage, 1)


@pytest.mark.parametrize(
    ("options", "message"),
    [({"levels": 12}, "levels is 12"), ({"quality": 0}, "quality is 0"), ({"boundary": "none"}, 'boundary "none"')],
)
def test_bad_options_are_named(options: dict[str, Any], message: str) -> None:
    with pytest.raises(stiv.InputError, match=message):
        stiv.subdivision_weights(cage_of(cube()), **options)
