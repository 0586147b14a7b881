# SPDX-License-Identifier: GPL-3.0-or-later
"""Loop subdivision against its published masks."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

import stiv
from tests.deformation import cages
from tests.deformation.cages import CageCase
from tests.deformation.loop_masks import LoopMesh, subdivided
from tests.deformation.test_subdivision import cage_of

FOREVER = 1e9  # a crease of 1 stays sharp at every level


def triangulated(case: CageCase) -> CageCase:
    """Every face split into a fan from its first corner, with the creases of the original edges."""
    faces = [(f[0], f[k], f[k + 1]) for f in case.faces for k in range(1, len(f) - 1)]
    return CageCase(case.vertices, faces, case.loose_edges, case.edge_crease, case.vertex_crease)


def tetrahedron() -> CageCase:
    """Only vertices of valence 3."""
    points = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1.2)], float)
    return CageCase(points, [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)])


def cube() -> CageCase:
    return triangulated(cages.cube())


def cylinder() -> CageCase:
    """Two vertices of high valence."""
    return triangulated(cages.cylinder(9))


def torus() -> CageCase:
    """Only regular vertices."""
    return triangulated(cages.torus())


def sheet() -> CageCase:
    """With a boundary."""
    return triangulated(cages.grid())


def cube_with_sharp_edges() -> CageCase:
    """A closed crease, a crease that ends inside the surface, and a corner of creases."""
    sharp = {(0, 1): 1.0, (1, 3): 1.0, (2, 3): 1.0, (0, 2): 1.0, (5, 7): 1.0}
    case = cube()
    return CageCase(case.vertices, case.faces, edge_crease=sharp, vertex_crease={6: 1.0})


def cylinder_with_worn_creases() -> CageCase:
    """Closed creases of sharpness 1 and 2, which disappear after 1 and 2 levels."""
    case = cylinder()
    rings = {tuple(sorted((k + s, (k + 1) % 9 + s))): crease for s, crease in ((0, 0.1), (9, 0.2)) for k in range(9)}
    return CageCase(case.vertices, case.faces, edge_crease={e: float(np.sqrt(c)) for e, c in rings.items()})  # type: ignore[misc]


def creased_sheet() -> CageCase:
    """A crease from boundary to boundary, and one that ends inside the surface."""
    sharp = {(k, k + 5): 1.0 for k in (2, 7, 12, 17)} | {(13, 14): 1.0}
    case = sheet()
    return CageCase(case.vertices, case.faces, edge_crease=sharp)


def triangle() -> CageCase:
    return cages.triangle()


CASES = [tetrahedron, cages.octahedron, cube, cylinder, torus, sheet, triangle]
CREASED = [cube_with_sharp_edges, creased_sheet]
WORN = [cylinder_with_worn_creases]


QUALITY = 3  # the default


def corners_of_boundary(case: CageCase) -> list[int]:
    """Vertices that belong to a single triangle."""
    return [v for v in range(len(case.vertices)) if sum(v in face for face in case.faces) == 1]


def reference(case: CageCase, levels: int, limit: bool) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The result of the masks.

    The limit is taken after `quality` levels, where it matters: the masks of ends of creases are not exact.
    At rounded corners of the boundary OpenSubdiv goes no further than those levels.
    """

    def sharpness(crease: float) -> float:
        return FOREVER if crease == 1 else round(10 * crease**2, 6)

    mesh = LoopMesh(
        len(case.vertices),
        [(f[0], f[1], f[2]) for f in case.faces],
        {edge: sharpness(crease) for edge, crease in case.edge_crease.items()},
        {v: sharpness(crease) for v, crease in case.vertex_crease.items()},
    )
    positions, triangles = subdivided(mesh, case.vertices, levels, limit=False)
    if limit:
        corners, count = corners_of_boundary(case), len(positions)
        fine = subdivided(mesh, case.vertices, QUALITY, limit=False)[0][corners]
        positions = subdivided(mesh, case.vertices, QUALITY, limit=True)[0][:count]
        positions[corners] = fine
    return positions, triangles


def turned_to_smallest(triangles: NDArray[np.integer]) -> set[tuple[int, ...]]:
    first = np.argmin(triangles, axis=1)[:, None]
    return {tuple(row) for row in np.take_along_axis(triangles, (first + np.arange(3)) % 3, axis=1).tolist()}


