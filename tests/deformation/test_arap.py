# SPDX-License-Identifier: GPL-3.0-or-later
"""As-rigid-as-possible editing against a plain alternation of dense local and global steps."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import stiv
from blend_fixtures.scenes.primitives import icosphere
from blend_fixtures.scenes.sweeps import tube
from tests.deformation.test_laplacian import dense_laplacian

Floats = NDArray[np.float64]


def bar() -> tuple[Floats, NDArray[np.integer], NDArray[np.integer], NDArray[np.integer]]:
    """A tube and its triangles, with handles at one end and fixed vertices at the other."""
    path = np.stack([np.zeros(6), np.zeros(6), np.linspace(0, 2, 6)], axis=1)
    shape = tube(path, np.full(6, 0.4), 6)
    z = shape.vertices[:, 2]
    return shape.vertices, np.asarray(shape.triangles()), np.flatnonzero(z > 1.9), np.flatnonzero(z < 0.1)


def edge_weights(vertices: Floats, triangles: NDArray[np.integer], kind: str) -> Floats:
    """W from 1 - D^-1 W, which another test checks; cotangents need one known edge per vertex."""
    laplacian = dense_laplacian(vertices, triangles, kind)
    if kind == "uniform":
        return (laplacian < 0).astype(float)
    weights = np.zeros_like(laplacian)
    for triangle in triangles:
        for k in range(3):
            apex, a, b = triangle[k - 2], triangle[k - 1], triangle[k]
            u, v = vertices[a] - vertices[apex], vertices[b] - vertices[apex]
            weights[a, b] += u @ v / np.linalg.norm(np.cross(u, v)) / 2
            weights[b, a] = weights[a, b]
    return np.where(laplacian < 0, np.maximum(weights, 1e-3), 0)


def alternation(
    vertices: Floats, weights: Floats, held: dict[int, Floats], pulled: dict[int, Floats], steps: int
) -> Floats:
    """Published local and global steps: rotations by singular values, positions by a dense solve. [Sorkine 2007]"""
    q = vertices.copy()
    stiffness = np.diag(weights.sum(axis=1)) - weights
    rest = vertices[:, None] - vertices
    for vertex in pulled:
        stiffness[vertex, vertex] += 1
    free = np.array([v for v in range(len(vertices)) if v not in held])
    known = np.array(sorted(held), int)
    for _ in range(steps):
        q[known] = [held[v] for v in known]
        spread = np.einsum("ij,ijk,ijl->ikl", weights, rest, q[:, None] - q)
        u, _, vt = np.linalg.svd(spread)
        sign = np.linalg.det(u @ vt)
        u[:, :, 2] *= sign[:, None]
        rotations = np.swapaxes(u @ vt, 1, 2)
        right = np.einsum("ij,ijab,ijb->ia", weights / 2, rotations[:, None] + rotations, rest)
        for vertex, goal in pulled.items():
            right[vertex] += goal
        right = right - stiffness[:, known] @ q[known]
        q[free] = np.linalg.solve(stiffness[np.ix_(free, free)], right[free])
    return q


def bent(points: Floats, angle: float) -> Floats:
    """The points rotated about the y axis through the centre of the bar."""
    turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    return (points - (0, 0, 1)) @ turn.T + (0, 0, 1)


@pytest.mark.parametrize("kind", ["uniform", "cotangent"])
@pytest.mark.parametrize(("pull", "angle"), [(None, 0.2), (None, 1.0), (1.0, 0.6)])
def test_the_minimum_is_that_of_the_published_steps(kind: str, pull: float | None, angle: float) -> None:
    vertices, triangles, handles, fixed = bar()
    goal = bent(vertices[handles], angle)
    held = {int(v): vertices[v] for v in fixed}
    goals = {int(v): g for v, g in zip(handles, goal, strict=True)}
    weights = edge_weights(vertices, triangles, kind)
    expected = alternation(
        vertices, weights, held | (goals if pull is None else {}), {} if pull is None else goals, 600
    )
    found = stiv.arap(vertices, triangles, handles, fixed=fixed, pull=pull, edge_weights=kind).surface(goal)
    assert np.abs(found - expected).max() < 1e-6


def test_a_bar_preserves_its_size_where_laplacian_editing_does_not() -> None:
    vertices, triangles, handles, fixed = bar()
    goal = bent(vertices[handles], 2.0)
    edges = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)

    def stretch(q: Floats) -> float:
        lengths = [np.linalg.norm(x[edges[:, 0]] - x[edges[:, 1]], axis=1) for x in (q, vertices)]
        return float(np.abs(np.log(lengths[0] / lengths[1])).mean())

    rigid, laplacian = (
        make(vertices, triangles, handles, fixed=fixed, pull=None).surface(goal) for make in (stiv.arap, stiv.laplacian)
    )
    assert stretch(rigid) < 0.7 * stretch(laplacian)


@pytest.mark.parametrize("pull", [None, 0.5])
def test_jacobian_against_differences(pull: float | None) -> None:
    ball = icosphere(1)
    handles = [3, 11, 4, 30]
    f = stiv.arap(ball.vertices, ball.faces, handles, fixed=[7, 8], pull=pull)
    random = np.random.default_rng(4)
    p = ball.vertices[handles] + 0.3 * random.normal(size=(4, 3))
    step = 1e-4
    for _ in range(4):
        d, g = random.normal(size=(4, 3)), random.normal(size=(42, 3))
        velocity = (f.surface(p + step * d) - f.surface(p - step * d)) / (2 * step)
        assert np.abs(f.push_forward(p, d) - velocity).max() < 1e-5
        assert np.sum(f.pull_back(p, g) * d) == pytest.approx(np.sum(g * velocity), abs=1e-4)


def test_the_same_controls_give_the_same_bits_whatever_came_before() -> None:
    vertices, triangles, handles, fixed = bar()
    f = stiv.arap(vertices, triangles, handles, fixed=fixed)
    goal = bent(vertices[handles], 0.7)
    first = f.surface(goal)
    f.surface(bent(vertices[handles], 1.5))
    assert f.surface(goal).tobytes() == first.tobytes()
    assert np.array_equal(f.surface(vertices[handles]), vertices)
