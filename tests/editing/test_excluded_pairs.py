# SPDX-License-Identifier: GPL-3.0-or-later
"""Intersecting starts with excluded pairs: their number never grows, and no other pair intersects."""

from __future__ import annotations

import numpy as np
import pytest
from oracles.parting import parting_motion

import stiv
from blend_fixtures.scenes.primitives import grid, icosphere, triangulated
from blend_fixtures.scenes.shape import joined


def spikes_through_sheet(seed: int) -> tuple[stiv.Surface, np.ndarray]:
    """A sheet, a ball that intersects it, and a second ball above: all deformable, every vertex a control."""
    turn = np.random.default_rng(seed).normal(size=3)
    shapes = [
        triangulated(grid(9, 9, 4, 4)),
        icosphere(1).turned(turn).scaled(0.6).moved((0.11, 0.07, 0.2)),
        icosphere(1).scaled(0.5).moved((1.0, 0.9, 1.0)),
    ]
    whole = joined(shapes)
    owner = np.repeat(np.arange(3), [len(shape.vertices) for shape in shapes])
    bodies = [stiv.Body("sheet"), stiv.Body("stuck"), stiv.Body("free")]
    surface = stiv.Surface(whole.triangles(), len(whole.vertices), vertex_body=owner, bodies=bodies)
    return surface, whole.vertices.astype(np.float32).astype(float)


def pairs_of(surface: stiv.Surface, q: np.ndarray) -> set[tuple[int, int]]:
    return set(map(tuple, stiv.find_intersections(q, surface).tolist()))


@pytest.mark.parametrize("seed", range(4))
def test_only_excluded_pairs_intersect_and_their_number_never_grows(seed: int) -> None:
    surface, start = spikes_through_sheet(seed)
    excluded = pairs_of(surface, start)
    assert len(excluded) > 10
    options = stiv.EditOptions(exclude="intersecting")
    session = stiv.EditSession(surface, stiv.identity(len(start)), start, options)
    chance = np.random.default_rng(seed)
    before, moved = excluded, 0
    for _ in range(8):
        goal = session.controls
        body = chance.integers(3)
        goal[surface.vertex_body == body] += chance.normal(scale=0.3, size=3)
        result = session.edit(goal + chance.normal(scale=0.01, size=goal.shape))
        after = pairs_of(surface, result.surface)
        assert after <= excluded
        assert len(after) <= len(before)
        moved += len(result.path)
        before = after
    assert moved > 0


def test_other_bodies_move_freely_and_stay_guarded() -> None:
    surface, start = spikes_through_sheet(1)
    session = stiv.EditSession(surface, stiv.identity(len(start)), start, stiv.EditOptions(exclude="intersecting"))
    free = surface.vertex_body == 2
    away = start + np.where(free[:, None], (0.3, 0.2, 0.4), 0.0)
    assert session.edit(away).status == "reached"
    through = session.controls - np.where(free[:, None], (0.0, 0.0, 3.0), 0.0)
    result = session.edit(through)
    assert result.status != "reached"
    owners = surface.vertex_body[surface.triangles[:, 0]]
    assert not any(2 in (owners[a], owners[b]) for a, b in pairs_of(surface, result.surface))


def test_all_bodies_may_move_together() -> None:
    surface, start = spikes_through_sheet(2)
    session = stiv.EditSession(surface, stiv.identity(len(start)), start, stiv.EditOptions(exclude="intersecting"))
    assert session.edit(start + [0.5, -0.25, 2.0]).status == "reached"


