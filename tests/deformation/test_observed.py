# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions of the caller as deformations: values, Jacobians, metrics, infeasible controls, compositions, threads."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import stiv
from blend_fixtures.scenes.primitives import grid, triangulated
from tests.oracles.path import find_contacts

scipy = pytest.importorskip("scipy")  # Pythons of other platforms lack it

Floats = NDArray[np.float64]
RANDOM = np.random.default_rng(7)
SHEET = triangulated(grid(6, 3, 3.0, 1.5))
FACES = np.array(SHEET.faces)
TURN = 0.9  # radians per length


def twisted(p: Floats) -> Floats:
    """Twist about the x axis, by an angle that grows with x."""
    c, s = np.cos(TURN * p[:, 0]), np.sin(TURN * p[:, 0])
    return np.stack([p[:, 0], c * p[:, 1] - s * p[:, 2], s * p[:, 1] + c * p[:, 2]], axis=1)


def twist_blocks(p: Floats) -> Floats:
    """The derivative of `twisted`, (n, 3, 3)."""
    c, s = np.cos(TURN * p[:, 0]), np.sin(TURN * p[:, 0])
    zero, one, q = 0 * c, 1 + 0 * c, twisted(p)
    rows = [[one, zero, zero], [-TURN * q[:, 2], c, -s], [TURN * q[:, 1], s, c]]
    return np.array(rows).transpose(2, 0, 1)


def twist_jacobian(p: Floats) -> Any:
    n = len(p)
    return np.arange(n + 1), np.arange(n), twist_blocks(p), (n, n)


def twist(p: Floats) -> stiv.ObservedDeformation:
    return stiv.observed(twisted, twist_jacobian(p))


def dense_jacobian(f: stiv.Deformation, p: Floats) -> Floats:
    units = np.eye(3 * f.control_count).reshape(-1, f.control_count, 3)
    return np.stack([f.push_forward(p, unit).ravel() for unit in units], axis=1)


REST = SHEET.vertices + [0, 0, 0.4]
WEIGHTS = RANDOM.random((28, 5)) * (RANDOM.random((28, 5)) < 0.5)
SUBDIVISION, _ = stiv.catmull_clark(stiv.Cage.of_faces(grid(6, 3).faces), 1)
HANDLES = [0, 3, 24, 27]
COMPOSITIONS: dict[str, Callable[[], tuple[stiv.Deformation, Callable[[Floats], Floats], Floats]]] = {
    "alone": lambda: (twist(REST), twisted, REST),
    "subdivided": lambda: (
        stiv.compose(SUBDIVISION, twist(REST)),
        lambda p: SUBDIVISION.surface(twisted(p)),
        REST,
    ),
    "after linear": lambda: (
        stiv.compose(twist(WEIGHTS @ REST[:5]), stiv.linear(WEIGHTS)),
        lambda p: twisted(WEIGHTS @ p),
        REST[:5],
    ),
    "twice, subdivided": lambda: (
        stiv.compose(SUBDIVISION, twist(twisted(REST)), twist(REST)),
        lambda p: SUBDIVISION.surface(twisted(twisted(p))),
        REST,
    ),
    "after handles": lambda: (
        stiv.compose(SUBDIVISION, twist(REST), stiv.laplacian(REST, FACES, HANDLES)),
        lambda p: SUBDIVISION.surface(twisted(stiv.laplacian(REST, FACES, HANDLES).surface(p))),
        REST[HANDLES],
    ),
    "beside others": lambda: (
        stiv.concatenate([(stiv.identity(2), [28, 30]), (twist(REST), np.arange(28))], np.zeros((31, 3))),
        lambda p: np.vstack([twisted(p[2:]), p[0], np.zeros(3), p[1]]),
        np.vstack([np.ones((2, 3)), REST]),
    ),
}


@pytest.mark.parametrize("name", COMPOSITIONS)
def test_values_and_jacobians_against_the_function(name: str) -> None:
    deformation, function, p = COMPOSITIONS[name]()
    assert np.allclose(deformation.surface(p), function(p), atol=1e-13)
    d, g = RANDOM.normal(size=p.shape), RANDOM.normal(size=(deformation.vertex_count, 3))
    step = 1e-5
    velocity = (function(p + step * d) - function(p - step * d)) / (2 * step)
    assert np.abs(deformation.push_forward(p, d) - velocity).max() < 1e-7
    assert np.sum(deformation.pull_back(p, g) * d) == pytest.approx(np.sum(g * velocity), abs=1e-6)
    columns = np.abs(dense_jacobian(deformation, p)).reshape(-1, 3, len(p), 3).max(axis=(1, 3))
    for control in range(len(p)):
        assert set(np.flatnonzero(columns[:, control] > 1e-12)) <= set(deformation.support(control))


