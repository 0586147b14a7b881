# SPDX-License-Identifier: GPL-3.0-or-later
"""The test of surfaces near an accepted state, compared with the complete test."""

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes.primitives import icosphere

BALL = icosphere(2, 0.5)
COUNT = len(BALL.vertices)
FACES = np.array(BALL.faces, np.int32)


@pytest.mark.parametrize("scale", [1e-7, 1.0, 1e7])
def test_states_of_a_drag_and_surfaces_near_them(scale: float) -> None:
    """A ball is pressed onto another: within the reach, deviations make them intersect."""
    vertices = scale * np.concatenate([BALL.vertices, BALL.vertices + (0, 0, 1.2)])
    bodies = [stiv.Body("Below", "fixed"), stiv.Body("Above", "rigid")]
    faces, body = np.concatenate([FACES, FACES + COUNT]), np.repeat([0, 1], COUNT)
    surface = stiv.Surface(faces, 2 * COUNT, vertex_body=body, bodies=bodies)
    moving = stiv.rigid(vertices[COUNT:])
    deformation = stiv.concatenate([(moving, np.arange(COUNT, 2 * COUNT))], vertices)
    rest = stiv.rigid_rest_controls(vertices[COUNT:])
    session = stiv.EditSession(surface, deformation, rest, stiv.EditOptions(separation=9e-7 * scale))
    random, seen, kept = np.random.default_rng(5), set(), []
    for tick in range(1, 9):
        session.drag(rest + scale * np.array([(0.0, 0.0, -0.05 * tick), (0.0, 0.0, 0.0)]))
        near = session.deviation_test()
        assert near is not None
        toward = np.where(np.arange(2 * COUNT) < COUNT, 1.0, -1.0)[:, None] * (0.0, 0.0, 1.0)
        for pattern in (toward, random.uniform(-1, 1, (2 * COUNT, 3)), np.zeros((2 * COUNT, 3))):
            q = session.surface + 0.999 * near.reach * pattern
            expected = len(stiv.find_intersections(q, surface)) == 0
            assert near.is_free(q) == expected
            seen.add(expected)
            kept.append((near, q, expected))
            assert near.is_free(session.surface + 1.01 * near.reach * np.sign(toward)) is None
    assert seen == {True, False}
    for near, q, expected in kept:  # later states leave the tests as they are
        assert near.is_free(q) == expected


def test_there_is_none_with_excluded_pairs_or_obstacles() -> None:
    surface = stiv.Surface(FACES, COUNT, bodies=[stiv.Body("Ball", "rigid")])
    rest = stiv.rigid_rest_controls(BALL.vertices)
    floor = stiv.Obstacle(BALL.vertices + (0, 0, 9), FACES, "Floor")
    session = stiv.EditSession(surface, stiv.rigid(BALL.vertices), rest, stiv.EditOptions(), [floor])
    assert session.deviation_test() is None
    excluded = stiv.EditOptions(exclude=np.array([[0, 1]], np.int32))
    assert stiv.EditSession(surface, stiv.rigid(BALL.vertices), rest, excluded).deviation_test() is None


@pytest.mark.parametrize("wrong", [np.nan, np.inf, 1e-80, 1e80])
def test_invalid_coordinates_are_refused_wherever_they_are(wrong: float) -> None:
    """1e-80 lies within the reach of a coordinate of 0."""
    vertices = np.concatenate([BALL.vertices, np.zeros((1, 3))])
    surface = stiv.Surface(FACES, COUNT + 1, bodies=[stiv.Body("Ball", "rigid")])
    session = stiv.EditSession(surface, stiv.rigid(vertices), stiv.rigid_rest_controls(vertices))
    near = session.deviation_test()
    assert near is not None
    assert near.is_free(session.surface) is True
    q = session.surface.copy()
    assert q[COUNT, 2] == 0
    q[COUNT, 2] = wrong
    with pytest.raises(stiv.InputError, match="coordinate"):
        near.is_free(q)
    with pytest.raises(stiv.InputError, match="rows"):
        near.is_free(session.surface[1:])