def test_a_tip_that_pierces_a_sheet_can_leave_but_not_return() -> None:
    """All triangles around the tip intersect the sheet, so the tip may leave. Afterwards its pairs are still
    excluded, but their number has fallen to zero and may not grow again.
    """
    sheet = np.array([[-1, -1, 0], [1, -1, 0], [0, 1.5, 0]], float)
    spike = np.array([[0, 0, -0.2], [0.1, 0, 1], [-0.1, 0.1, 1], [-0.1, -0.1, 1]], float)
    triangles = [[0, 1, 2], [3, 4, 5], [3, 5, 6], [3, 6, 4]]
    start = np.concatenate([sheet, spike]).astype(np.float32).astype(float)
    surface = stiv.Surface(
        triangles, 7, vertex_body=[0] * 3 + [1] * 4, bodies=[stiv.Body("sheet", "fixed"), stiv.Body("spike")]
    )
    weights = [0, 0, 0, 1, 1, 1, 1]
    options = stiv.EditOptions(exclude=[[0, 1], [0, 2], [3, 0]], weights=weights)
    session = stiv.EditSession(surface, stiv.identity(7), start, options)
    out = start + np.array([[0, 0, 0.5]]) * np.array(weights)[:, None]
    assert session.edit(out).status == "reached"
    assert len(stiv.find_intersections(session.surface, surface)) == 0
    back = session.edit(start)
    assert len(stiv.find_intersections(back.surface, surface)) == 0


def test_other_intersections_at_the_start_and_unknown_pairs_are_refused() -> None:
    surface, start = spikes_through_sheet(0)
    some = stiv.find_intersections(start, surface)[1:]
    with pytest.raises(stiv.StartIntersectsError):
        stiv.EditSession(surface, stiv.identity(len(start)), start, stiv.EditOptions(exclude=some))
    for wrong in ([[0, 0]], [[0, len(surface.triangles)]], [[0, 1, 2]], "all"):
        with pytest.raises(stiv.InputError, match="exclude"):
            stiv.EditSession(surface, stiv.identity(len(start)), start, stiv.EditOptions(exclude=wrong))


def test_one_and_two_threads_give_the_same_bits() -> None:
    surface, start = spikes_through_sheet(3)
    goal = start - np.where(surface.vertex_body[:, None] == 2, (0.3, 0.2, 3.0), 0.0)
    one, two = (
        stiv.edit(
            surface,
            stiv.identity(len(start)),
            start,
            goal,
            stiv.EditOptions(exclude="intersecting", threads=threads),
        )
        for threads in (1, 2)
    )
    assert one.controls.tobytes() == two.controls.tobytes()


def wedge_near_edge(distance: float) -> tuple[np.ndarray, np.ndarray]:
    """Triangles 2 and 3 share an edge, which pierces triangle 1 at this distance from its edge with 0. 2 misses 0."""
    sheet = np.array([[-1, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0]], float)
    wedge = np.array([[0, -1, distance - 1], [0, 1, distance + 1], [0.8, -0.3, 0.3], [-0.8, 0.3, -0.3]])
    triangles = np.array([[0, 1, 2], [1, 0, 3], [4, 5, 6], [5, 4, 7]])
    return triangles, np.concatenate([sheet, wedge]).astype(np.float32).astype(float)


@pytest.mark.parametrize("distance", [2.0**-22, 2.0**-10])
def test_an_intersection_passes_an_edge_only_if_it_touches_it(distance: float) -> None:
    """Coordinates near 1 are stored as multiples of 2**-24, so a motion cannot keep a distance of 2**-22."""
    triangles, start = wedge_near_edge(distance)
    at_start = set(map(tuple, stiv.find_intersections(start, triangles).tolist()))
    assert at_start == {(0, 3), (1, 2), (1, 3)}
    session = stiv.EditSession(triangles, stiv.identity(8), start, stiv.EditOptions(exclude="intersecting"))
    touches = distance < 1e-6
    assert set(map(tuple, session.excluded.tolist())) == at_start | ({(0, 2)} if touches else set())
    goal = start.copy()
    goal[4:, 1] += 0.05
    result = session.edit(goal)
    left = set(map(tuple, stiv.find_intersections(result.surface, triangles).tolist()))
    assert (result.status == "reached") == touches
    assert left == ({(0, 2), (0, 3), (1, 2)} if touches else at_start)


