# SPDX-License-Identifier: GPL-3.0-or-later
"""Events of whole surfaces: the broad phases agree with each other and with single pairs."""

import threading
from collections.abc import Callable
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stiv
from blend_fixtures.scenes.detection_steps import pressed_inside
from tests.examples import examples
from tests.oracles.first_contact import WIDTH, first_contact


def soup(seed: int, triangles: int, size: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Small random triangles, some with shared vertices, and random motion of half of the vertices."""
    random = np.random.default_rng(seed)
    centres = random.random((triangles, 1, 3))
    start = (centres + size * (random.random((triangles, 3, 3)) - 0.5)).reshape(-1, 3)
    corners = np.arange(3 * triangles).reshape(-1, 3)
    corners[1::4, 0] = corners[0::4, 2][: len(corners[1::4])]
    end = start + np.where(random.random((len(start), 1)) < 0.5, size, 0) * (random.random(start.shape) - 0.5)
    return corners, start, end


def assert_same(a: stiv.Events, b: stiv.Events) -> None:
    for name in ("kind", "vertices", "time", "weights", "normal", "start_distance"):
        assert np.array_equal(getattr(a, name), getattr(b, name)), name


@settings(max_examples=examples(20), deadline=None, derandomize=True)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 0.003, 0.05]), st.sampled_from([0.1, 0.4, 1.0]))
def test_broad_phases_and_threads_agree(seed: int, separation: float, size: float) -> None:
    corners, start, end = soup(seed, 60, size)
    expected = stiv.find_interference(corners, start, end, separation, "brute_force", threads=1)
    for threads in (1, 2, 3):
        assert_same(stiv.find_interference(corners, start, end, separation, threads=threads), expected)
    times = expected.time
    earliest = stiv.Detector(corners, threads=2).earliest_time(start, end, separation)
    assert earliest == (times.min() if len(times) else np.inf)


def all_pairs(corners: np.ndarray) -> list[tuple[int, tuple[int, ...]]]:
    edges = sorted({tuple(sorted((int(face[k]), int(face[k - 1])))) for face in corners for k in range(3)})
    faces = [(0, (v, *map(int, face))) for v in range(int(corners.max()) + 1) for face in corners]
    pairs = faces + [(1, a + b) for a, b in combinations(edges, 2)]
    return [(kind, v) for kind, v in pairs if len(set(v)) == 4]


def test_events_are_the_pairs_that_collide() -> None:
    corners, start, end = soup(3, 16, 1.2)
    events = stiv.find_interference(corners, start, end, separation=0)
    found = {
        (int(kind), tuple(v)): time for kind, v, time in zip(events.kind, events.vertices, events.time, strict=True)
    }
    pairs = all_pairs(corners)
    for kind, name in enumerate(("vf", "ee")):
        rows = np.array([v for k, v in pairs if k == kind])
        times = stiv.time_of_impact(name, start[rows], end[rows])
        expected = {(kind, tuple(v)): t for v, t in zip(rows, times, strict=True) if np.isfinite(t)}
        assert {pair: t for pair, t in found.items() if pair[0] == kind} == expected
    assert len(found) > 20 and {kind for kind, _ in found} == {0, 1}


def test_grazing_pairs_are_reported_only_if_they_collide() -> None:
    # Edges of a smooth body with two triangulations almost touch: 180 of these events were near misses.
    step = pressed_inside(16, 5)
    events = stiv.find_interference(step.triangles, step.start, step.end, separation=0)
    assert len(events) > 500
    for kind, v, time in zip(events.kind_names, events.vertices, events.time, strict=True):
        truth = first_contact(kind, step.start[v].tolist(), step.end[v].tolist())
        assert truth is not None and time <= truth + WIDTH


def test_events_describe_the_contact() -> None:
    corners, start, end = soup(5, 40, 0.5)
    events = stiv.find_interference(corners, start, end, separation=0.01)
    assert len(events) > 20 and set(events.kind_names) == {"vf", "ee"}
    t = events.time[:, None, None]
    x = (1 - t) * start[events.vertices] + t * end[events.vertices]
    separation = np.einsum("kv,kvi->ki", events.weights, x)
    approach = np.einsum("kv,kvi,ki->k", events.weights, (end - start)[events.vertices], events.normal)
    threshold = np.where(events.start_distance < 0.01, 0.5 * events.start_distance, 0.01)
    assert np.allclose(events.weights.sum(1), 0, atol=1e-15)
    assert np.allclose(np.linalg.norm(separation, axis=1), threshold, rtol=1.1e-3, atol=1e-12)
    assert np.allclose(np.linalg.norm(events.normal, axis=1), 1)
    assert np.all(np.einsum("ki,ki->k", separation, events.normal) > 0) and np.all(approach <= 0)
    order = np.lexsort((*events.vertices.T[::-1], events.kind))
    assert np.array_equal(order, np.arange(len(events)))


def misaligned(array: np.ndarray) -> np.ndarray:
    """The same numbers at unaligned addresses."""
    found = np.frombuffer(bytes(4) + array.tobytes(), np.float64, offset=4).reshape(array.shape)
    assert not found.flags.aligned
    return found


LAYOUTS = {
    "columns first": np.asfortranarray,
    "a transpose": lambda array: np.ascontiguousarray(array.T).T,
    "with gaps between rows": lambda array: np.hstack([array, array])[:, :3],
    "every second row": lambda array: np.repeat(array, 2, axis=0)[::2],
    "backwards": lambda array: array[::-1].copy()[::-1],
    "single precision": lambda array: array.astype(np.float32),
    "other byte order": lambda array: array.astype(array.dtype.newbyteorder()),
    "misaligned": misaligned,
    "lists": lambda array: array.tolist(),
}


@pytest.mark.parametrize("laid_out", LAYOUTS.values(), ids=LAYOUTS.keys())
@pytest.mark.parametrize("threads", [1, 2])
def test_arrays_may_have_any_layout_and_are_not_changed(laid_out: Callable, threads: int) -> None:
    corners, *both = soup(7, 60, 0.4)
    start, end = (array.astype(np.float32).astype(float) for array in both)  # values that every layout can represent
    expected = stiv.find_interference(corners, start, end, 0.01, "brute_force")
    given = [laid_out(start), laid_out(end)]
    before = [np.array(array).tobytes() for array in given]
    for array in given:
        if isinstance(array, np.ndarray):
            array.flags.writeable = False
    detector = stiv.Detector(corners, threads=threads)
    for _ in range(2):  # the second search finds everything unchanged
        assert_same(detector.find(*given, 0.01), expected)
        assert detector.earliest_time(*given, 0.01) == expected.time.min()
    assert [np.array(array).tobytes() for array in given] == before


def test_a_detector_sees_changes_of_an_array_since_its_last_call() -> None:
    corners, start, end = soup(8, 60, 0.4)
    detector = stiv.Detector(corners)
    given = end.copy()
    for share in (1.0, 0.5, 1.0, 0.0):
        given[:] = start + share * (end - start)
        assert_same(detector.find(start, given, 0.01), stiv.Detector(corners).find(start, given.copy(), 0.01))


def test_bodies_loose_edges_and_loose_vertices() -> None:
    start = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0.2, 1], [1, 0.2, 1], [0.2, 0.2, 1]], float)
    end = start.copy()
    end[3:, 2] = -1
    plain = stiv.find_interference([[0, 1, 2]], start, end)
    assert sorted(plain.vertices[:, 0]) == [3, 4, 5][2:]
    surface = stiv.Surface([[0, 1, 2]], 6, loose_edges=[[3, 4]])
    events = stiv.Detector(surface).find(start, end)
    assert [tuple(v) for v in events.vertices] == [(5, 0, 1, 2), (0, 2, 3, 4), (1, 2, 3, 4)]
    bodies = [stiv.Body("face", "fixed"), stiv.Body("edge")]
    apart = stiv.Surface([[0, 1, 2]], 6, [[3, 4]], [0, 0, 0, 1, 1, 1], bodies, ignored=[(0, 1)])
    assert len(stiv.Detector(apart).find(start, end)) == 0


def test_common_motion_gives_no_event() -> None:
    corners, start, _ = soup(9, 60, 0.4)
    start = start.astype(np.float32).astype(float)
    for shift in ([1, 0, 0], [0.1, -7.3, 1e3]):
        assert len(stiv.find_interference(corners, start, start + np.array(shift), separation=0.02)) == 0


@pytest.mark.parametrize("separation", [0.0, 0.1])
@pytest.mark.parametrize("narrow_phase", ["conservative", "polynomial"])
def test_a_flat_mesh_that_turns_in_its_plane_has_no_event(separation: float, narrow_phase: str) -> None:
    size = 40
    x, y = np.meshgrid(np.arange(size, dtype=float), np.arange(size, dtype=float), indexing="ij")
    start = np.column_stack([x.ravel(), y.ravel(), np.zeros(size * size)])
    corner = (np.arange(size - 1)[:, None] * size + np.arange(size - 1)).ravel()
    triangles = np.concatenate([corner[:, None] + [0, size, size + 1], corner[:, None] + [0, size + 1, 1]])
    turn = np.array([[np.cos(0.01), np.sin(0.01), 0], [-np.sin(0.01), np.cos(0.01), 0], [0, 0, 1]])
    aslant = np.array([[2, 2, 1], [-2, 1, 2], [1, -2, 2]]) / 3
    for frame in (np.eye(3), aslant):
        events = stiv.Detector(triangles, narrow_phase=narrow_phase).find(
            start @ frame, start @ turn @ frame, separation
        )
        assert len(events) == 0


def test_a_detector_is_used_by_one_thread_at_a_time() -> None:
    corners, start, end = soup(11, 300, 0.5)
    detector = stiv.Detector(corners, broad_phase="brute_force", threads=1)
    outcomes: list[object] = []

    def use() -> None:
        try:
            outcomes.append(len(detector.find(start, end)))
        except stiv.InputError as error:
            outcomes.append(str(error))

    threads = [threading.Thread(target=use) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    counts = {outcome for outcome in outcomes if isinstance(outcome, int)}
    assert counts == {len(stiv.find_interference(corners, start, end))}
    assert all("in use" in str(outcome) for outcome in outcomes if not isinstance(outcome, int))


@pytest.mark.parametrize("broad_phase", ["bvh", "hash_grid", "brute_force"])
@pytest.mark.parametrize("asked", ["find", "earliest_time"])
def test_non_finite_values_in_a_later_step_are_named_and_change_nothing(broad_phase: str, asked: str) -> None:
    triangles, start, end = soup(0, 60, 0.4)
    detector = stiv.Detector(triangles, broad_phase=broad_phase)
    before = detector.find(start, end)
    for wrong, name in ((np.nan, "start"), (np.inf, "end")):
        step = {"start": start.copy(), "end": end.copy()}
        step[name][3, 1] = wrong
        with pytest.raises(stiv.InputError, match=f"{name}, row 3: a number is not finite"):
            getattr(detector, asked)(**step)
        assert len(before) > 0
        assert_same(detector.find(start, end), before)


SHAPE = np.zeros((4, 3))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: stiv.find_interference([[0, 1, 4]], SHAPE, SHAPE), "face 0: vertex index 4 is out of range 0..3"),
        (lambda: stiv.find_interference([[0, 1, -1]], SHAPE, SHAPE), "triangles, row 0: index -1 is out of range"),
        (lambda: stiv.find_interference([[0, 1, 2.5]], SHAPE, SHAPE), "triangles: dtype is float64"),
        (lambda: stiv.find_interference([[0, 1]], SHAPE, SHAPE), "triangles: shape is"),
        (lambda: stiv.find_interference([[0, 1, 2]], SHAPE, SHAPE[:3]), "end: shape is"),
        (lambda: stiv.find_interference([[0, 1, 2]], SHAPE + np.inf, SHAPE), "start, row 0: a number is not finite"),
        (
            lambda: stiv.find_interference([[0, 1, 2]], SHAPE, SHAPE, broad_phase="octree"),
            "'bvh', 'hash_grid', 'brute_force'",
        ),
        (lambda: stiv.Detector([[0, 1, 2]], narrow_phase="cubic"), "'cubic' is none of 'conservative', 'polynomial'"),
        (lambda: stiv.Detector([[0, 1, 2]], threads=-1), "threads: expected a non-negative integer"),
        (lambda: stiv.Detector([[0, 1, 2]]).find(SHAPE, SHAPE, 0, 1), "min_clearance_ratio"),
        (lambda: stiv.Detector(stiv.Surface([[0, 1, 2]], 3)).find(SHAPE, SHAPE), "start: shape is"),
        (lambda: stiv.Surface([[0, 1, 2]], vertex_body=[0, 0, 1]), "vertex_body, row 2: index 1 is out of range"),
        (lambda: stiv.Surface([[0, 1, 2]], bodies=[stiv.Body("a", "soft")]), 'not "soft"'),
    ],
)
def test_bad_input_is_named(call: object, message: str) -> None:
    with pytest.raises(stiv.InputError, match=message.replace("(", r"\(")):
        call()  # type: ignore[operator]


def cube_beside_wall() -> tuple[np.ndarray, np.ndarray]:
    """Triangles and vertices of a cube of edge 1 around the origin, and of a wall at x = 2."""
    corners = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3), (8, 9, 10, 11)]
    triangles = np.array([triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))])
    return triangles, np.vstack([corners, [(2, -3, -3), (2, 3, -3), (2, 3, 3), (2, -3, 3)]])


@pytest.mark.parametrize("exponent", [3, 9, 13, 14, 14.5, 15, 15.3, 16, 20, 30, 60])
@pytest.mark.parametrize("separation", [0.0, 1e-3])
def test_contacts_of_steps_far_longer_than_their_start_are_found(exponent: float, separation: float) -> None:
    """The rounding error of the step exceeds the distance at the start, so that doubles do not know the side there."""
    triangles, start = cube_beside_wall()
    end = start.copy()
    end[:8, 0] += 10.0**exponent
    events = stiv.Detector(triangles).find(start, end, separation)
    assert len(events) and not stiv.is_step_free(triangles, start, end, separation)
    if exponent <= 15:  # beyond, the cube is flat in the end
        assert events.time.min() == pytest.approx((1.5 - separation) * 10.0**-exponent, rel=0.02)
        end[:8, 0] = start[:8, 0] - 10.0**exponent
        assert stiv.is_step_free(triangles, start, end, separation)
