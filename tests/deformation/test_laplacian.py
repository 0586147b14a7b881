# SPDX-License-Identifier: GPL-3.0-or-later
"""Laplacian editing against a dense least-squares solution."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import stiv
from blend_fixtures.scenes.primitives import icosphere
from blend_fixtures.scenes.sweeps import trefoil

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
KINDS = [(weights, pull) for weights in ("uniform", "cotangent") for pull in (1.0, "each", None)]


def knot() -> tuple[Floats, NDArray[np.int64]]:
    shape = trefoil(24, 5)
    return shape.vertices, np.asarray(shape.triangles())


def dense_laplacian(vertices: Floats, triangles: NDArray[np.integer], kind: str) -> Floats:
    """1 - D^-1 W, computed edge by edge; the weight of an edge is at least 0.001."""
    weights = np.zeros((len(vertices), len(vertices)))
    for triangle in triangles:
        for k in range(3):
            apex, a, b = triangle[k - 2], triangle[k - 1], triangle[k]
            if kind == "uniform":
                weights[a, b] = weights[b, a] = 1
            else:
                u, v = vertices[a] - vertices[apex], vertices[b] - vertices[apex]
                cotangent = 1 / np.tan(np.arccos(u @ v / np.linalg.norm(u) / np.linalg.norm(v)))
                weights[a, b] += cotangent / 2
                weights[b, a] += cotangent / 2
    weights[weights != 0] = np.maximum(weights[weights != 0], 1e-3)
    laplacian: Floats = np.eye(len(vertices)) - weights / weights.sum(axis=1)[:, None]
    return laplacian


def least_squares(
    laplacian: Floats, rest: Floats, handles: Integers, fixed: Integers, pull: Floats | None, goal: Floats
) -> Floats:
    """Rows of the Laplacian and of the handles, as an overdetermined system in the free vertices."""
    q = rest.copy()
    if pull is None:
        q[handles] = goal
        held = np.concatenate([fixed, handles])
        rows, right = laplacian, laplacian @ rest
    else:
        held = fixed
        select = np.zeros((len(handles), len(rest)))
        select[np.arange(len(handles)), handles] = np.sqrt(pull)
        rows = np.concatenate([laplacian, select])
        right = np.concatenate([laplacian @ rest, np.sqrt(pull)[:, None] * goal])
    free = np.setdiff1d(np.arange(len(rest)), held)
    q[free] = np.linalg.lstsq(rows[:, free], right - rows[:, held] @ q[held], rcond=None)[0]
    return q


@pytest.mark.parametrize(("kind", "pull"), KINDS)
@pytest.mark.parametrize("make_mesh", [knot, lambda: (icosphere(2).vertices, np.array(icosphere(2).faces))])
def test_surface_is_the_least_squares_solution(
    make_mesh: Callable[[], tuple[Floats, Any]], kind: str, pull: float | str | None
) -> None:
    vertices, triangles = make_mesh()
    random = np.random.default_rng(5)
    if kind == "cotangent":  # no right angles: the edge weights do not vanish
        vertices = vertices + 1e-2 * random.normal(size=vertices.shape)
    chosen = random.permutation(len(vertices))
    handles, fixed = chosen[:12], chosen[12:20]
    pulls = None if pull is None else random.random(12) + 0.5 if pull == "each" else np.full(12, float(pull))  # type: ignore[arg-type]
    f = stiv.laplacian(vertices, triangles, handles, fixed=fixed, pull=pulls, edge_weights=kind)
    goal = vertices[handles] + random.normal(size=(12, 3))
    expected = least_squares(dense_laplacian(vertices, triangles, kind), vertices, handles, fixed, pulls, goal)
    found = f.surface(goal)
    assert np.abs(found - expected).max() < 1e-9
    assert np.array_equal(found[fixed], vertices[fixed])
    assert pull is not None or np.array_equal(found[handles], goal)
    assert np.array_equal(f.surface(vertices[handles]), vertices)


def test_a_scalar_pull_equals_the_same_pull_for_each_handle() -> None:
    vertices, triangles = knot()
    handles = np.arange(0, 60, 7)
    goal = vertices[handles] + (0.3, 0, -0.2)
    one, each = (stiv.laplacian(vertices, triangles, handles, pull=pull) for pull in (2.0, np.full(9, 2.0)))
    assert np.array_equal(one.surface(goal), each.surface(goal))


def test_a_stronger_pull_approaches_hard_handles() -> None:
    vertices, triangles = knot()
    handles, fixed = np.arange(5), np.arange(60, 65)
    goal = vertices[handles] + (0.5, 0.2, 0)
    hard = stiv.laplacian(vertices, triangles, handles, fixed=fixed, pull=None).surface(goal)
    distances = [
        np.abs(stiv.laplacian(vertices, triangles, handles, fixed=fixed, pull=pull).surface(goal) - hard).max()
        for pull in (0.01, 1.0, 100.0, 1e6)
    ]
    assert distances == sorted(distances, reverse=True)
    assert distances[-1] < 1e-5


def test_a_common_motion_of_all_handles_moves_the_whole_mesh() -> None:
    vertices, triangles = knot()
    f = stiv.laplacian(vertices, triangles, np.arange(0, 120, 11))
    moved = f.surface(vertices[::11] + (1.0, 2.0, -3.0))
    assert np.abs(moved - vertices - (1.0, 2.0, -3.0)).max() < 1e-8


def test_a_cage_by_handles_and_its_subdivision() -> None:
    ball = icosphere(1)
    subdivision, _ = stiv.loop(stiv.Cage.of_faces(ball.faces), 2)
    handles = np.array([0, 5, 9])
    cage = stiv.laplacian(ball.vertices, ball.faces, handles, fixed=[20, 21])
    whole = stiv.compose(subdivision, cage)
    goal = ball.vertices[handles] + (0.2, -0.1, 0.4)
    assert np.array_equal(whole.surface(goal), subdivision.surface(cage.surface(goal)))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"handles": [0, 0]}, "handle 1: vertex 0 is already handle 0"),
        ({"handles": [120]}, "handles, row 0: index 120"),
        ({"fixed": [4]}, "vertex 4 is handle 1"),
        ({"pull": -1.0}, "handle 0: its pull"),
        ({"pull": [1.0]}, "pull: shape"),
        ({"edge_weights": "heavy"}, 'edge weights "heavy" are unknown'),
        ({"triangles": [[0, 1, 120]]}, "triangles, row 0"),
    ],
)
def test_bad_input_is_named(arguments: dict[str, Any], message: str) -> None:
    vertices, triangles = knot()
    with pytest.raises(stiv.InputError, match=message):
        stiv.laplacian(vertices, **{"triangles": triangles, "handles": [0, 4], **arguments})