def assert_same_mesh(case: CageCase, levels: int, limit: bool) -> None:
    """Compare by position, because the masks number the vertices differently."""
    deformation, triangles = stiv.loop(cage_of(case), levels, limit_surface=limit)
    found, (expected, faces) = deformation.surface(case.vertices), reference(case, levels, limit)
    assert found.shape == expected.shape
    distance = np.linalg.norm(found[:, None] - expected, axis=2)
    place = distance.argmin(axis=1)
    assert len(set(place.tolist())) == len(place)
    assert distance.min(axis=1).max() < 1e-6 * np.ptp(case.vertices)
    assert np.array_equal(place[: len(case.vertices)], np.arange(len(case.vertices)))
    assert turned_to_smallest(place[triangles]) == turned_to_smallest(faces)


@pytest.mark.parametrize("make_case", CASES + CREASED + WORN)
@pytest.mark.parametrize("levels", [1, 2, 3])
def test_refinement_by_the_masks(make_case: Callable[[], CageCase], levels: int) -> None:
    assert_same_mesh(make_case(), levels, limit=False)


@pytest.mark.parametrize("make_case", CASES + CREASED)
@pytest.mark.parametrize("levels", [1, 2, 3])
def test_limit_positions_by_the_masks(make_case: Callable[[], CageCase], levels: int) -> None:
    assert_same_mesh(make_case(), levels, limit=True)


def test_one_level_is_numbered_by_vertices_and_edges() -> None:
    case = sheet()
    found = stiv.loop(cage_of(case), 1, limit_surface=False)[0].surface(case.vertices)
    assert np.abs(found - reference(case, 1, limit=False)[0]).max() < 1e-6


@pytest.mark.parametrize("make_case", [sheet, triangle])
def test_corners_of_the_boundary_can_stay(make_case: Callable[[], CageCase]) -> None:
    case = make_case()
    corners = corners_of_boundary(case)
    assert corners
    deformation, _ = stiv.loop(cage_of(case), 2, boundary="preserve_corners")
    assert np.abs(deformation.surface(case.vertices)[corners] - case.vertices[corners]).max() < 1e-6
    rounded, _ = stiv.loop(cage_of(case), 2)
    assert np.linalg.norm(rounded.surface(case.vertices) - case.vertices[0], axis=1).min() > 0.05


@given(st.integers(0, 2**32 - 1))
def test_affine_maps_pass_through(seed: int) -> None:
    random = np.random.default_rng(seed)
    matrix, shift = random.normal(size=(3, 3)), random.normal(size=3)
    for case in (creased_sheet(), cylinder()):
        deformation, _ = stiv.loop(cage_of(case), 2)
        before = deformation.surface(case.vertices) @ matrix.T + shift
        moved = deformation.surface(case.vertices @ matrix.T + shift)
        assert np.abs(moved - before).max() < 1e-12 * np.abs(before).max()


def test_wires_and_loose_vertices_follow_the_rules_of_the_modifier() -> None:
    case = triangulated(cages.wires_on_a_sheet())
    loop, catmull_clark = (
        stiv.linear(stiv.subdivision_weights(cage_of(case), 2, scheme=scheme)).surface(case.vertices)
        for scheme in ("loop", "catmull_clark")
    )
    faces, count = len(case.face_edges()), len(case.vertices)
    wires = slice(count + 3 * faces, count + 3 * (faces + len(case.loose_edges)))
    assert np.array_equal(loop[wires], catmull_clark[wires])


def test_triangles_of_a_cage_face_stand_together() -> None:
    case = cylinder()
    _, triangles = stiv.loop(cage_of(case), 3)
    for face, part in zip(case.faces, triangles.reshape(len(case.faces), 64, 3), strict=True):
        assert set(face) <= set(part.ravel().tolist())
        assert len(set(part.ravel().tolist())) == 45


def test_other_faces_are_refused() -> None:
    with pytest.raises(stiv.InputError, match="face 1: it has 4 corners"):
        stiv.loop(stiv.Cage.of_faces([(0, 1, 2), (0, 2, 3, 4)]))
    with pytest.raises(stiv.InputError, match='scheme "doo_sabin" is unknown'):
        stiv.subdivision_weights(stiv.Cage.of_faces([(0, 1, 2)]), scheme="doo_sabin")