def layers_in_a_tilted_plane(seed: int, gap: float = 0.0) -> tuple[stiv.Surface, np.ndarray, np.ndarray]:
    """One body: a sheet, a patch on it, and two balls beside it that cut each other; flags of the patch's vertices.

    The plane is tilted, so that rounding puts the points of the patch on either side of the sheet.
    """
    turn = np.random.default_rng(seed).normal(size=3)
    shapes = [
        triangulated(grid(9, 9, 4, 4)),
        triangulated(grid(4, 4, 1.1, 1.3)).moved((0.13, 0.21, gap)),
        icosphere(1).scaled(0.4).moved((4.0, 0, 0)),
        icosphere(1).scaled(0.4).moved((4.3, 0.1, 0.2)),
    ]
    whole = joined([shape.turned(turn) for shape in shapes])
    part = np.repeat(np.arange(4), [len(shape.vertices) for shape in shapes])
    surface = stiv.Surface(whole.triangles(), len(whole.vertices))
    return surface, whole.vertices.astype(np.float32).astype(float), part == 1


@pytest.mark.parametrize("seed", range(5))
def test_faces_that_touch_do_not_keep_their_mesh_from_moving(seed: int) -> None:
    """Each motion rounds in another way, so the faces that touch intersect or part."""
    surface, start, _ = layers_in_a_tilted_plane(seed)
    session = stiv.EditSession(surface, stiv.identity(len(start)), start, stiv.EditOptions(exclude="intersecting"))
    excluded = set(map(tuple, session.excluded.tolist()))
    chance = np.random.default_rng(seed)
    changed = False
    for _ in range(10):
        goal = (start + chance.normal(size=3)).astype(np.float32).astype(float)
        assert session.edit(goal).status == "reached"
        after = pairs_of(surface, session.surface)
        assert after <= excluded
        changed |= after != pairs_of(surface, start)
    assert changed


@pytest.mark.parametrize("seed", range(3))
def test_faces_that_touch_are_not_pressed_through_each_other(seed: int) -> None:
    surface, start, patch = layers_in_a_tilted_plane(seed, gap=3e-7)
    normal = np.linalg.svd(start[:81] - start[:81].mean(axis=0))[2][2]
    normal *= np.sign((start[patch] - start[0]).mean(axis=0) @ normal)
    session = stiv.EditSession(surface, stiv.identity(len(start)), start, stiv.EditOptions(exclude="intersecting"))
    goal = start - np.where(patch[:, None], 0.3 * normal, 0.0)
    for _ in range(3):
        session.edit(goal)
        q = session.surface
        new = pairs_of(surface, q) - pairs_of(surface, start)
        assert all(parting_motion(*q[surface.triangles[list(pair)]]) < 1e-5 for pair in new)
        upper, lower = q[patch].mean(axis=0), q[:81][np.linalg.norm(q[:81] - q[patch].mean(axis=0), axis=1) < 0.6]
        assert (upper - lower.mean(axis=0)) @ normal > -0.02  # bent, but not below


@pytest.mark.parametrize("seed", range(8))
def test_faces_that_touch_are_the_same_beside_a_distant_body(seed: int) -> None:
    """Rounding decides which slivers intersect, so they must be examined where they are stored."""
    height = np.sort(np.random.default_rng(seed).uniform(0, 2, 9))
    line = np.column_stack([33.80755 + 2.1e-8 * height, -13.2 + 1e-8 * height, height])
    fan = np.array([(0, k, k + 1) for k in range(1, 8)])
    alone = stiv.EditSession(fan, stiv.identity(9), line, stiv.EditOptions(exclude="intersecting"))
    distant = np.vstack([line, np.eye(3) + 100.3])
    triangles, owner = np.vstack([fan, [(9, 10, 11)]]), np.repeat([0, 1], [9, 3])
    bodies = [stiv.Body("fan"), stiv.Body("distant", "fixed")]
    surface = stiv.Surface(triangles, 12, vertex_body=owner, bodies=bodies)
    both = stiv.EditSession(surface, stiv.identity(12), distant, stiv.EditOptions(exclude="intersecting"))
    assert both.excluded.tolist() == alone.excluded.tolist()
