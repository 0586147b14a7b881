# SPDX-License-Identifier: GPL-3.0-or-later
"""Every deformation: Jacobians against differences, metrics against dense ones, input checked."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import stiv
from blend_fixtures.scenes.primitives import icosphere
from tests.deformation.cages import mixed_strip, octahedron

Floats = NDArray[np.float64]
RANDOM = np.random.default_rng(2)
POINTS = RANDOM.normal(size=(11, 3))
MATRIX = RANDOM.normal(size=(9, 5)) * (RANDOM.random((9, 5)) < 0.6)


def turned(angle: float) -> Floats:
    return np.array([[0.5, 1, 2], angle * np.array([0.6, -0.48, 0.64])])


def side_by_side() -> stiv.Deformation:
    parts = [(stiv.rigid(POINTS[[7, 1, 3]]), [7, 1, 3]), (stiv.identity(2), [0, 10]), (stiv.linear(MATRIX[:2]), [5, 4])]
    return stiv.concatenate(parts, POINTS)


BALL, HANDLES = icosphere(1), [3, 11, 4, 30]
BALL_SUBDIVIDED, _ = stiv.loop(stiv.Cage.of_faces(BALL.faces), 1)


def on_a_ball(pull: float | None) -> stiv.Deformation:
    return stiv.laplacian(BALL.vertices, BALL.faces, HANDLES, fixed=[7, 8], pull=pull)


DEFORMATIONS: dict[str, tuple[Callable[[], stiv.Deformation], Floats]] = {
    "identity": (lambda: stiv.identity(11), POINTS),
    "linear": (lambda: stiv.linear(MATRIX, RANDOM.normal(size=(9, 3))), POINTS[:5]),
    "rigid": (lambda: stiv.rigid(POINTS), turned(0.0)),
    "rigid, turned": (lambda: stiv.rigid(POINTS), turned(2.0)),
    "rigid, half a turn": (lambda: stiv.rigid(POINTS), turned(np.pi)),
    "rigid, a full turn": (lambda: stiv.rigid(POINTS), turned(2 * np.pi)),
    "rigid, about a pivot": (lambda: stiv.rigid(POINTS, (1, 2, 3)), turned(2.0)),
    "scaling": (lambda: stiv.scaling(POINTS, np.eye(3)[[1, 2, 0]]), np.array([[0, 0, 1], [1, 2, -0.5]])),
    "side by side": (side_by_side, np.concatenate([turned(1.0), POINTS[:7]])),
    "subdivision": (lambda: stiv.catmull_clark(stiv.Cage.of_faces(mixed_strip().faces), 1)[0], mixed_strip().vertices),
    "loop": (lambda: stiv.loop(stiv.Cage.of_faces(octahedron().faces), 2)[0], octahedron().vertices),
    "laplacian": (lambda: on_a_ball(1.0), BALL.vertices[HANDLES] + 0.2 * POINTS[:4]),
    "laplacian, hard": (lambda: on_a_ball(None), BALL.vertices[HANDLES] + 0.2 * POINTS[:4]),
    "laplacian, subdivided": (lambda: stiv.compose(BALL_SUBDIVIDED, on_a_ball(2.0)), BALL.vertices[HANDLES]),
    "lattice": (lambda: stiv.lattice(POINTS, (2, 3, 2)), RANDOM.normal(size=(12, 3))),
}


@pytest.mark.parametrize("name", DEFORMATIONS)
def test_jacobian_against_differences(name: str) -> None:
    make, p = DEFORMATIONS[name]
    f = make()
    g, d = RANDOM.normal(size=(f.vertex_count, 3)), RANDOM.normal(size=(f.control_count, 3))
    step = 1e-5
    velocity = (f.surface(p + step * d) - f.surface(p - step * d)) / (2 * step)
    assert np.abs(f.push_forward(p, d) - velocity).max() < 1e-7
    assert np.sum(f.pull_back(p, g) * d) == pytest.approx(np.sum(g * velocity), abs=1e-6)


LINEAR = ["linear", "lattice", "subdivision", "loop", "laplacian", "laplacian, hard", "laplacian, subdivided"]


def jacobian(f: stiv.Deformation, p: Floats) -> Floats:
    units = np.eye(3 * f.control_count).reshape(-1, f.control_count, 3)
    return np.stack([f.push_forward(p, unit).ravel() for unit in units], axis=1)


@pytest.mark.parametrize("name", LINEAR)
@pytest.mark.parametrize("smoothness", [0.1, 0.01])
def test_linear_metric_against_a_dense_one(name: str, smoothness: float) -> None:
    make, p = DEFORMATIONS[name]
    f = make()
    weights = RANDOM.random(f.control_count)
    weights[1] = 0
    g = RANDOM.normal(size=(f.control_count, 3))
    free = np.repeat(weights > 0, 3)
    gram = (jacobian(f, p).T @ jacobian(f, p))[np.ix_(free, free)]
    gram += smoothness * np.mean(np.diag(gram)) * np.eye(len(gram))
    root = np.repeat(np.sqrt(weights), 3)[free]
    expected = np.zeros(3 * f.control_count)
    expected[free] = root * np.linalg.solve(gram, root * g.ravel()[free])
    found = f.apply_inverse_metric(p, g, smoothness, weights)
    assert np.abs(found.ravel() - expected).max() < 1e-10 * np.abs(expected).max()
    axes = np.stack([weights, RANDOM.random(f.control_count), weights[::-1]], axis=1)
    found = f.apply_inverse_metric(p, g, smoothness, axes)
    for axis in range(3):
        along = f.apply_inverse_metric(p, g, smoothness, np.ascontiguousarray(axes[:, axis]))[:, axis]
        assert np.array_equal(found[:, axis], along)


@pytest.mark.parametrize("name", DEFORMATIONS)
def test_support_contains_the_vertices_that_move(name: str) -> None:
    make, p = DEFORMATIONS[name]
    f = make()
    columns = np.abs(jacobian(f, p)).reshape(f.vertex_count, 3, f.control_count, 3).max(axis=(1, 3))
    for control in range(f.control_count):
        assert set(np.flatnonzero(columns[:, control] > 1e-12)) <= set(f.support(control))


@given(st.lists(st.floats(-20, 20), min_size=6, max_size=6))
@settings(deadline=None)
def test_rigid_motion_keeps_distances(values: list[float]) -> None:
    q = stiv.rigid(POINTS).surface(np.array(values).reshape(2, 3))
    before = np.linalg.norm(POINTS[:, None] - POINTS, axis=2)
    after = np.linalg.norm(q[:, None] - q, axis=2)
    assert np.abs(before - after).max() < 1e-12


def test_a_rotation_about_a_pivot_keeps_it() -> None:
    """The rest controls are those of any rigid motion, and the metric of the rotation is that of its Jacobian."""
    pivot = np.array([1.0, 2, 3])
    points = np.concatenate([POINTS, [pivot]])
    f, start = stiv.rigid(points, pivot), stiv.rigid_rest_controls(points)
    assert np.abs(f.surface(start)[:-1] - POINTS).max() < 1e-14
    turn = start + [[0, 0, 0], [0.3, -0.8, 0.5]]
    assert np.abs(f.surface(turn)[-1] - pivot).max() < 1e-14
    rotation = jacobian(f, start)[:, 3:]
    gram = rotation.T @ rotation
    gram += 0.1 * np.diag(np.diag(gram))
    g = np.array([[0.0, 0, 0], [0.4, -0.2, 0.7]])
    found = f.apply_inverse_metric(start, g, 0.1, np.array([0.0, 1.0]))
    assert found[1] == pytest.approx(np.linalg.solve(gram, g[1]), rel=1e-10)


def test_rest_controls_move_nothing() -> None:
    assert np.abs(stiv.rigid(POINTS).surface(stiv.rigid_rest_controls(POINTS)) - POINTS).max() < 1e-14
    scaling = stiv.scaling(POINTS, np.eye(3))
    assert np.abs(scaling.surface(stiv.scaling_rest_controls(POINTS)) - POINTS).max() < 1e-14


def test_rotation_rows() -> None:
    assert side_by_side().rotation_rows == [1]
    assert stiv.identity(3).rotation_rows == []


@dataclass
class CompressedRows:
    """The interface of any CSR matrix."""

    indptr: Any
    indices: Any
    data: Any
    shape: Any


def test_linear_accepts_every_matrix_format() -> None:
    weights, _ = stiv.linear_weights(stiv.linear(MATRIX))
    fields = (weights.indptr, weights.indices, weights.data, weights.shape)
    assert np.array_equal(weights.dense(), MATRIX)
    for form in (MATRIX.tolist(), weights, fields, CompressedRows(*fields)):
        assert np.array_equal(stiv.linear(form).surface(POINTS[:5]), stiv.linear(MATRIX).surface(POINTS[:5]))
    assert np.allclose(stiv.linear(MATRIX).surface(POINTS[:5]), MATRIX @ POINTS[:5], atol=1e-14)
    doubled = stiv.linear(([0, 3], [1, 0, 1], [1.0, 5.0, 2.0], (1, 2)))
    assert np.array_equal(stiv.linear_weights(doubled)[0].dense(), [[5.0, 3.0]])


def test_compose_applies_one_deformation_after_the_other() -> None:
    outer_matrix, offsets = RANDOM.normal(size=(4, 9)), RANDOM.normal(size=(2, 9, 3))
    inner = stiv.linear(MATRIX, offsets[0])
    outer = stiv.linear(outer_matrix, offsets[1, :4])
    p = POINTS[:5]
    assert np.allclose(stiv.compose(outer, inner).surface(p), outer.surface(inner.surface(p)), atol=1e-13)
    assert np.allclose(
        stiv.compose(stiv.linear_weights(outer)[0], stiv.linear(MATRIX)).surface(p), outer_matrix @ MATRIX @ p
    )
    three = stiv.compose(stiv.linear(outer_matrix.T), outer, inner)
    assert np.allclose(three.surface(p), outer_matrix.T @ outer.surface(inner.surface(p)), atol=1e-12)
    assert stiv.linear_weights(stiv.compose(stiv.linear(outer_matrix), stiv.linear(MATRIX)))[1] is None


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: stiv.identity(-1), "vertex_count"),
        (lambda: stiv.identity(4).surface(POINTS), "controls have 11 rows, the deformation has 4"),
        (lambda: stiv.identity(4).support(4), "control 4 does not exist"),
        (lambda: stiv.identity(11).pull_back(POINTS, POINTS[:4]), "covector has 4 rows, expected 11"),
        (lambda: stiv.linear([[1, np.inf]]), "matrix, row 0"),
        (lambda: stiv.linear(([0, 1, 2], [0, 0], [1, np.nan], (2, 1))), "row 1: weight of control 0"),
        (lambda: stiv.linear(([0, 1], [2], [1.0], (1, 2))), "matrix.indices, row 0: index 2"),
        (lambda: stiv.linear(([0, 2], [1], [1.0], (1, 2))), "starts of the rows"),
        (lambda: stiv.linear(([0, 1, 0, 1], [1], [1.0], (3, 2))), "row 1: ends before it starts"),
        (lambda: stiv.linear(([0, 1], [1], [1.0], 3)), "shape must be"),
        (lambda: stiv.linear(MATRIX, np.zeros((3, 3))), "offset: shape"),
        (lambda: stiv.linear_weights(stiv.identity(2)), "only linear deformations"),
        (
            lambda: stiv.compose(stiv.linear(MATRIX), stiv.rigid(POINTS)),
            "the inner one linear, observed, by scalars",
        ),
        (lambda: stiv.compose(stiv.linear(MATRIX), stiv.linear(MATRIX)), "5 controls, the inner one moves 9"),
        (lambda: stiv.rigid([[0, 0, np.nan]]), "vertices, row 0"),
        (lambda: stiv.rigid(POINTS, (0, 0, np.inf)), "pivot"),
        (lambda: stiv.scaling(POINTS, 2 * np.eye(3)), "not a rotation"),
        (lambda: stiv.concatenate([(stiv.identity(2), [0, 0])], POINTS), "vertex 0: already in component 0"),
        (lambda: stiv.concatenate([(stiv.identity(2), [0, 11])], POINTS), "index 11"),
        (lambda: stiv.concatenate([(stiv.identity(2), [0])], POINTS), "1 vertices given"),
        (lambda: stiv.identity(2).apply_inverse_metric(POINTS[:2], POINTS[:2], -1.0), "smoothness"),
    ],
)
def test_bad_input_is_named(call: Callable[[], Any], message: str) -> None:
    with pytest.raises(stiv.InputError, match=message):
        call()