def test_every_format_of_a_jacobian_is_the_same() -> None:
    indptr, indices, blocks, (n, m) = twist_jacobian(REST)
    dense = np.zeros((n, 3, m, 3))
    dense[np.arange(n), :, np.arange(m), :] = blocks
    sparse = scipy.sparse.bsr_array((blocks, indices, indptr), shape=(3 * n, 3 * m))
    halves = (2 * np.arange(n + 1), np.repeat(indices, 2), np.repeat(blocks / 2, 2, axis=0), (n, m))
    d = RANDOM.normal(size=REST.shape)
    expected = np.einsum("nab,nb->na", blocks, d)
    for form in ((indptr, indices, blocks, (n, m)), dense, sparse, halves):
        assert np.allclose(stiv.observed(twisted, form).push_forward(REST, d), expected, atol=1e-14)
    for weights in (WEIGHTS, scipy.sparse.csr_array(WEIGHTS)):
        assert np.allclose(stiv.observed(twisted, weights).push_forward(REST[:5], d[:5]), WEIGHTS @ d[:5])


def inverse_metric(jacobian: Floats, g: Floats, weights: Floats, axes: Floats | None, smoothness: float) -> Floats:
    """The metric by its definition, with dense matrices; `weights` (m, 3)."""
    turn = np.eye(g.size)
    if axes is not None:
        turn = scipy.linalg.block_diag(*axes)
    free = weights.ravel() > 0
    gram = ((jacobian @ turn).T @ (jacobian @ turn))[np.ix_(free, free)]
    gram += smoothness * np.mean(np.diag(gram)) * np.eye(len(gram))
    root = np.sqrt(weights.ravel()[free])
    step = np.zeros(g.size)
    step[free] = root * np.linalg.solve(gram, root * (turn.T @ g.ravel())[free])
    return (turn @ step).reshape(-1, 3)


@pytest.mark.parametrize("name", ["alone", "subdivided", "after linear", "twice, subdivided"])
def test_the_metric_of_blocks_against_a_dense_one(name: str) -> None:
    deformation, _, p = COMPOSITIONS[name]()
    jacobian, g = dense_jacobian(deformation, p), RANDOM.normal(size=p.shape)
    weights = RANDOM.random(p.shape)
    weights[0] = weights[2, 1] = 0
    axes = np.linalg.qr(RANDOM.normal(size=(len(p), 3, 3)))[0]
    axes[:, :, 0] *= np.linalg.det(axes)[:, None]
    for of_each, along in ((np.ones(p.shape), None), (weights, None), (weights, axes)):
        expected = inverse_metric(jacobian, g, of_each, along, 0.05)
        given = {} if along is None else {"weight_axes": along}
        found = deformation.apply_inverse_metric(p, g, 0.05, of_each, **given)
        assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()


@pytest.mark.parametrize("reflect", [False, True])
def test_the_metric_of_many_controls_against_a_dense_one(reflect: bool) -> None:
    """Weights and reflections couple no axes; negligible entries are left out."""
    cage = grid(24, 24)
    subdivision, _ = stiv.catmull_clark(stiv.Cage.of_faces(cage.faces), 1)
    weights, _ = stiv.linear_weights(subdivision)
    p = cage.vertices
    if reflect:
        signs = np.where(weights.indices[:, None] % 2, [1.0, 1, 1], [-1, 1, 1])
        blocks = weights.data[:, None, None] * np.einsum("ka,ab->kab", signs, np.eye(3))
        jacobian: Any = (weights.indptr, weights.indices, blocks, weights.shape)
        matrix = scipy.sparse.bsr_array(
            (blocks, weights.indices, weights.indptr), shape=(3 * weights.shape[0], 3 * len(p))
        ).toarray()
    else:
        jacobian, matrix = weights, np.kron(weights.dense(), np.eye(3))
    g = np.zeros(p.shape)
    g[[300, 301]] = RANDOM.normal(size=(2, 3))
    of_each = np.ones(p.shape)
    of_each[305] = [0, 1, 0.5]
    found = stiv.observed(lambda q: q, jacobian).apply_inverse_metric(p, g, 0.1, of_each)
    expected = inverse_metric(matrix, g, of_each, None, 0.1)
    assert np.abs(found - expected).max() < 1e-2 * np.abs(expected).max()
    assert found[305, 0] == 0


