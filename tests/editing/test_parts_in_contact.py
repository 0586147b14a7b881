# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts and bodies that only touch at the start: they slide, turn and part, and never pass each other."""

from __future__ import annotations

import numpy as np
import pytest
from oracles.parting import parting_motion

import stiv
from blend_fixtures.scenes.primitives import box, grid, triangulated
from blend_fixtures.scenes.shape import joined


def flush_boxes(place: tuple[float, float, float], size: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """One body of two boxes: a unit cube, and one that touches it; the second has vertices 8 to 15."""
    first, second = np.full(3, 0.5), np.array(place) + np.array(size) / 2
    whole = joined([triangulated(box(1, (1, 1, 1))).moved(first), triangulated(box(1, size)).moved(second)])
    return whole.triangles(), whole.vertices.astype(np.float32).astype(float)


FLUSH = {
    "whole sides": ((1, 0, 0), (1, 1, 1)),
    "inside a side": ((1, 0.25, 0.25), (1, 0.5, 0.5)),
    "across an edge": ((1, 0.5, -0.5), (0.5, 1, 1)),
    "along an edge": ((1, 0.25, 1), (0.5, 0.5, 1)),
}


OF = ["one body", "two bodies"]


def session_of_flush_boxes(place: str, of: str) -> tuple[stiv.EditSession, np.ndarray]:
    triangles, start = flush_boxes(*FLUSH[place])
    assert len(stiv.find_intersections(start, triangles)) > 0
    frame = stiv.StorageFrame(0, len(start), np.eye(4))
    if of == "one body":
        options = stiv.EditOptions(exclude="intersecting", storage=[frame])
        return stiv.EditSession(triangles, stiv.identity(len(start)), start, options), triangles
    options = stiv.EditOptions(touching=["cube", "beside"], storage=[frame])
    return stiv.EditSession(two_bodies(triangles), stiv.identity(len(start)), start, options), triangles


def two_bodies(triangles: np.ndarray) -> stiv.Surface:
    bodies = [stiv.Body("cube"), stiv.Body("beside")]
    return stiv.Surface(triangles, 16, vertex_body=np.repeat([0, 1], 8), bodies=bodies)


def deepest(q: np.ndarray, triangles: np.ndarray) -> float:
    """The greatest depth of two triangles without common corners, by an independent test."""
    pairs = stiv.find_intersections(q, triangles).tolist()
    apart = [pair for pair in pairs if not set(triangles[pair[0]]) & set(triangles[pair[1]])]
    return max((parting_motion(*q[triangles[pair]]) for pair in apart), default=0.0)


STORED = 16 * 2.0**-22  # rounding of coordinates below 4, as four times the least separation


@pytest.mark.parametrize("of", OF)
@pytest.mark.parametrize("place", FLUSH)
@pytest.mark.parametrize("seed", range(6))
def test_parts_that_only_touch_never_cut_each_other(place: str, seed: int, of: str) -> None:
    (session, triangles), chance = session_of_flush_boxes(place, of), np.random.default_rng(seed)
    for _ in range(4):
        goal = session.controls
        chosen = slice(8, 16) if chance.random() < 0.5 else [int(chance.integers(16))]
        goal[chosen] += chance.normal(scale=0.2, size=3)
        session.edit(goal)
        assert deepest(session.surface, triangles) < STORED


@pytest.mark.parametrize("of", OF)
@pytest.mark.parametrize("place", FLUSH)
def test_parts_that_only_touch_part_slide_and_move_together(place: str, of: str) -> None:
    out = np.array([0.3, 0.0, 0.1 if place == "along an edge" else 0.0])
    for motion, moving in ((out, slice(8, 16)), (np.array([0.0, 0.2, 0.0]), slice(8, 16)), (out, slice(0, 16))):
        session, triangles = session_of_flush_boxes(place, of)
        goal = session.controls
        goal[moving] += motion
        session.edit(goal)
        np.testing.assert_allclose(session.controls, goal, atol=1e-4)
        assert deepest(session.surface, triangles) < STORED


@pytest.mark.parametrize("of", OF)
def test_a_part_slides_along_the_side_that_it_is_pressed_into(of: str) -> None:
    session, _ = session_of_flush_boxes("inside a side", of)
    session.set_weights(np.repeat([0.0, 1.0], 8))  # the cube is pinned
    goal = session.controls
    touches = (goal[:, 0] == 1) & (np.arange(16) >= 8)
    goal[8:] += (-0.2, 0.1, 0.2)
    session.edit(goal)
    np.testing.assert_allclose(session.controls - goal, np.outer(touches, (0.2, 0, 0)), atol=1e-3)


def turned(points: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Points turned by a rotation vector (Rodrigues)."""
    angle = np.linalg.norm(vector)
    x, y, z = vector / angle
    cross = np.array([(0, -z, y), (z, 0, -x), (-y, x, 0)])
    return points @ (np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross).T


@pytest.mark.parametrize("place", FLUSH)
@pytest.mark.parametrize("seed", range(10))
def test_bodies_that_touch_turn_together_wherever_rounding_puts_them(place: str, seed: int) -> None:
    """In some directions they intersect at the start, in others they are apart."""
    triangles, boxes = flush_boxes(*FLUSH[place])
    chance = np.random.default_rng(seed)
    start = turned(boxes, chance.normal(size=3)).astype(np.float32).astype(float)
    options = stiv.EditOptions(touching=[0, 1])
    session = stiv.EditSession(two_bodies(triangles), stiv.identity(16), start, options)
    for _ in range(3):
        goal = turned(session.controls, chance.normal(scale=0.1, size=3)).astype(np.float32)
        result = session.edit(goal)
        assert result.status == "reached" and result.rounds == 0
        assert deepest(result.surface, triangles) < STORED


class Stack:
    """Two bodies that move without turning, the second on the first along the first axis, and of the same width."""

    def __init__(self, seed: int, faces: str = "outward") -> None:
        chance = np.random.default_rng(seed)
        triangles, boxes = flush_boxes(*FLUSH["whole sides"])
        self.axes = turned(np.eye(3), chance.normal(size=3))  # as rows
        start = (boxes @ self.axes + chance.normal(size=3)).astype(np.float32).astype(float)
        if faces == "inward":
            triangles = triangles[:, ::-1]
        if faces == "open":  # only the lower side of the second body is left: a sheet on a cube
            touching = np.abs((start - start[4]) @ self.axes[0]) < 1e-5
            triangles = triangles[(triangles < 8).all(axis=1) | touching[triangles].all(axis=1)]
        parts = [(stiv.rigid(start[rows]), np.arange(16, dtype=np.int32)[rows]) for rows in (LOWER, UPPER)]
        self.rest = np.concatenate([stiv.rigid_rest_controls(start[rows]) for rows in (LOWER, UPPER)])
        options = stiv.EditOptions(
            touching=[0, 1], storage=[stiv.StorageFrame(0, 0, np.eye(4))], weights=[0.0, 0.0, 1.0, 0.0]
        )
        self.session = stiv.EditSession(two_bodies(triangles), stiv.concatenate(parts, start), self.rest, options)

    def move(self, way: np.ndarray) -> None:
        """Move the second body from the start, along the axes."""
        goal = self.rest.copy()
        goal[2] += way @ self.axes
        self.session.edit(goal)

    @property
    def way(self) -> np.ndarray:
        """Of the second body since the start, along the axes."""
        moved: np.ndarray = (self.session.controls[2] - self.rest[2]) @ self.axes.T
        return moved


LOWER, UPPER = slice(0, 8), slice(8, 16)
FACES = ["outward", "inward", "open"]


@pytest.mark.parametrize("faces", FACES)
@pytest.mark.parametrize("seed", range(6))
def test_a_body_does_not_sink_into_one_of_the_same_width(seed: int, faces: str) -> None:
    """No two of their triangles need to intersect, since the sides are in common planes."""
    stack = Stack(seed, faces)
    for inward in (0.5, 0.1, 0.9):
        stack.move(np.array([-inward, 0, 0]))
        assert stack.way == pytest.approx(0, abs=STORED)


@pytest.mark.parametrize("faces", FACES)
def test_a_body_returns_only_to_the_contact(faces: str) -> None:
    stack = Stack(1, faces)
    for height, end in ((0.4, 0.4), (-0.7, 0.0), (0.2, 0.2), (0.0, 0.0)):
        stack.move(np.array([height, 0, 0]))
        assert stack.way == pytest.approx([end, 0, 0], abs=1e-3)
        assert stack.way[0] > -STORED


@pytest.mark.parametrize("faces", FACES)
@pytest.mark.parametrize("seed", range(6))
def test_a_body_that_is_pressed_slides_along_one_of_the_same_width(seed: int, faces: str) -> None:
    stack, chance = Stack(seed, faces), np.random.default_rng(seed)
    way = np.array([-0.3, *chance.uniform(-0.5, 0.5, 2)])
    stack.move(way)
    assert stack.way == pytest.approx(way * (0, 1, 1), abs=1e-3)
    assert stack.way[0] > -STORED


@pytest.mark.parametrize("faces", FACES)
@pytest.mark.parametrize("seed", range(6))
def test_a_body_of_the_same_width_moves_anywhere_but_inside(seed: int, faces: str) -> None:
    stack, chance = Stack(seed, faces), np.random.default_rng(seed)
    for _ in range(6):
        stack.move(chance.normal(scale=0.7, size=3) * (chance.random(3) < 0.6))  # along some axes only
        overlaps = 1 - abs(stack.way[1:])
        assert overlaps.min() < STORED or not -1 < stack.way[0] < -STORED  # beside it, or not between its ends


@pytest.mark.parametrize("rigid", [True, False])
@pytest.mark.parametrize("height", [-0.05, -0.15, -0.3, -0.8, -2.0, -20.0])
def test_a_flat_pyramid_does_not_pass_the_sheet_on_which_it_stands(height: float, rigid: bool) -> None:
    """All its faces touch the sheet, and one step could take it to the other side as a whole."""
    sheet = np.array([(-6, -6, 0), (6, -6, 0), (6, 6, 0), (-6, 6, 0)], float)
    pyramid = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 0.1)], float)
    start = np.concatenate([sheet, pyramid])
    sides = [(4 + k, 4 + (k + 1) % 4, 8) for k in range(4)]
    triangles = np.array([(0, 1, 2), (0, 2, 3), (4, 6, 5), (4, 7, 6), *sides], np.int32)
    bodies = [stiv.Body("sheet", "fixed"), stiv.Body("pyramid")]
    surface = stiv.Surface(triangles, 9, vertex_body=np.repeat([0, 1], [4, 5]), bodies=bodies)
    moving = stiv.rigid(pyramid) if rigid else stiv.identity(5)
    rest = stiv.rigid_rest_controls(pyramid) if rigid else pyramid
    whole = stiv.concatenate([(moving, np.arange(4, 9, dtype=np.int32))], start)
    weights = [1.0, 0.0] if rigid else None
    options = stiv.EditOptions(touching=[0, 1], storage=[stiv.StorageFrame(0, 0, np.eye(4))], weights=weights)
    session = stiv.EditSession(surface, whole, rest, options)
    session.edit(rest + np.array([(0, 0, height), (0, 0, 0)] if rigid else [(0, 0, height)] * 5))
    assert session.surface[4:, 2].min() > -STORED


class Standing:
    """A prism that stands on a floor, both with random triangles, and keeps no distance from it."""

    def __init__(self, seed: int, rigid: bool) -> None:
        chance = np.random.default_rng(seed)
        cells, corners, middle = chance.integers(1, 8), chance.integers(3, 9), chance.uniform(-1, 1, 2)
        floor = triangulated(grid(cells, cells, 12, 12))
        ring = [middle + (np.cos(angle), np.sin(angle)) for angle in np.linspace(0, 6, corners)]
        prism = np.array([(*place, z) for z in (0, 1) for place in ring])
        sides = [(k, (k + 1) % corners, corners + (k + 1) % corners, corners + k) for k in range(corners)]
        faces = [(k, a, b) for a, b, c, d in sides for k, a, b in ((a, b, c), (a, c, d))]
        faces += [(0, k + 1, k) for k in range(1, corners - 1)]
        faces += [(corners, corners + k, corners + k + 1) for k in range(1, corners - 1)]
        count = len(floor.vertices)
        start = np.concatenate([floor.vertices, prism]).astype(np.float32).astype(float)
        surface = stiv.Surface(
            np.concatenate([floor.triangles(), np.array(faces) + count]),
            len(start),
            vertex_body=np.repeat([0, 1], [count, len(prism)]),
            bodies=[stiv.Body("floor", "fixed"), stiv.Body("prism", "rigid" if rigid else "deformable")],
        )
        self.prism, rows = start[count:], np.arange(count, len(start), dtype=np.int32)
        part, self.rest = stiv.identity(len(prism)), self.prism
        if rigid:
            part, self.rest = stiv.rigid(self.prism), stiv.rigid_rest_controls(self.prism)
        options = stiv.EditOptions(
            touching=[0, 1],
            storage=[stiv.StorageFrame(0, 0, np.eye(4))],
            pair_separations={(0, 1): 1e-6},
            weights=[1.0, 0.0] if rigid else None,
        )
        self.session = stiv.EditSession(surface, stiv.concatenate([(part, rows)], start), self.rest, options)

    @property
    def shown(self) -> np.ndarray:
        return self.session.surface[-len(self.prism) :]


@pytest.mark.parametrize("kind", ["move", "turn", "stretch"])
@pytest.mark.parametrize("seed", range(12))
def test_a_prism_on_a_floor_reaches_any_place_in_its_plane(seed: int, kind: str) -> None:
    """The edges inside the floor lie in the plane in which its corners move."""
    rigid = kind != "stretch" and seed % 2 == 0
    standing, chance = Standing(seed, rigid), np.random.default_rng(seed)
    way, angle = np.append(chance.uniform(-2, 2, 2), 0), chance.uniform(-1, 1)
    if kind == "move":
        wanted, control = standing.prism + way, [way, (0, 0, 0)]
    elif kind == "turn":
        middle = standing.prism.mean(axis=0)
        wanted, control = turned(standing.prism - middle, np.array([0, 0, angle])) + middle, [(0, 0, 0), (0, 0, angle)]
    else:
        wanted, control = standing.prism * (*chance.uniform(0.6, 1.5, 2), 1), []
    goal = standing.rest + control if rigid else wanted
    for share in np.linspace(0.1, 1, 10):
        standing.session.edit(standing.rest + share * (goal - standing.rest))
    assert standing.shown == pytest.approx(wanted, abs=2 * STORED)


@pytest.mark.parametrize("rigid", [True, False])
@pytest.mark.parametrize("seed", range(8))
def test_a_prism_on_a_floor_moves_anywhere_but_below(seed: int, rigid: bool) -> None:
    standing, chance = Standing(seed, rigid), np.random.default_rng(seed)
    for _ in range(6):
        goal = standing.rest.copy()
        goal[: 1 if rigid else None] += chance.uniform(-1, 1, 3)
        if rigid:
            goal[1] += chance.uniform(-0.5, 0.5, 3)
        else:
            goal += chance.normal(scale=0.2, size=goal.shape)
        standing.session.edit(goal)
        assert standing.shown[:, 2].min() > -STORED


@pytest.mark.parametrize("content", ["crate", "rug"])
def test_a_crate_in_a_room_rises_but_does_not_pass_its_floor(content: str) -> None:
    """The faces of the room look inward."""
    room, crate = (triangulated(box(1, (size,) * 3)).moved((0, 0, size / 2)) for size in (3, 1))
    standing, faces = crate.vertices, crate.triangles()
    if content == "rug":
        faces = np.array([(0, 1, 2), (0, 2, 3)], np.int32)
        standing = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
    start = np.concatenate([room.vertices, standing])
    triangles = np.concatenate([room.triangles()[:, ::-1], faces + 8])
    rows = slice(8, len(start))
    deformation = stiv.concatenate([(stiv.rigid(start[rows]), np.arange(8, len(start), dtype=np.int32))], start)
    rest = stiv.rigid_rest_controls(start[rows])
    bodies = [stiv.Body("room", "fixed"), stiv.Body("content")]
    surface = stiv.Surface(
        triangles, len(start), vertex_body=(np.arange(len(start)) >= 8).astype(np.int32), bodies=bodies
    )
    options = stiv.EditOptions(touching=[0, 1], storage=[stiv.StorageFrame(0, 0, np.eye(4))], weights=[1.0, 0.0])
    session = stiv.EditSession(surface, deformation, rest, options)
    for height, end in ((-0.5, 0.0), (0.8, 0.8), (-0.3, 0.0)):
        session.edit(rest + [(0, 0, height), (0, 0, 0)])
        assert session.controls[0, 2] - rest[0, 2] == pytest.approx(end, abs=1e-3)
        assert session.controls[0, 2] - rest[0, 2] > -STORED


def test_bodies_that_cut_each_other_do_not_only_touch() -> None:
    triangles, start = flush_boxes((0.999, 0.25, 0.25), (1, 0.5, 0.5))
    with pytest.raises(stiv.StartIntersectsError):
        stiv.EditSession(two_bodies(triangles), stiv.identity(16), start, stiv.EditOptions(touching=[0, 1]))


def test_of_bodies_that_touch_one_is_closed() -> None:
    """Two sheets in contact have no other faces that would keep them from passing through each other."""
    sheet = triangulated(grid(2, 2, 1, 1))
    for other, count in ((sheet.moved((0, 0, 1e-8)), 0), (triangulated(box(1, (1, 1, 1))).moved((0, 0, 0.5)), 1)):
        whole = joined([sheet, other])
        owner = np.repeat([0, 1], [len(sheet.vertices), len(other.vertices)])
        surface = stiv.Surface(
            whole.triangles(), len(owner), vertex_body=owner, bodies=[stiv.Body("a"), stiv.Body("b")]
        )
        options = stiv.EditOptions(touching=[0, 1])
        session = stiv.EditSession(surface, stiv.identity(len(owner)), whole.vertices, options)
        assert (len(session.excluded) > 0) == count


def test_bodies_that_may_touch_must_exist() -> None:
    triangles, start = flush_boxes(*FLUSH["whole sides"])
    with pytest.raises(stiv.InputError, match="touching: 2 is not one of the 2 bodies"):
        stiv.EditSession(two_bodies(triangles), stiv.identity(16), start, stiv.EditOptions(touching=[2]))


@pytest.mark.parametrize("place, size", [((0, 0, 0), (1, 1, 1)), ((0.25, 0.25, 0), (0.5, 0.5, 0.5))])
def test_a_part_that_lies_inside_another_is_free_to_move(
    place: tuple[float, float, float], size: tuple[float, float, float]
) -> None:
    """A mirrored copy in place of the original, and a box on the floor inside another: each face only touches others,
    but the boxes share their insides.
    """
    triangles, start = flush_boxes(place, size)
    session = stiv.EditSession(triangles, stiv.identity(16), start, stiv.EditOptions(exclude="intersecting"))
    goal = start.copy()
    goal[8:] += (0.02, 0.01, -0.1)
    assert session.edit(goal).status == "reached"
