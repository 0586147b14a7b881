# SPDX-License-Identifier: GPL-3.0-or-later
"""Intersecting bodies with excluded pairs may part but never go deeper.

Two closed bodies are limited by their common volume, an open body by its area inside a closed one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes.primitives import grid, icosphere, triangulated

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
    """A downward tip that enters the face of a block by `depth`."""
    tip = APEX * (1, -1, -1) + (0.02, 0.05, 2.0 - depth)
    return tetrahedra(tip, BASE)


def clipped_behind(polygon: Array, plane: Array) -> Array:
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
    """Common volume of two tetrahedra, from the faces of each, clipped by the planes of the other."""
    volume = 0.0
    for one, other in ((first, second), (second, first)):
        for corners in outward(one):
            polygon = corners
            for plane in outward(other):
                polygon = clipped_behind(polygon, plane)
            for k in range(2, len(polygon)):
                volume += polygon[0] @ np.cross(polygon[k - 1], polygon[k]) / 6
    return volume


def outward(corners: Array) -> list[Array]:
    """The faces (3, 3) of a tetrahedron, oriented outward for any order of its vertices."""
    faces = []
    for face in FACES:
        middle, points = corners.mean(axis=0), corners[face]
        inside = np.cross(points[1] - points[0], points[2] - points[0]) @ (middle - points[0]) > 0
        faces.append(points[::-1] if inside else points)
    return faces


def rounding_of(volume_of: Array) -> float:
    """Change of a volume if every vertex moves by four units in the last place of single precision."""
    area = sum(np.linalg.norm(np.cross(f[1] - f[0], f[2] - f[0])) / 2 for f in volume_of[FACES])
    return float(2 * area * 4 * np.spacing(np.float32(np.abs(volume_of).max())))


def session_of(surface: stiv.Surface, start: Array) -> stiv.EditSession:
    return stiv.EditSession(surface, stiv.identity(len(start)), start, stiv.EditOptions(exclude="intersecting"))


def random_edits(session: stiv.EditSession, chance: np.random.Generator) -> Iterator[stiv.EditResult]:
    """Results of edits and drags that move and bend one of two bodies with four vertices each."""
    for _ in range(12):
        goal = session.controls
        body = slice(0, 4) if chance.random() < 0.5 else slice(4, 8)
        goal[body] += chance.normal(scale=0.1, size=3) + chance.normal(scale=0.03, size=(4, 3))
        yield session.edit(goal) if chance.random() < 0.5 else session.drag(goal)


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
    for result in random_edits(session, chance):
        now = common_volume(result.surface[:4], result.surface[4:])
        assert now <= most + rounding_of(start[:4]) + rounding_of(start[4:])
        moved += len(result.path)
    assert moved > 0


@pytest.mark.parametrize("scale", [1e-7, 1.0, 1e7])
def test_a_tip_cannot_go_deeper_but_can_leave(scale: float) -> None:
    surface, start = tip_in_block(0.8)
    start = (scale * start).astype(np.float32).astype(float)
    upward = np.array([0, 0, scale]) * (np.arange(8) < 4)[:, None]
    deeper = session_of(surface, start).edit(start - 0.3 * upward)
    assert deeper.status == "blocked"
    assert np.abs(deeper.controls - start).max() < 1e-4 * scale  # tolerance for rounding
    for lift in (0.1, 0.5, 1.5):
        out = session_of(surface, start).edit(start + lift * upward)
        assert out.status == "reached"
        assert (len(stiv.find_intersections(out.surface, surface)) == 0) == (lift > 0.8)


def test_a_drag_that_returns_reaches_the_start() -> None:
    surface, start = tip_in_block(0.8)
    upward = np.array([0, 0, 1.0]) * (np.arange(8) < 4)[:, None]
    session = session_of(surface, start)
    for lift in (0.1, 0.2, 0.1, 0.0):
        assert session.drag(start + lift * upward).status == "reached"
    assert np.array_equal(session.controls, start)


def test_both_bodies_may_move_and_rotate_together() -> None:
    surface, start = tip_in_block(0.8)
    turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])
    session = session_of(surface, start)
    for step in range(1, 6):
        angle = 0.1 * step
        turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        assert session.edit(start @ turn.T + np.array([3.0, 2, 1]) * step).status == "reached"


def test_other_bodies_move_freely() -> None:
    far = APEX + (8, 0, 0)
    both = tip_in_block(0.8)[1]
    surface, start = tetrahedra(both[:4], both[4:], far)
    goal = start + np.array([0, 0, 1.0]) * (np.arange(12) >= 8)[:, None]
    assert session_of(surface, start).edit(goal).status == "reached"


def bodies_of(named: dict[str, tuple[Array, Array]]) -> tuple[stiv.Surface, Array]:
    """Named bodies with their triangles and vertices, concatenated."""
    counts = [len(vertices) for _, vertices in named.values()]
    firsts = np.cumsum([0, *counts])
    surface = stiv.Surface(
        np.concatenate([triangles + first for (triangles, _), first in zip(named.values(), firsts, strict=False)]),
        int(firsts[-1]),
        vertex_body=np.repeat(np.arange(len(counts)), counts),
        bodies=[stiv.Body(name) for name in named],
    )
    return surface, np.concatenate([vertices for _, vertices in named.values()]).astype(np.float32).astype(float)


def sheet_in_block(depth: float, tilt: float = 0.0) -> tuple[stiv.Surface, Array]:
    """An upright sheet of two triangles that enters the upper face of a tetrahedron by `depth`."""
    sheet = np.array([[-0.2, 0, -0.7], [0.4, 0, -0.7], [0.4, 0, 1.3], [-0.2, 0, 1.3]]) + (0, 0.3, 0.7 - depth)
    sheet[:, 1] += tilt * sheet[:, 2]
    return bodies_of({"sheet": (np.array([[0, 1, 2], [0, 2, 3]]), sheet), "block": (FACES, BASE)})


def area_of(polygon: Array) -> float:
    arms = polygon[1:] - polygon[:1]
    return float(np.linalg.norm(np.cross(arms[:-1], arms[1:]).sum(axis=0)) / 2)


def area_inside(start: Array, now: Array, triangles: Array, planes: Sequence[Array]) -> float:
    """Area of triangles behind all planes, in areas at the start."""
    area = 0.0
    for corners in triangles:
        polygon = now[corners]
        for plane in planes:
            polygon = clipped_behind(polygon, plane)
        if len(polygon) > 2:
            area += area_of(start[corners]) * area_of(polygon) / area_of(now[corners])
    return area


@pytest.mark.parametrize("scale", [1e-7, 1.0, 1e7])
def test_a_sheet_cannot_go_deeper_but_can_leave_and_slide(scale: float) -> None:
    surface, start = sheet_in_block(0.8)
    start = (scale * start).astype(np.float32).astype(float)
    moving = scale * (np.arange(8) < 4)[:, None]
    deeper = session_of(surface, start).edit(start - 0.3 * moving * (0, 0, 1))
    assert deeper.status == "blocked"
    assert np.abs(deeper.controls - start).max() < 1e-4 * scale  # tolerance for rounding
    for way in ((0, 0, 0.3), (0, 0, 1.5), (0.1, 0.2, 0), (-0.1, 0.1, 0.1)):
        assert session_of(surface, start).edit(start + moving * way).status == "reached"


def test_a_sheet_dragged_in_and_out_is_never_deeper_than_at_the_start() -> None:
    surface, start = sheet_in_block(0.8)
    upward = np.array([0, 0, 1.0]) * (np.arange(8) < 4)[:, None]
    session = session_of(surface, start)
    for height, reached in ((0.2, True), (0.1, True), (0.0, True), (-0.1, False), (0.3, True), (0.0, True)):
        result = session.drag(start + height * upward)
        assert (result.status in ("reached", "unchanged")) == reached
        assert result.surface[:4, 2].min() > start[:4, 2].min() - 1e-4
    assert np.array_equal(session.controls, start)


def test_a_sheet_may_stretch_in_place() -> None:
    surface, start = sheet_in_block(0.8)
    wider = start.copy()
    wider[:4, 0] = 1.2 * start[:4, 0]
    assert session_of(surface, start).edit(wider).status == "reached"


@pytest.mark.parametrize("seed", range(16))
def test_no_random_edit_makes_the_area_inside_larger(seed: int) -> None:
    chance = np.random.default_rng(seed)
    surface, start = sheet_in_block(chance.uniform(0.2, 1.5), chance.uniform(-0.5, 0.5))
    turn = np.linalg.qr(chance.normal(size=(3, 3)))[0]  # or a mirror, so that the block faces inward
    start = (start @ turn.T).astype(np.float32).astype(float)
    sheet = surface.triangles[:2]
    most = area_inside(start, start, sheet, outward(start[4:]))
    assert most > 0.05
    session = session_of(surface, start)
    moved = 0
    for result in random_edits(session, chance):
        assert area_inside(start, result.surface, sheet, outward(result.surface[4:])) <= most + 1e-5
        moved += len(result.path)
    assert moved > 0


def shirt_cut_by_torso() -> tuple[stiv.Surface, Array]:
    """A ball that protrudes on one side from an open tube of twelve long panels."""
    torso, panels = icosphere(1), triangulated(grid(12, 1, 12, 1.6))
    angle, height = panels.vertices[:24, 0] * np.pi / 6, panels.vertices[:24, 1]
    shirt = np.stack([1.25 * np.cos(angle) + 0.5, 1.25 * np.sin(angle) + 0.03, height + 0.04], axis=1)
    return bodies_of({"torso": (torso.triangles(), torso.vertices), "shirt": (panels.triangles() % 24, shirt)})


def test_a_shirt_cannot_go_deeper_into_a_torso_but_can_leave() -> None:
    surface, start = shirt_cut_by_torso()
    worn = (surface.vertex_body == 1)[:, None]
    deeper = session_of(surface, start).edit(start + worn * (0.01, 0, 0))
    assert deeper.status == "blocked"
    assert np.abs(deeper.surface - start).max() < 1e-5
    for way in (-0.01, -0.1, -0.24):
        off = session_of(surface, start).edit(start + worn * (way, 0, 0))
        assert off.status in ("reached", "corrected")
        moved = (off.surface - start)[surface.vertex_body == 1].mean(axis=0)
        assert np.abs(moved - (way, 0, 0)).max() < 0.02


@pytest.mark.parametrize("seed", range(3))
def test_no_random_drag_makes_the_area_of_a_shirt_inside_a_torso_larger(seed: int) -> None:
    chance = np.random.default_rng(seed)
    surface, start = shirt_cut_by_torso()
    worn = (surface.vertex_body == 1)[:, None]
    torso, shirt = surface.triangles[:80], surface.triangles[80:]
    most = area_inside(start, start, shirt, start[torso])
    assert most > 1
    session = session_of(surface, start)
    moved = 0
    for _ in range(10):
        way = chance.normal(scale=0.02, size=3) + chance.normal(scale=0.003, size=start.shape)
        result = session.drag(session.controls + worn * way)
        assert area_inside(start, result.surface, shirt, result.surface[torso]) <= most + 1e-4
        moved += len(result.path)
    assert moved > 10


@pytest.mark.parametrize("closed", [False, True])
def test_a_sheet_on_a_block_is_not_pressed_in_but_slides_and_leaves(closed: bool) -> None:
    upper = np.array([[-0.5, -0.5, 1], [0.5, -0.5, 1], [0.0, 0.5, 1], [0, 0, 2]])
    lower = np.array([[-3.0, -3, 1], [3, -3, 1], [0, 3, 1], [0, 0, -2]])
    surface, start = bodies_of({"lying": (FACES if closed else FACES[:1], upper), "block": (FACES[:, ::-1], lower)})
    assert len(stiv.find_intersections(start, surface)) > 0
    moving = (np.arange(8) < 4)[:, None]
    pressed = session_of(surface, start).edit(start - moving * (0, 0, 0.1))
    assert pressed.status == "blocked"
    assert np.abs(pressed.surface - start).max() < 1e-5
    for way in ((0, 0, 0.1), (0.1, 0.2, 0.0)):
        assert session_of(surface, start).edit(start + moving * way).status == "reached"