class Counted:
    """A twist that records its calls and has no value where `limit` is exceeded."""

    def __init__(self, limit: float = np.inf) -> None:
        self.limit, self.calls, self.threads, self.values = limit, 0, set[int](), list[Floats]()

    def __call__(self, p: Floats) -> Floats | None:
        self.calls += 1
        self.threads.add(threading.get_ident())
        if p[:, 2].min() < -self.limit:
            return None
        q = twisted(p)
        self.values.append(q)
        return q


def over_a_wall(evaluate: Callable[[Floats], Floats | None], p: Floats = REST) -> tuple[stiv.Surface, Any, Floats]:
    """The twisted sheet above a fixed wall: surface, deformation, positions of the wall."""
    wall = triangulated(grid(4, 4, 6.0, 6.0)).vertices - [0, 0, 1.6]
    faces = np.vstack([FACES, np.array(triangulated(grid(4, 4)).faces) + len(p)])
    body = np.repeat([0, 1], [len(p), len(wall)]).astype(np.int32)
    surface = stiv.Surface(faces, len(body), vertex_body=body, bodies=[stiv.Body("sheet"), stiv.Body("wall", "fixed")])
    observed = stiv.observed(evaluate, twist_jacobian(p))
    whole = stiv.concatenate([(observed, np.arange(len(p)))], np.vstack([twisted(p), wall]))
    return surface, (whole, observed), wall


def check_accepted(surface: stiv.Surface, evaluate: Counted, wall: Floats, states: list[Floats]) -> None:
    """Every state is a value of the function, and the straight ways between them are free."""
    before: Floats | None = None
    for p in states:
        q = np.vstack([twisted(p), wall])
        assert any(np.array_equal(q[: len(p)], value) for value in evaluate.values)
        assert len(stiv.find_intersections(q, surface)) == 0
        if before is not None:
            found = find_contacts(surface.triangles, before, q, vertex_body=surface.vertex_body)
            assert not found.kind
        before = q


def test_a_twisted_sheet_dragged_into_a_wall() -> None:
    evaluate = Counted()
    surface, (whole, observed), wall = over_a_wall(evaluate)
    session = stiv.EditSession(surface, whole, REST)
    states, statuses = [REST], set()
    for step in np.linspace(0.2, 2.0, 6):
        result = session.drag(REST - [0, 0, step])
        states += result.path
        statuses.add(result.status)
        observed.set_jacobian(twist_jacobian(session.controls))
    assert "corrected" in statuses
    assert session.surface[: len(REST), 2].min() == pytest.approx(-1.6, abs=0.05)
    assert np.abs(session.controls - REST).max() > 0.5
    check_accepted(surface, evaluate, wall, states)
    assert evaluate.threads == {threading.get_ident()}


def test_a_jacobian_that_is_far_too_small_throws_nothing_away() -> None:
    """A tapered curve flew 100 units away from a wall, and came back beyond it."""
    surface, _, wall = over_a_wall(lambda p: p)
    observed = stiv.observed(lambda p: p, 0.01 * np.eye(len(REST)))
    whole = stiv.concatenate([(observed, np.arange(len(REST), dtype=np.int32))], np.concatenate([REST, wall]))
    session = stiv.EditSession(surface, whole, REST)
    for depth in (0.5, 1.5, 2.5):
        goal = REST - [0.3, 0, depth]
        session.drag(goal)
        assert np.abs(session.controls - goal).max() < 1


def test_the_last_value_is_stored() -> None:
    evaluate = Counted(limit=1.0)
    deformation = stiv.observed(evaluate, twist_jacobian(REST))
    for p in (REST, REST, REST - [0, 0, 3], REST - [0, 0, 3]):
        if p is REST:
            assert np.array_equal(deformation.surface(p), twisted(p))
        else:
            with pytest.raises(stiv.InfeasibleError, match="no surface at these controls"):
                deformation.surface(p)
    assert evaluate.calls == 2


