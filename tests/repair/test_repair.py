# SPDX-License-Identifier: GPL-3.0-or-later
"""Repair, contraction, expansion and welding from Python, on the tangles of the scene library."""

from __future__ import annotations

import time

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes import tangled
from blend_fixtures.scenes.primitives import box, icosphere, triangulated
from blend_fixtures.scenes.tangled import Tangle

# The largest allowed deviation of each tangle, in diagonals. Two tubes of radius 0.32 whose axes are 0.45
# apart overlap by 0.19: flattening the legs alone where they overlap takes 0.012.
CASES = [
    (tangled.hairpin(0.25, rings=40, sides=8), 0.01),
    (tangled.hairpin(0.32, rings=40, sides=8), 0.015),
    (tangled.arm_in_body(levels=2), 0.01),
    (tangled.shirt_cut_by_torso(cuts=13, cells=28), 0.01),
]
IDS = [tangle.name for tangle, _ in CASES]


@pytest.fixture
def tube() -> Tangle:
    return tangled.hairpin(0.25, rings=40, sides=8)


def has_intersections(tangle: Tangle, positions: np.ndarray) -> bool:
    return len(stiv.find_intersections(positions, tangle.surface)) > 0


@pytest.mark.parametrize(("tangle", "share"), CASES, ids=IDS)
def test_tangles_are_repaired(tangle: Tangle, share: float) -> None:
    assert len(stiv.find_intersections(tangle.positions, tangle.surface)) > 60
    result = stiv.repair(tangle.surface, tangle.positions)
    assert result.status == "repaired"
    assert not has_intersections(tangle, result.positions)
    assert len(result.pairs) == 0 < result.pairs_before
    size = np.linalg.norm(np.ptp(tangle.positions, axis=0))
    assert np.abs(result.positions - result.positions.astype(np.float32)).max() < 1e-14 * size
    moved = np.sqrt(((result.positions - tangle.positions) ** 2).sum(axis=1).mean())
    assert moved / size == pytest.approx(result.deviation)
    assert result.deviation <= share


@pytest.mark.parametrize("scale", [1e-7, 1e7])
def test_repair_does_not_depend_on_size(tube: Tangle, scale: float) -> None:
    result = stiv.repair(tube.surface, scale * tube.positions)
    assert result.status == "repaired"
    assert result.deviation == pytest.approx(stiv.repair(tube.surface, tube.positions).deviation, rel=0.2)


