# SPDX-License-Identifier: GPL-3.0-or-later
"""The least translation that parts bodies, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes.primitives import box, icosphere, triangulated
from blend_fixtures.scenes.shape import joined
from stiv import separating
from stiv.separating import find_separation, find_separation_steps
from stiv.task import Task


def two(first, second) -> tuple[stiv.Surface, np.ndarray, np.ndarray]:
    """Two bodies, of which the second moves."""
    whole = joined([first, second])
    owner = np.repeat([0, 1], [len(first.vertices), len(second.vertices)])
    bodies = [stiv.Body("rest", "fixed"), stiv.Body("moving", "rigid")]
    surface = stiv.Surface(whole.triangles(), len(whole.vertices), vertex_body=owner, bodies=bodies)
    return surface, whole.vertices, owner == 1


def clear_after(surface: stiv.Surface, q: np.ndarray, moving: np.ndarray, translation: np.ndarray) -> bool:
    return len(stiv.find_intersections(q + np.where(moving[:, None], translation, 0.0), surface)) == 0


@pytest.mark.parametrize("offset", [(1.3, 0.2, 0.1), (0.4, -0.3, 1.5), (0.2, 0.1, 0.0)])
def test_balls_part_along_the_line_of_their_centres(offset: tuple[float, float, float]) -> None:
    ball = icosphere(3)
    surface, q, moving = two(ball, ball.moved(offset))
    found = find_separation(surface, q, moving)
    least = 2 - float(np.linalg.norm(offset))
    assert 0.97 * least <= np.linalg.norm(found) <= 1.02 * least
    assert clear_after(surface, q, moving, found)


@pytest.mark.parametrize(("offset", "least"), [((1.7, 0.4, 0.2), 0.3), ((0.3, -0.2, -1.9), 0.1), ((0, 0, 0.5), 1.5)])
def test_boxes_part_through_the_nearest_face(offset: tuple[float, float, float], least: float) -> None:
    cube = triangulated(box(2))
    surface, q, moving = two(cube, cube.scaled(1 + 1e-9).moved(offset))
    found = find_separation(surface, q, moving)
    assert np.linalg.norm(found) == pytest.approx(least, rel=2e-3)
    assert clear_after(surface, q, moving, found)


def test_a_small_ball_in_the_wall_of_a_large_one_leaves_to_the_outside() -> None:
    surface, q, moving = two(icosphere(3), icosphere(2).scaled(0.1).moved((0.93, 0, 0)))
    found = find_separation(surface, q, moving, separation=0.05)
    assert found[0] > 0 and np.linalg.norm(found) < 0.3
    assert clear_after(surface, q, moving, found)


def test_bodies_that_are_apart_stay() -> None:
    surface, q, moving = two(icosphere(1), icosphere(1).moved((3, 0, 0)))
    assert np.array_equal(find_separation(surface, q, moving), np.zeros(3))


def test_steps_give_turns_between_the_tests_and_the_same_translation() -> None:
    surface, q, moving = two(icosphere(3), icosphere(3).moved((0.4, -0.3, 1.5)))
    task, turns, fractions = Task(find_separation_steps(surface, q, moving)), 0, []
    while not task.advance():
        turns += 1
        fractions.append(task.progress.fraction)
    assert turns > 100 and fractions == sorted(fractions) and fractions[-1] > 0.9
    assert np.array_equal(task.result, find_separation(surface, q, moving))


@pytest.mark.parametrize("looks", [0, 1, 5, 20, 200])
def test_a_time_limit_leaves_the_shortest_clear_way_so_far(looks: int, monkeypatch: pytest.MonkeyPatch) -> None:
    ball = icosphere(2)
    surface, q, moving = two(ball, ball.moved((1.3, 0.2, 0.1)))
    whole, left = find_separation(surface, q, moving), iter(range(looks))
    monkeypatch.setattr(separating, "is_over", lambda end: next(left, None) is None)
    found = find_separation(surface, q, moving, time_budget=1.0)
    if looks == 0:
        assert found is None
    else:
        assert clear_after(surface, q, moving, found)
        assert np.linalg.norm(found) >= np.linalg.norm(whole)


@pytest.mark.parametrize("offset", [(2.0, 0.0, 0.0), (2.0, 2.0, 0.0), (0.0, 0.3, -2.0)])
def test_boxes_that_only_touch_part_by_little_more_than_the_gap(offset: tuple[float, float, float]) -> None:
    cube = triangulated(box(2))
    surface, q, moving = two(cube, cube.moved(offset))
    found = find_separation(surface, q, moving, separation=0.01)
    assert 0.01 <= np.linalg.norm(found) <= 0.0101
    assert clear_after(surface, q, moving, found)