@pytest.mark.parametrize("call", ["edit", "drag"])
def test_infeasible_controls_are_never_accepted(call: str) -> None:
    """The sheet has no value lower than a limit, before the wall or behind the contact with it."""
    for limit in (0.5, 1.2):
        evaluate = Counted(limit)
        surface, (whole, _), wall = over_a_wall(evaluate)
        session = stiv.EditSession(surface, whole, REST)
        result = getattr(session, call)(REST - [0, 0, 2.5])
        assert result.status == "blocked"
        assert result.counters["infeasible"] > 0
        assert -limit <= session.controls[:, 2].min() < 0.3
        check_accepted(surface, evaluate, wall, [REST, *result.path])
    with pytest.raises(stiv.InfeasibleError):
        session.restore(REST - [0, 0, 3])
    with pytest.raises(stiv.InfeasibleError):
        stiv.EditSession(surface, whole, REST - [0, 0, 3])
    session.restore(REST, REST - [0, 0, 3])
    assert np.array_equal(session.controls, REST)
    assert session.settle().status == "blocked"


def test_a_renewed_jacobian_is_that_of_the_next_edit() -> None:
    """A session whose Jacobian was replaced solves as a new one with that Jacobian."""
    goal = REST - [0, 0, 2.4]
    wrong = (*twist_jacobian(REST)[:2], np.tile(np.eye(3), (len(REST), 1, 1)), (len(REST), len(REST)))
    results = []
    for first, second in ((wrong, None), (wrong, twist_jacobian(REST)), (twist_jacobian(REST), None)):
        surface, (whole, observed), _ = over_a_wall(Counted())
        observed.set_jacobian(first)
        revision = observed.jacobian_revision
        session = stiv.EditSession(surface, whole, REST)
        if second is not None:
            observed.set_jacobian(second)
            assert observed.jacobian_revision == revision + 1
        results.append(session.edit(goal).controls)
    assert np.array_equal(results[1], results[2])
    assert not np.array_equal(results[0], results[2])


def drags(threads: int, as_jobs: bool) -> tuple[list[Floats], Counted]:
    evaluate = Counted(1.6)
    surface, (whole, _), _ = over_a_wall(evaluate)
    session = stiv.EditSession(surface, whole, REST, stiv.EditOptions(threads=threads))
    states = []
    for step in (0.6, 1.4, 2.2):
        goal = REST - [0, 0.1 * step, step]
        if as_jobs:
            job = session.start_drag(goal)
            while not job.poll().done:
                job.wait(0.001)
            states.append(job.result().controls)
        else:
            states.append(session.drag(goal).controls)
    return states, evaluate


def test_rotations_by_a_function_take_the_steps_of_a_rigid_body() -> None:
    rest = np.asarray(REST)
    body, start = stiv.rigid(rest), stiv.rigid_rest_controls(rest)
    goal = start + [[0, 0, 0], [0, 3.0, 0]]
    units = np.eye(6).reshape(6, 2, 3)
    jacobian = np.stack([body.push_forward(start, unit) for unit in units], axis=-1).reshape(len(rest), 3, 2, 3)
    paths = []
    for moving in (body, stiv.observed(body.surface, jacobian, [1])):
        assert moving.rotation_rows == [1]
        result = stiv.EditSession(stiv.Surface(FACES, len(rest)), moving, start).drag(goal)
        assert result.status == "reached"
        paths.append(np.array(result.path))
    assert len(paths[0]) >= 10 and np.array_equal(*paths) and np.allclose(paths[0][-1], goal, atol=1e-6)
    for rows in ([2], [-1], [1, 1], [1, 0]):
        with pytest.raises(stiv.InputError, match=r"rotation_rows: -?\d is not in ascending order"):
            stiv.observed(body.surface, jacobian, rows)


def test_jobs_and_threads_give_the_same_bits_with_calls_in_this_thread() -> None:
    expected, evaluate = drags(1, False)
    for threads, as_jobs in ((2, False), (1, True), (2, True)):
        found, other = drags(threads, as_jobs)
        assert np.array_equal(found, expected)
        assert other.threads == {threading.get_ident()}
        assert other.calls == evaluate.calls


