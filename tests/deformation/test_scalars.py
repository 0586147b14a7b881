# SPDX-License-Identifier: GPL-3.0-or-later
"""Scalars as controls: values, Jacobians, the metric in its own units, exact limits, steps along curved motions."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from numpy.typing import ArrayLike, NDArray

import stiv
from stiv.scalars import difference_jacobian_steps
from tests.examples import examples
from tests.oracles.path import find_contacts

Floats = NDArray[np.float64]
RANDOM = np.random.default_rng(11)
CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (-0.1, 0.1) for z in (-0.1, 0.1)], float)
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
BOX = np.array([[a, b, c] for a, b, c, _ in QUADS] + [[a, c, d] for a, _, c, d in QUADS])
START = np.array([0.1, -0.2, 1.0])
LOWER, UPPER = np.array([-3.0, -2.5, 0.5]), np.array([3.0, 2.5, 1.2])
STEP = np.array([0.2, 0.3, 0.25])


def turned(points: Floats, angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])


def arm(values: Floats) -> Floats:
    """Two bars: the angles of shoulder and elbow, and the length of the second one."""
    second = turned(CORNERS * [values[2], 1, 1] + [0, 0, 0.3], values[1]) + [1, 0, 0]
    return turned(np.vstack([CORNERS, second]), values[0])


def derivative(values: Floats, evaluate: Callable[[Floats], Any] = arm) -> Floats:
    return stiv.difference_jacobian(evaluate, values, 1e-6)


class Linkage:
    """The arm and a fixed post in its way."""

    def __init__(
        self, post: Floats, start: Floats = START, *, evaluate: Callable[[Floats], Any] = arm, **options: Any
    ) -> None:
        self.evaluate, self.post = evaluate, post
        limits = {"lower": LOWER, "upper": UPPER, "longest_step": STEP, **options.pop("limits", {})}
        self.deformation = stiv.scalars(evaluate, derivative(start, arm), **limits)
        body = np.repeat([0, 1, 2], 8)
        bodies = [stiv.Body("first"), stiv.Body("second"), stiv.Body("post", "fixed")]
        self.surface = stiv.Surface(np.vstack([BOX, BOX + 8, BOX + 16]), 24, vertex_body=body, bodies=bodies)
        whole = stiv.concatenate([(self.deformation, np.arange(16))], self.at(start))
        self.session = stiv.EditSession(self.surface, whole, self.controls(start), stiv.EditOptions(**options))

    def at(self, values: Floats) -> Floats:
        return np.vstack([arm(values), self.post])

    def controls(self, values: ArrayLike) -> Floats:
        return self.deformation.controls(values)

    @property
    def values(self) -> Floats:
        return self.deformation.values(self.session.controls)

    def renew(self) -> None:
        self.deformation.set_jacobian(derivative(self.values, arm))

    def check_path(self, before: Floats, path: list[Floats], lower: Floats = LOWER, upper: Floats = UPPER) -> None:
        """Limits hold exactly, steps are short, and the linear steps between states are free."""
        for controls in path:
            values = self.deformation.values(controls)
            assert (values >= lower).all() and (values <= upper).all()
            assert (values == values.astype(np.float32)).all()
            assert (controls[:, 1:] == 0).all()
            assert (np.abs(values - before) <= STEP * (1 + 1e-5)).all()
            found = find_contacts(
                self.surface.triangles, self.at(before), self.at(values), vertex_body=self.surface.vertex_body
            )
            assert not found.kind
            assert len(stiv.find_intersections(self.at(values), self.surface)) == 0
            before = values


POST = CORNERS * [0.2, 1, 10] + [0.9, 1.5, 0]


def test_values_and_jacobians_against_the_function() -> None:
    alone = stiv.scalars(arm, derivative(START))
    smooth = RANDOM.random((5, 16))
    chained = stiv.compose(stiv.linear(smooth), alone)
    beside = stiv.concatenate([(stiv.identity(1), [3]), (alone, np.arange(4, 20))], np.zeros((20, 3)))
    d, g = RANDOM.normal(size=3), RANDOM.normal(size=(16, 3))
    velocity = (arm(START + 1e-6 * d) - arm(START - 1e-6 * d)) / 2e-6
    p, motion = alone.controls(START), alone.controls(d)
    assert np.array_equal(alone.surface(p), arm(START))
    assert np.allclose(alone.push_forward(p, motion), velocity, atol=1e-7)
    assert np.sum(alone.pull_back(p, g) * motion) == pytest.approx(np.sum(g * velocity), abs=1e-6)
    assert np.allclose(chained.push_forward(p, motion), smooth @ velocity, atol=1e-6)
    both = beside.push_forward(np.vstack([[0, 0, 0], p]), np.vstack([[1, 2, 3], motion]))
    assert np.allclose(both[4:], velocity, atol=1e-7) and np.array_equal(both[3], [1, 2, 3])
    assert [alone.support(k) for k in range(3)] == [
        np.flatnonzero(np.abs(derivative(START)[:, :, k]).max(axis=1)).tolist() for k in range(3)
    ]
    assert alone.support(0) == list(range(16)) and beside.support(2) == list(range(12, 20))
    assert np.array_equal(alone.values(p), START)


@pytest.mark.parametrize("weights", [None, [0.3, 2, 1], [1, 0, 0.5]])
def test_the_metric_against_a_dense_one_and_in_any_unit(weights: list[float] | None) -> None:
    smooth = RANDOM.random((5, 16))
    of_each = np.ones(3) if weights is None else np.array(weights)
    given = {} if weights is None else {"weights": of_each}
    g = RANDOM.normal(size=3)
    for matrix in (np.eye(16), smooth):
        steps = []
        for unit in (np.ones(3), np.array([1, 180 / np.pi, 1000])):
            columns = derivative(START) / unit
            inner = stiv.scalars(lambda values, unit=unit: arm(values / unit), columns)
            whole = inner if len(matrix) == 16 else stiv.compose(stiv.linear(matrix), inner)
            step = whole.apply_inverse_metric(inner.controls(START * unit), inner.controls(g / unit), 0.05, **given)
            steps.append(step[:, 0] / unit)
            assert (step[:, 1:] == 0).all()
        flat = np.einsum("ij,jak->iak", matrix, derivative(START)).reshape(-1, 3)
        free = of_each > 0
        gram = (flat.T @ flat)[np.ix_(free, free)]
        gram += 0.05 * np.diag(np.diag(gram))
        expected = np.zeros(3)
        expected[free] = np.sqrt(of_each[free]) * np.linalg.solve(gram, np.sqrt(of_each[free]) * g[free])
        assert np.allclose(steps, expected, rtol=1e-9, atol=1e-12 * np.abs(expected).max())


@settings(max_examples=examples(25), deadline=None, phases=[Phase.generate])
@given(st.data())
def test_drags_of_linkages_keep_limits_steps_and_surfaces(data: st.DataObject) -> None:
    """Random posts, limits and goals: no state leaves the limits or intersects, and the path between is free."""
    number = st.floats(-1, 1, width=16)
    angle, distance = 2.5 * data.draw(number) + 1.2, 1.3 + 0.6 * data.draw(number)
    post = turned(CORNERS * [0.2, 2, 10] + [distance, 0, 0], angle + START[0])
    try:
        linkage = Linkage(
            post, weights=[data.draw(st.sampled_from([0, 0.2, 1])), 1, data.draw(st.sampled_from([0, 1]))]
        )
    except stiv.StartIntersectsError:
        return
    for _ in range(4):
        before = linkage.values
        goal = linkage.controls([3 * data.draw(number), 3 * data.draw(number), 0.9 + data.draw(number)])
        result = linkage.session.drag(goal) if data.draw(st.booleans()) else linkage.session.edit(goal)
        linkage.check_path(before, result.path)
        assert result.path == [] or np.array_equal(result.path[-1], result.controls)
        if result.status == "reached":
            assert np.allclose(linkage.values, goal[:, 0], atol=1e-6)
        linkage.renew()


def test_another_scalar_responds_where_one_is_at_its_limit() -> None:
    """A bar that grows toward a wall bends the elbow. Where the elbow is at its limit, the shoulder turns instead."""
    wall = CORNERS * [1, 40, 10] + [2.05, 0, 0]
    ends = []
    for lowest in (-2.5, -0.3):
        linkage = Linkage(wall, np.array([0.1, -0.2, 0.9]), weights=[1, 1, 0], limits={"lower": [-3, lowest, 0.2]})
        for length in np.linspace(0.9, 1.2, 7):
            before = linkage.values
            result = linkage.session.drag(linkage.controls([0.1, -0.2, length]))
            linkage.check_path(before, result.path, np.array([-3, lowest, 0.2]))
            linkage.renew()
        assert result.status == "corrected"
        ends.append(linkage.values)
    (shoulder, elbow, _), limited = ends
    assert elbow < -0.6
    assert limited[1] == np.nextafter(np.float32(-0.3), np.float32(0))
    assert limited[0] > shoulder + 0.1
    assert limited[2] > 1.15


def test_goals_beyond_the_limits_end_at_them() -> None:
    far = POST + [50, 0, 0]
    linkage = Linkage(far, limits={"upper": [0.7, 2.5, 1.1], "longest_step": None})
    result = linkage.session.edit(linkage.controls([2, 1, 5]))
    single = np.float32([0.7, 1, 1.1])
    inward = np.where(single > [0.7, 1, 1.1], np.nextafter(single, np.float32(0)), single)
    assert result.status == "corrected"
    assert np.array_equal(linkage.values, inward) and (linkage.values <= [0.7, 1, 1.1]).all()
    in_doubles = Linkage(far, limits={"upper": [0.7, 2.5, 1.1], "longest_step": None}, single_precision=False)
    in_doubles.session.edit(linkage.controls([2, 1, 5]))
    assert in_doubles.values.tolist() == [0.7, 1, 1.1]
    fixed = Linkage(far, limits={"lower": [-3, -0.2, 0.5], "upper": [3, -0.2, 2]})
    fixed.session.edit(linkage.controls([1, 1, 1]))
    assert fixed.values[1] == -0.2
    beside = linkage.controls([0.3, 0, 1]) + [0, 1, 2]
    linkage.session.edit(beside)
    assert (linkage.session.controls[:, 1:] == 0).all()


def test_steps_follow_a_turn_that_its_chord_avoids() -> None:
    """A bar turned by 170 degrees: the straight way of its vertices passes below a post that the bar hits."""
    post = CORNERS * [0.1, 1, 10] + [-0.05, 0.85, 0]
    goal = START + [2.9, 0, 0]
    reached = {}
    for longest in (None, STEP):
        linkage = Linkage(post, limits={"longest_step": longest, "lower": -4, "upper": 4}, weights=[1, 0, 0])
        reached[longest is None] = linkage.session.edit(linkage.controls(goal)).status, linkage.values
        if longest is None:
            continue
        linkage.check_path(START, linkage.session.edit(linkage.controls(START)).path[:0])
    assert reached[True][0] == "reached"
    assert reached[False][0] != "reached" and reached[False][1][0] < 1.6


def test_the_true_motion_between_accepted_states_is_free_too() -> None:
    """With steps of 0.05 and a separation of the size of their chords' heights, f of every value between is free."""
    small = np.array([0.05, 0.05, 0.05])
    linkage = Linkage(POST, separation=2e-3, limits={"longest_step": small})
    path = [START]
    for angle in np.linspace(0.1, 1.8, 9):
        path += [linkage.deformation.values(p) for p in linkage.session.drag(linkage.controls([angle, 0, 1])).path]
        linkage.renew()
    assert len(path) > 20
    for before, after in itertools.pairwise(path):
        assert (np.abs(after - before) <= small * (1 + 1e-5)).all()
        for part in np.linspace(0, 1, 5):
            q = linkage.at(before + part * (after - before))
            assert len(stiv.find_intersections(q, linkage.surface)) == 0


