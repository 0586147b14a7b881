# SPDX-License-Identifier: GPL-3.0-or-later
"""The least distance, against brute force."""

from __future__ import annotations

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes.primitives import grid, icosphere, torus, triangulated
from blend_fixtures.scenes.shape import joined
from tests.oracles.distances import near_pairs


def scene(seed: int) -> tuple[stiv.Surface, np.ndarray]:
    """Three bodies: a rotated ring around a ball, above a sheet."""
    chance = np.random.default_rng(seed)
    shapes = [
        icosphere(2).turned(chance.normal(size=3)).scaled(0.6),
        triangulated(torus(16, 8)).turned(chance.normal(size=3)).scaled(1.2),
        triangulated(grid(12, 12, 5, 5)).turned(chance.normal(size=3) / 10).moved((0, 0, -1.9)),
    ]
    whole = joined(shapes)
    owner = np.repeat(np.arange(3), [len(shape.vertices) for shape in shapes])
    bodies = [stiv.Body("ball"), stiv.Body("ring"), stiv.Body("sheet", "fixed")]
    return stiv.Surface(whole.triangles(), len(whole.vertices), vertex_body=owner, bodies=bodies), whole.vertices


def brute_force(surface: stiv.Surface, q: np.ndarray, reach: float, within: bool = False) -> float:
    body = surface.vertex_body
    return min(
        distance
        for (_, *v), distance in near_pairs(surface, q, reach).items()
        if body[v[0]] != body[v[3]] or (within and body[v[0]] != 2)
    )


@pytest.mark.parametrize("within", [False, True])
@pytest.mark.parametrize("seed", range(6))
def test_the_least_distance_is_the_minimum_over_all_pairs(seed: int, within: bool) -> None:
    surface, q = scene(seed)
    nearest = stiv.least_distance(q, surface, within=within)
    assert nearest is not None
    owners = [surface.bodies[surface.vertex_body[surface.triangles[k, 0]]].name for k in nearest.triangles]
    assert nearest.bodies == tuple(owners)
    if len(stiv.find_intersections(q, surface)) > 0 and not within:
        assert nearest.distance == 0
        return
    if nearest.distance == 0:
        assert list(nearest.triangles) in stiv.find_intersections(q, surface).tolist()
        return
    assert nearest.distance == pytest.approx(brute_force(surface, q, 1.01 * nearest.distance, within), rel=1e-9)
    assert np.linalg.norm(nearest.points[0] - nearest.points[1]) == pytest.approx(nearest.distance, rel=1e-9)
    for point, triangle in zip(nearest.points, nearest.triangles, strict=True):
        corners = q[surface.triangles[triangle]]
        weights = np.linalg.lstsq(np.vstack([corners.T, np.ones(3)]), np.append(point, 1), rcond=None)[0]
        assert (weights > -1e-9).all()
        assert weights @ corners == pytest.approx(point, abs=1e-9)


def test_a_session_measures_its_accepted_state_and_one_body_has_no_distance() -> None:
    surface, q = scene(1)
    session = stiv.EditSession(surface, stiv.identity(len(q)), q)
    before, again = session.least_distance(), stiv.least_distance(session.surface, surface)
    assert before is not None
    assert again is not None
    assert (before.distance, before.triangles) == (again.distance, again.triangles)
    session.edit(q + np.where(surface.vertex_body[:, None] == 2, (0, 0, -1.0), 0.0))
    after = session.least_distance()
    assert after is not None
    assert after.distance == pytest.approx(brute_force(surface, session.surface, 1.01 * after.distance), rel=1e-9)
    assert stiv.least_distance(np.eye(3), [[0, 1, 2]]) is None
    with pytest.raises(stiv.InputError, match="row 1"):
        stiv.least_distance([[0, 0, 0], [np.nan, 0, 0], [0, 1, 0]], [[0, 1, 2]])


def beside_sheet(surface: stiv.Surface, q: np.ndarray) -> tuple[stiv.Surface, stiv.Obstacle]:
    """The ball and the ring as a surface, the sheet as an obstacle."""
    owner = surface.vertex_body
    count, of_sheet = int((owner < 2).sum()), owner[surface.triangles[:, 0]] == 2
    bodies = [stiv.Body("ball"), stiv.Body("ring")]
    ours = stiv.Surface(surface.triangles[~of_sheet], count, vertex_body=owner[:count], bodies=bodies, ignored=[(0, 1)])
    return ours, stiv.Obstacle(q[count:], surface.triangles[of_sheet] - np.int32(count), "sheet")


@pytest.mark.parametrize("height", [0.0, -3.0, -40.0])
@pytest.mark.parametrize("seed", range(4))
def test_obstacles_count_however_far_they_are(seed: int, height: float) -> None:
    surface, q = scene(seed)
    q = q + np.where(surface.vertex_body[:, None] == 2, (0, 0, height), 0.0)
    ours, sheet = beside_sheet(surface, q)
    count = len(q) - sheet.vertex_count
    found = stiv.least_distance(q[:count], ours, obstacles=[sheet])
    joint = stiv.Surface(
        surface.triangles, len(q), vertex_body=surface.vertex_body, bodies=surface.bodies, ignored=[(0, 1)]
    )
    expected = stiv.least_distance(q, joint)
    assert found is not None and expected is not None and expected.bodies[1] == "sheet"
    assert (found.distance, found.bodies) == (expected.distance, expected.bodies)  # triangles may share the point
    q_of = [q[surface.triangles[k]] for k in found.triangles]  # those of the sheet follow in the joint surface too
    of_pair = stiv.least_distance(np.concatenate(q_of), [[0, 1, 2], [3, 4, 5]], within=True)
    assert of_pair is not None and of_pair.distance == found.distance
    session = stiv.EditSession(ours, stiv.identity(count), q[:count], obstacles=[sheet])
    again = session.least_distance()
    assert again is not None and again.distance == found.distance


@pytest.mark.parametrize("corners", [(0, 0, 0), (0, 60, 60)])
@pytest.mark.parametrize("seed", range(3))
def test_points_and_edges_of_obstacles_count_as_thin_triangles_do(seed: int, corners: tuple[int, int, int]) -> None:
    chance, ball = np.random.default_rng(seed), icosphere(2)
    points = chance.normal(size=(60, 3)) * 4 + (9.0, 0.0, 0.0)
    vertices = np.concatenate([points, points + chance.normal(size=(60, 3))])
    degenerate = np.arange(60, dtype=np.int32)[:, None] + np.array(corners, np.int32)
    thin, count = degenerate.copy(), len(vertices)
    thin[:, 1:] += np.array([count, 2 * count], np.int32)
    spread = np.concatenate([vertices, vertices + (1e-9, 0, 0), vertices + (0, 1e-9, 0)])
    found, expected = (
        stiv.least_distance(ball.vertices, ball.triangles(), obstacles=[stiv.Obstacle(*each)])
        for each in ((vertices, degenerate), (spread, thin))
    )
    assert found is not None and expected is not None
    assert found.distance == pytest.approx(expected.distance, abs=1e-8)