def test_a_session_starts_as_a_job() -> None:
    evaluate = Counted()
    surface, (whole, _), _ = over_a_wall(evaluate)
    session = stiv.EditSession.start(surface, whole, REST).result()
    assert session.start_edit(REST - [0, 0, 2.4]).result().status == "corrected"
    assert evaluate.threads == {threading.get_ident()}


def test_jobs_that_wait_for_a_call_end_when_cancelled_or_dropped() -> None:
    evaluate = Counted()
    surface, (whole, _), _ = over_a_wall(evaluate)
    session = stiv.EditSession(surface, whole, REST)
    calls = evaluate.calls
    job = session.start_edit(REST - [0, 0, 2.4])
    time.sleep(0.02)  # it may have posted its first call
    job.cancel()
    assert job.result().status == "cancelled"
    job = session.start_edit(REST - [0, 0, 2.4])
    del job
    assert evaluate.calls == calls
    assert np.array_equal(session.controls, REST)
    assert session.edit(REST - [0, 0, 2.4]).status == "corrected"


def test_exceptions_of_the_function_end_the_edit_with_nothing_changed() -> None:
    def failing(p: Floats) -> Floats:
        if p[:, 2].min() < 0.3:
            raise KeyError("thrown by the function")
        return twisted(p)

    surface, (whole, _), _ = over_a_wall(failing)
    session = stiv.EditSession(surface, whole, REST)
    goal = REST - [0, 0, 2.4]
    with pytest.raises(KeyError, match="thrown by"):
        session.edit(goal)
    job = session.start_edit(goal)
    while not job.wait(0.01):
        job.poll()
    with pytest.raises(KeyError, match="thrown by"):
        job.result()
    assert np.array_equal(session.controls, REST)
    assert session.edit(REST - [0, 0, 0.05]).status == "reached"


def test_a_cancelled_edit_stops_between_two_evaluations() -> None:
    cancel, calls = stiv.CancelToken(), []

    def cancelling(p: Floats) -> Floats:
        calls.append(p)
        if len(calls) == 4:
            cancel.cancel()
        return twisted(p)

    surface, (whole, _), _ = over_a_wall(cancelling)
    session = stiv.EditSession(surface, whole, REST)
    assert session.edit(REST - [0, 0, 2.4], cancel=cancel).status == "cancelled"
    assert len(calls) == 4
    assert np.array_equal(session.controls, REST)


def nan_at_two(p: Floats) -> Floats:
    q = twisted(p)
    q[2, 1] = np.nan
    return q


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: stiv.observed(lambda p: p[:4], np.eye(5)).surface(REST[:5]), "result of evaluate: shape is"),
        (lambda: stiv.observed(lambda p: "no", np.eye(5)).surface(REST[:5]), "result of evaluate: dtype"),
        (lambda: stiv.observed(nan_at_two, np.eye(5)).surface(REST[:5]), "evaluate, vertex 2"),
        (lambda: twist(REST).surface(REST[:5]), "controls have 5 rows, the deformation has 28"),
        (lambda: stiv.observed(twisted, [[1, np.inf]]), "jacobian, row 0: a number is not finite"),
        (
            lambda: stiv.observed(twisted, ([0, 1], [1], np.full((1, 3, 3), np.nan), (1, 2))),
            "jacobian, row 0, control 1: a number is not finite",
        ),
        (lambda: stiv.observed(twisted, ([0, 1], [2], np.ones((1, 3, 3)), (1, 2))), "jacobian.indices, row 0: index 2"),
        (lambda: stiv.observed(twisted, ([0, 1], [0], np.ones((1, 2, 3)), (1, 1))), "jacobian.data: shape"),
        (lambda: stiv.observed(twisted, np.ones((2, 2, 1, 3))), "expected"),
        (lambda: twist(REST).set_jacobian(np.eye(5)), r"shape is \(5, 5\), expected \(28, 28\)"),
        (lambda: stiv.compose(twist(REST), stiv.rigid(REST)), "outer deformation must be linear or observed"),
        (lambda: stiv.compose(twist(REST), stiv.identity(3)), "outer deformation must be linear or observed"),
        (lambda: stiv.compose(twist(REST), stiv.linear(np.eye(3))), "28 controls, the inner one moves 3"),
    ],
)
def test_wrong_input_is_named(call: Callable[[], object], message: str) -> None:
    with pytest.raises(stiv.InputError, match=message):
        call()