def test_values_without_a_surface_are_never_accepted() -> None:
    def until_half(values: Floats) -> Floats | None:
        return None if values[0] > 0.5 else arm(values)

    linkage = Linkage(POST, evaluate=until_half)
    result = linkage.session.edit(linkage.controls([1.0, 0, 1]))
    assert result.status == "blocked" and result.counters["infeasible"] > 0
    assert 0.4 < linkage.values[0] <= 0.5


def test_jobs_and_threads_give_the_same_bits() -> None:
    found = []
    for threads, as_job in ((1, False), (2, False), (2, True)):
        linkage = Linkage(POST, threads=threads)
        goal = linkage.controls([1.2, 0, 1])
        result = linkage.session.start_drag(goal).result() if as_job else linkage.session.drag(goal)
        found.append(result.controls)
    assert np.array_equal(found[0], found[1]) and np.array_equal(found[0], found[2])


def test_differences_at_limits_and_beside_missing_surfaces() -> None:
    exact = derivative(START)
    clamped = stiv.difference_jacobian(lambda v: arm(np.clip(v, START, UPPER)), START, 1e-6, lower=START, upper=UPPER)
    assert np.allclose(clamped, exact, atol=1e-5)
    halved = stiv.difference_jacobian(lambda v: arm(np.clip(v, START, UPPER)), START, 1e-6)
    assert np.allclose(halved, exact / 2, atol=1e-5)
    one_side = stiv.difference_jacobian(lambda v: None if (v > START).any() else arm(v), START, 1e-6)
    assert np.allclose(one_side, exact, atol=1e-5)
    nowhere = stiv.difference_jacobian(lambda v: arm(v) if (v == START).all() else None, START, [1e-6, 1e-6, 1e-6])
    assert (nowhere == 0).all() and nowhere.shape == (16, 3, 3)