def winding_numbers(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Winding number of triangles (F, 3, 3) around each point: solid angles by van Oosterom and Strackee."""
    a, b, c = (corners[None, :, k] - points[:, None] for k in range(3))
    length_a, length_b, length_c = (np.linalg.norm(side, axis=2) for side in (a, b, c))
    volume = (a * np.cross(b, c)).sum(axis=2)
    turned = (a * b).sum(axis=2) * length_c + (b * c).sum(axis=2) * length_a + (c * a).sum(axis=2) * length_b
    return np.arctan2(volume, length_a * length_b * length_c + turned).sum(axis=1) / (2 * np.pi)


def test_the_whole_shirt_ends_outside_the_torso() -> None:
    tangle = tangled.shirt_cut_by_torso(cuts=13, cells=28)
    result = stiv.repair(tangle.surface, tangle.positions)
    assert result.contracted == "torso"
    of_shirt = tangle.surface.vertex_body == 1
    torso = tangle.surface.triangles[~of_shirt[tangle.surface.triangles[:, 0]]]
    before, after = (winding_numbers(q[of_shirt], q[torso]) for q in (tangle.positions, result.positions))
    assert (before > 0.5).sum() > 100
    assert np.abs(after).max() < 1e-6


def test_coincident_spheres_are_refused_unchanged() -> None:
    tangle = tangled.coincident_spheres(levels=1)
    result = stiv.repair(tangle.surface, tangle.positions)
    assert (result.status, result.refusal) == ("refused", "coincident")
    assert "triangles coincide" in result.message
    assert np.array_equal(result.positions, tangle.positions)
    assert np.array_equal(result.pairs, stiv.find_intersections(tangle.positions, tangle.surface))


def test_remaining_intersections_are_reported_in_words(tube: Tangle) -> None:
    options = stiv.RepairOptions(contraction=stiv.ContractionOptions(max_steps=0))
    result = stiv.repair(tube.surface, tube.positions, options)
    assert result.status == "refused"
    assert f"the best leaves {result.fewest_pairs} pairs" in result.message
    assert np.array_equal(result.positions, tube.positions)


def test_a_mesh_with_open_seams_is_repaired_after_welding(tube: Tangle) -> None:
    seam = tube.surface.triangles.ravel()  # each triangle has its own corners
    loose, loose_positions = np.arange(len(seam)).reshape(-1, 3), tube.positions[seam]
    assert len(stiv.find_intersections(loose_positions, loose)) > len(tube.surface.edges)  # sides touch
    result = stiv.repair(loose, loose_positions, stiv.RepairOptions(weld=True))
    assert result.status == "repaired"
    assert result.surface.vertex_count == tube.surface.vertex_count
    assert len(stiv.find_intersections(result.positions, result.surface)) == 0
    moved = result.positions[result.vertex_map] - loose_positions
    assert np.linalg.norm(moved, axis=1).max() < 0.1 * np.linalg.norm(np.ptp(loose_positions, axis=0))


def test_only_movable_vertices_move(tube: Tangle) -> None:
    half = np.arange(len(tube.positions)) < len(tube.positions) // 2
    stored = tube.positions.astype(np.float32).astype(float)
    result = stiv.repair(tube.surface, stored, stiv.RepairOptions(moves=half))
    assert np.array_equal(result.positions[~half], stored[~half])
    assert has_intersections(tube, result.positions) == (result.status == "refused")


def test_progress_is_called_and_a_cancelled_repair_changes_nothing(tube: Tangle) -> None:
    token, phases = stiv.CancelToken(), set()

    def cancel_in_rounds(phase: str, fraction: float) -> None:
        phases.add(phase)
        assert 0 <= fraction <= 1
        if phase == "rounds":
            token.cancel()

    result = stiv.repair(tube.surface, tube.positions, cancel=token, progress=cancel_in_rounds)
    assert phases == {"contraction", "rounds"}
    assert result.status == "cancelled"
    assert np.array_equal(result.positions, tube.positions)
    assert len(result.pairs) == result.pairs_before


def test_a_time_budget_ends_a_repair(tube: Tangle) -> None:
    result = stiv.repair(tube.surface, tube.positions, stiv.RepairOptions(edit=stiv.EditOptions(time_budget=1e-9)))
    assert (result.status, result.out_of_time) == ("budget", True)
    assert result.message == "the time limit was too short"
    assert np.array_equal(result.positions, tube.positions)


@pytest.mark.parametrize("max_deviation", [0.0, 10.0])
def test_a_time_budget_that_ends_during_the_expansion_leaves_the_best_repair(
    tube: Tangle, max_deviation: float
) -> None:
    budget, begin, expansions = 3.0, time.monotonic(), 0

    def wait_in_second_round(phase: str, fraction: float) -> None:
        nonlocal expansions
        expansions += phase == "rounds"
        while expansions > 1 and time.monotonic() < begin + budget + 0.1:
            time.sleep(0.01)

    options = stiv.RepairOptions(edit=stiv.EditOptions(time_budget=budget), max_deviation=max_deviation)
    result = stiv.repair(tube.surface, tube.positions, options, progress=wait_in_second_round)
    assert result.out_of_time
    if max_deviation == 0:
        assert result.status == "budget"
        assert np.array_equal(result.positions, tube.positions)
    else:
        assert result.status == "repaired"
        assert result.message == "the time limit ended the repair; a longer one may come closer"
        assert not has_intersections(tube, result.positions)
        whole = stiv.repair(tube.surface, tube.positions)
        assert not whole.out_of_time
        assert whole.deviation <= result.deviation


def test_contracting_and_expanding_by_hand(tube: Tangle) -> None:
    contracted = stiv.contract(tube.surface, tube.positions)
    assert contracted.free
    assert contracted.pairs[0] > 0 == contracted.pairs[-1]
    assert not has_intersections(tube, contracted.positions)
    expanded = stiv.expand(tube.surface, contracted.positions, tube.positions)
    assert expanded.status == "corrected"
    assert not has_intersections(tube, expanded.surface)
    assert np.array_equal(expanded.surface, stiv.repair(tube.surface, tube.positions).positions)
    with pytest.raises(stiv.StartIntersectsError):
        stiv.expand(tube.surface, tube.positions, tube.positions)


def test_expansion_toward_another_shape() -> None:
    ball = icosphere(2)
    target = ball.vertices * (2, 1, 0.5)
    result = stiv.expand(ball.triangles(), ball.vertices, target)
    assert result.status == "reached"
    assert np.array_equal(result.surface, target.astype(np.float32))


def test_a_contraction_shrinks_gradually() -> None:
    ball = icosphere(2)
    positions, radius = ball.vertices, 1.0
    for step in range(4):
        positions = stiv.contraction_step(ball.triangles(), positions, start=ball.vertices, smoothing=2.0**step)
        assert np.linalg.norm(positions, axis=1).max() < radius
        radius = np.linalg.norm(positions, axis=1).max()
    still = np.arange(len(positions)) % 2 == 0
    moved = stiv.contraction_step(ball.triangles(), ball.vertices, moves=~still)
    assert np.array_equal((moved == ball.vertices).all(axis=1), still)


def test_a_cancelled_contraction_restores_the_start(tube: Tangle) -> None:
    token = stiv.CancelToken()
    token.cancel()
    result = stiv.contract(tube.surface, tube.positions, cancel=token)
    assert np.array_equal(result.positions, tube.positions)
    assert (result.free, result.pairs) == (False, [])


@pytest.mark.parametrize(
    ("moves", "smoothing"), [([True], 1.0), (np.ones(322), 1.0), (None, 0.0), (None, -1.0), (None, np.nan)]
)
def test_bad_arguments_of_a_contraction_are_refused(tube: Tangle, moves: object, smoothing: float) -> None:
    with pytest.raises(stiv.InputError):
        stiv.contraction_step(tube.surface, tube.positions, moves=moves, smoothing=smoothing)


def test_welding_closes_seams_and_keeps_bodies_apart() -> None:
    cube = triangulated(box(2))
    corners = cube.triangles().ravel()
    loose = np.arange(len(corners)).reshape(-1, 3)
    both = np.concatenate([cube.vertices[corners], cube.vertices[corners]])
    bodies = (stiv.Body("a"), stiv.Body("b"))
    surface = stiv.Surface(
        np.concatenate([loose, loose + len(corners)]),
        vertex_body=np.repeat([0, 1], len(corners)),
        bodies=bodies,
    )
    welded = stiv.weld(surface, both)
    assert welded.surface.vertex_count == 2 * len(cube.vertices)
    assert len(welded.surface.triangles) == len(surface.triangles)
    assert np.array_equal(welded.positions[welded.vertex_map], both)
    assert np.array_equal(welded.positions[welded.surface.triangles], both[surface.triangles])
    assert welded.surface.vertex_body.tolist() == [0] * len(cube.vertices) + [1] * len(cube.vertices)


def test_welding_drops_collapsed_and_duplicate_faces() -> None:
    positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, -0.0], [1, 0, 0], [2, 0, 0]]
    surface = stiv.Surface([[0, 1, 2], [3, 2, 4], [0, 3, 1], [2, 5, 1]], 6, [[0, 3], [3, 5], [0, 5]])
    welded = stiv.weld(surface, positions)
    assert welded.surface.triangles.tolist() == [[0, 1, 2], [2, 3, 1]]
    assert welded.surface.loose_edges.tolist() == [[0, 3]]
    assert welded.vertex_map.tolist() == [0, 1, 2, 0, 1, 3]


def test_a_time_budget_ends_a_contraction_with_the_steps_so_far(tube: Tangle) -> None:
    begin, budget, calls = time.monotonic(), 2.0, 0

    def wait_in_second_step(phase: str, fraction: float) -> None:
        nonlocal calls
        calls += 1
        while calls > 1 and time.monotonic() < begin + budget + 0.1:
            time.sleep(0.01)

    whole = stiv.contract(tube.surface, tube.positions)
    assert not whole.out_of_time and len(whole.pairs) > 2
    options = stiv.ContractionOptions(time_budget=budget)
    cut = stiv.contract(tube.surface, tube.positions, options, progress=wait_in_second_step)
    one = stiv.contract(tube.surface, tube.positions, stiv.ContractionOptions(max_steps=1))
    assert cut.out_of_time and not cut.free
    assert cut.pairs == whole.pairs[:2]
    assert np.array_equal(cut.positions, one.positions)
    none = stiv.contract(tube.surface, tube.positions, stiv.ContractionOptions(time_budget=1e-9))
    assert none.out_of_time and none.pairs == [] and np.array_equal(none.positions, tube.positions)
    for wrong in (-1.0, np.nan, np.inf):
        with pytest.raises(stiv.InputError, match="time_budget"):
            stiv.contract(tube.surface, tube.positions, stiv.ContractionOptions(time_budget=wrong))
