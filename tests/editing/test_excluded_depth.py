# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed bodies that stand in each other, with their pairs excluded, go no deeper; they may go out."""

from __future__ import annotations

import numpy as np
import pytest

import stiv

Array = np.ndarray
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
APEX = np.array([[1.0, 0, 0], [-0.5, 0.9, 0], [-0.5, -0.9, 0], [0.05, 0.03, 2.0]])
BASE = np.array([[4.0, 0, 0], [-2, 3.6, 0], [-2, -3.6, 0], [0.1, 0.2, -3]])[[0, 2, 1, 3]]


def tetrahedra(*corners: Array) -> tuple[stiv.Surface, Array]:
    count = len(corners)
    surface = stiv.Surface(
        np.concatenate([FACES + 4 * k for k in range(count)]),
        4 * count,
        vertex_body=np.repeat(np.arange(count), 4),
        bodies=[stiv.Body(f"body {k}") for k in range(count)],
    )
    return surface, np.concatenate(corners).astype(np.float32).astype(float)


def tip_in_block(depth: float) -> tuple[stiv.Surface, Array]:
    """A tip that points down and stands in the face of a block, and goes in by `depth`."""
    tip = APEX * (1, -1, -1) + (0.02, 0.05, 2.0 - depth)
    return tetrahedra(tip, BASE)


def part_behind(polygon: Array, plane: Array) -> Array:
    """The part of a polygon (k, 3) behind the plane of three points."""
    normal = np.cross(plane[1] - plane[0], plane[2] - plane[0])
    height = (polygon - plane[0]) @ normal
    kept = []
    for a, b, u, v in zip(polygon, np.roll(polygon, -1, 0), height, np.roll(height, -1), strict=True):
        if u <= 0:
            kept.append(a)
        if u * v < 0:
            kept.append(a + u / (u - v) * (b - a))
    return np.array(kept).reshape(-1, 3)


def common_volume(first: Array, second: Array) -> float:
    """What two tetrahedra have in common, from the faces of each cut by the planes of the other."""
    volume = 0.0
    for one, other in ((first, second), (second, first)):
        for corners in outward(one):
            polygon = corners
            for plane in outward(other):
                polygon = part_behind(polygon, plane)
            for k in range(2, len(polygon)):
                volume += polygon[0] @ np.cross(polygon[k - 1], polygon[k]) / 6
    return volume


def outward(corners: Array) -> list[Array]:
    """The faces (3, 3) of a tetrahedron, turned to the outside however its vertices lie."""
    faces = []
    for face in FACES:
        middle, points = corners.mean(axis=0), corners[face]
        inside = np.cross(points[1] - points[0], points[2] - points[0]) @ (middle - points[0]) > 0
        faces.append(points[::-1] if inside else points)
    return faces


def rounding_of(volume_of: Array) -> float:
    """How much a volume changes where every vertex moves by four units in the last place of what is stored."""
    area = sum(np.linalg.norm(np.cross(f[1] - f[0], f[2] - f[0])) / 2 for f in volume_of[FACES])
    return float(2 * area * 4 * np.spacing(np.float32(np.abs(volume_of).max())))


def session_of(surface: stiv.Surface, start: Array) -> stiv.EditSession:
    return stiv.EditSession(surface, stiv.identity(len(start)), start, stiv.EditOptions(exclude="intersecting"))


@pytest.mark.parametrize("seed", range(12))
def test_no_random_edit_makes_the_common_volume_larger(seed: int) -> None:
    chance = np.random.default_rng(seed)
    turn = np.linalg.qr(chance.normal(size=(3, 3)))[0]
    surface, start = tip_in_block(chance.uniform(0.2, 1.5))
    start = (start @ turn.T).astype(np.float32).astype(float)
    if np.linalg.det(turn) < 0:
        start = start * (1, 1, -1)
    most = common_volume(start[:4], start[4:])
    assert most > 0
    session = session_of(surface, start)
    moved = 0
    for _ in range(12):
        goal = session.controls
        body = slice(0, 4) if chance.random() < 0.5 else slice(4, 8)
        goal[body] += chance.normal(scale=0.1, size=3) + chance.normal(scale=0.03, size=(4, 3))
        result = session.edit(goal) if chance.random() < 0.5 else session.drag(goal)
        now = common_volume(result.surface[:4], result.surface[4:])
        assert now <= most + rounding_of(start[:4]) + rounding_of(start[4:])
        moved += len(result.path)
    assert moved > 0


@pytest.mark.parametrize("scale", [1e-7, 1.0, 1e7])
def test_a_tip_goes_no_deeper_but_out_all_the_way(scale: float) -> None:
    surface, start = tip_in_block(0.8)
    start = (scale * start).astype(np.float32).astype(float)
    upward = np.array([0, 0, scale]) * (np.arange(8) < 4)[:, None]
    deeper = session_of(surface, start).edit(start - 0.3 * upward)
    assert deeper.status == "blocked"
    assert np.abs(deeper.controls - start).max() < 1e-4 * scale  # what rounding may hide
    for lift in (0.1, 0.5, 1.5):
        out = session_of(surface, start).edit(start + lift * upward)
        assert out.status == "reached"
        assert (len(stiv.find_intersections(out.surface, surface)) == 0) == (lift > 0.8)


def test_a_drag_that_comes_back_reaches_the_start_again() -> None:
    surface, start = tip_in_block(0.8)
    upward = np.array([0, 0, 1.0]) * (np.arange(8) < 4)[:, None]
    session = session_of(surface, start)
    for lift in (0.1, 0.2, 0.1, 0.0):
        assert session.drag(start + lift * upward).status == "reached"
    assert np.array_equal(session.controls, start)


def test_both_may_move_and_turn_together() -> None:
    surface, start = tip_in_block(0.8)
    turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])
    session = session_of(surface, start)
    for step in range(1, 6):
        angle = 0.1 * step
        turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        assert session.edit(start @ turn.T + np.array([3.0, 2, 1]) * step).status == "reached"


def test_other_bodies_move_while_these_stand_in_each_other() -> None:
    far = APEX + (8, 0, 0)
    both = tip_in_block(0.8)[1]
    surface, start = tetrahedra(both[:4], both[4:], far)
    goal = start + np.array([0, 0, 1.0]) * (np.arange(12) >= 8)[:, None]
    assert session_of(surface, start).edit(goal).status == "reached"
