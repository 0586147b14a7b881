# SPDX-License-Identifier: GPL-3.0-or-later
"""Starts in contact, starts closer than the separation, and extreme scales in single precision."""

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes.primitives import grid, icosphere

SHEET = grid(4, 4, 2.0, 2.0)
FACES = SHEET.triangles()
ABOVE = FACES + len(SHEET.vertices)


def sheets(gap: float, scale: float = 1.0, offset: float = 0.0) -> np.ndarray:
    whole = np.vstack([SHEET.vertices, SHEET.vertices + (0, 0, gap)]) * scale + offset
    return whole.astype(np.float32).astype(float)


def session(vertices, triangles, **options) -> stiv.EditSession:
    return stiv.EditSession(triangles, stiv.identity(len(vertices)), vertices, stiv.EditOptions(**options))


@pytest.mark.parametrize("case", ["coincident sheets", "duplicate faces", "touching corner"])
def test_contact_at_the_start_is_refused_with_its_pairs(case):
    vertices, triangles = sheets(0.0), np.vstack([FACES, ABOVE])
    if case == "duplicate faces":
        vertices, triangles = SHEET.vertices, np.vstack([FACES, FACES[:1]])
    if case == "touching corner":
        vertices = sheets(1.0)
        vertices[-1] = vertices[FACES[0]].mean(axis=0)
    ways_out = 'object "surface", face .* Move them apart, repair them, or exclude these pairs'
    with pytest.raises(stiv.StartIntersectsError, match=f"the start already intersects: .*{ways_out}") as raised:
        session(vertices, triangles)
    assert len(raised.value.pairs) > 0
    found = {tuple(pair) for pair in stiv.find_intersections(vertices, triangles).tolist()}
    assert {tuple(pair) for pair in np.asarray(raised.value.pairs).tolist()} <= found


@pytest.mark.parametrize(
    ("triangles", "loose_edges", "counted"),
    [
        ([[0, 1, 2], [3, 4, 5]], [], "1 pair of faces cut each other"),
        ([[0, 1, 2], [0, 2, 1], [3, 4, 5]], [], "3 pairs of faces cut each other"),
        ([[0, 1, 2]], [[3, 4]], "1 loose edge or vertex cuts a face"),
        (
            [[0, 1, 2], [0, 2, 1]],
            [[3, 4], [3, 5]],
            "1 pair of faces cut each other, and 2 loose edges or vertices cut faces",
        ),
    ],
)
def test_the_message_counts_what_intersects_and_nothing_else(triangles, loose_edges, counted):
    vertices = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.2, 0.2, -1), (0.2, 0.2, 1), (0.3, 0.2, 1)])
    surface = stiv.Surface(triangles, 6, loose_edges or None)
    with pytest.raises(stiv.StartIntersectsError, match=f"^the start already intersects: {counted}; object"):
        stiv.EditSession(surface, stiv.identity(6), vertices)


@pytest.mark.parametrize(("separation", "least_slide"), [(0.5, 0.0), (0.3, 0.1), (0.2, 0.2), (0.15, 0.2), (0.1, 0.29)])
def test_a_separation_larger_than_the_distance_at_the_start_moves_nothing_apart(separation, least_slide):
    """With 0.5, hardly any slide is possible: every vertex starts 0.5001 above the sides of the next squares."""
    vertices, triangles = sheets(0.01), np.vstack([FACES, ABOVE])
    editing = session(vertices, triangles, separation=separation)
    goal = vertices.copy()
    goal[len(SHEET.vertices) :, 0] += 0.3  # sideways
    result = editing.edit(goal)
    assert len(stiv.find_intersections(result.surface, triangles)) == 0
    assert np.abs(result.surface[:, 2] - vertices[:, 2]).max() < 0.1
    assert (result.surface[len(SHEET.vertices) :, 0] - vertices[len(SHEET.vertices) :, 0]).min() >= least_slide
    assert np.sum((result.surface - goal) ** 2) <= np.sum((vertices - goal) ** 2)


@pytest.mark.parametrize("scale", [1e-7, 1.0, 1e7])
def test_small_and_large_scenes_have_the_same_results(scale):
    triangles = np.vstack([FACES, ABOVE])
    vertices = sheets(0.5, scale)
    goal = vertices.copy()
    goal[len(SHEET.vertices) :, 2] -= 1.0 * scale
    result = session(vertices, triangles).edit(goal)
    assert result.rounds > 0
    assert len(stiv.find_intersections(result.surface, triangles)) == 0
    assert (result.surface[len(SHEET.vertices) :, 2] - result.surface[: len(SHEET.vertices), 2] > 0).all()


def test_a_tiny_object_far_away_is_refused_with_the_least_separation():
    """In single precision, the whole object is one point."""
    vertices, triangles = sheets(0.5, 1e-7, 1e7), np.vstack([FACES, ABOVE])
    with pytest.raises(stiv.InputError, match=r"the least that can be kept here is 4, .*move the scene nearer"):
        session(vertices, triangles, separation=1e-9)


def test_tiny_and_huge_objects_work_in_one_scene():
    plate, ball = SHEET.scaled(1e7), icosphere(1, 1.0).moved((0, 0, 30))
    vertices = np.vstack([plate.vertices, ball.vertices])
    triangles = np.vstack([FACES, ball.triangles() + len(plate.vertices)])
    owner = (np.arange(len(vertices)) >= len(plate.vertices)).astype(np.int32)
    bodies = [stiv.Body("Plate", "fixed"), stiv.Body("Ball")]
    surface, moved = stiv.Surface(triangles, len(vertices), None, owner, bodies), np.flatnonzero(owner)
    ball_alone = stiv.concatenate([(stiv.identity(len(moved)), moved.astype(np.int32))], vertices)
    editing = stiv.EditSession(surface, ball_alone, ball.vertices)
    result = editing.edit(ball.vertices - (0, 0, 60))
    assert len(stiv.find_intersections(result.surface, triangles)) == 0
    assert result.rounds > 0 and (result.surface[moved, 2] > 0).all()


def test_non_manifold_soup_with_loose_parts_is_edited():
    """Three sheets that share an edge, a loose edge and a loose vertex above a plate."""
    plate = SHEET.vertices
    fan = np.array([[-0.5, 0, 1], [0.5, 0, 1], [-0.5, 1, 1.2], [0.5, -1, 1.2], [0, 0, 2]])
    loose = np.array([[0.7, 0.7, 1], [0.9, 0.6, 1.3], [-0.7, -0.7, 0.9]])
    vertices = np.vstack([plate, fan, loose])
    first = len(plate)
    triangles = np.vstack([FACES, np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]]) + first])
    surface = stiv.Surface(triangles, len(vertices), np.array([[first + 5, first + 6]]))
    goal = vertices.copy()
    goal[first:, 2] -= 1.6
    result = session(vertices, surface).edit(goal)
    edges, points = stiv.find_loose_intersections(result.surface, surface)
    assert len(stiv.find_intersections(result.surface, surface)) == len(edges) == len(points) == 0
    assert result.rounds > 0 and (result.surface[first:, 2] < vertices[first:, 2]).all()