def test_the_steps_of_differences_give_a_turn_after_each_surface() -> None:
    calls: list[Floats] = []

    def noted(values: Floats) -> Floats:
        calls.append(values)
        return arm(values)

    steps, turns = difference_jacobian_steps(noted, START, 1e-6), 0
    while True:
        try:
            assert next(steps) is None
        except StopIteration as end:
            assert np.allclose(end.value, derivative(START), atol=1e-5)
            break
        turns += 1
        assert len(calls) == turns
    assert turns == 1 + 2 * len(START)


def start_at(values: ArrayLike, **options: Any) -> stiv.EditSession:
    return Linkage(POST, np.array(values, float), **options).session


FRAMES = [stiv.StorageFrame(0, 3, np.diag([2.0, 2, 2, 1]))]
ONE = np.ones((2, 3, 1))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: start_at([0, 0, 1.3]), "control 2: 1.3 is outside its limits 0.5 to 1.2"),
        (lambda: start_at([0, 0, 1], storage=FRAMES), "control 0 is a scalar: its storage frame must be the identity"),
        (lambda: start_at(START).restore([[0, 0, 0], [0, 1, 0], [1, 0, 0]]), "control 1 is a scalar: its second"),
        (lambda: start_at(START).restore([[3.5, 0, 0], [0, 0, 0], [1, 0, 0]]), "control 0: 3.5 is outside"),
        (lambda: start_at(START).edit([[np.nan, 0, 0], [0, 0, 0], [1, 0, 0]]), "control 0: coordinate is not finite"),
        (lambda: stiv.scalars(arm, ONE, lower=[1], upper=[0]), "scalar 0: its limits 1.0+ to 0.0+ contain no number"),
        (lambda: stiv.scalars(arm, ONE, lower=[np.nan]), "scalar 0: its limits nan"),
        (lambda: stiv.scalars(arm, ONE, longest_step=0), "scalar 0: longest_step must be positive"),
        (lambda: stiv.scalars(arm, ONE, upper=[1, 2]), r"upper: shape is \(2,\), expected \(1,\)"),
        (lambda: stiv.scalars(arm, np.full((2, 3, 1), np.inf)), "jacobian, vertex 0: a number is not finite"),
        (lambda: stiv.scalars(arm, np.ones((2, 2, 1))), r"jacobian: shape is \(2, 2, 1\), expected \(any, 3, any\)"),
        (
            lambda: stiv.scalars(arm, ONE).set_jacobian(np.ones((3, 3, 1))),
            r"shape is \(3, 3, 1\), expected \(2, 3, 1\)",
        ),
        (lambda: stiv.scalars(lambda v: np.zeros((3, 3)), ONE).surface([[0, 0, 0]]), "result of evaluate: shape"),
        (lambda: stiv.scalars(arm, ONE).controls([1, 2]), r"values: shape is \(2,\), expected \(1,\)"),
        (lambda: stiv.difference_jacobian(lambda v: None, [1.0]), "values: evaluate has no surface there"),
        (lambda: stiv.compose(stiv.scalars(arm, ONE), stiv.identity(1)), "outer deformation must be linear"),
    ],
)
def test_wrong_input_is_named(call: Callable[[], object], message: str) -> None:
    with pytest.raises(stiv.InputError, match=message):
        call()
