# SPDX-License-Identifier: GPL-3.0-or-later
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from snap_scene import BELOW, CORNERS, Quad
from views import VIEWS

from stiv_addon.transform.snap_search import REACH, SnapSearch
from stiv_addon.transform.view import View

VIEW = VIEWS["top"]


def found(elements: set, place: tuple, *quads: Quad, view: View = VIEW, source: tuple = (0, 0, 0), **chosen: bool):
    search = SnapSearch(quads or (Quad(),), frozenset(elements), **chosen)
    return search.find(view.project(np.array(place, float)), view, np.array(source, float))


@pytest.mark.parametrize(
    ("elements", "place", "element", "expected"),
    [
        ({"VERTEX"}, (1.9, 1.9, 1), "VERTEX", (2, 2, 1)),
        ({"VERTEX", "EDGE", "FACE"}, (1.9, 1.9, 1), "VERTEX", (2, 2, 1)),
        ({"VERTEX", "EDGE", "FACE"}, (1.95, 1.2, 1), "EDGE", (2, 1.2, 1)),
        ({"EDGE", "FACE"}, (1.9, 1.2, 1), "EDGE", (2, 1.2, 1)),
        ({"EDGE_MIDPOINT", "FACE"}, (1.9, 1.2, 1), "EDGE_MIDPOINT", (2, 1, 1)),
        ({"EDGE_MIDPOINT", "EDGE"}, (1.97, 1.9, 1), "EDGE", (2, 1.9, 1)),
        ({"EDGE_PERPENDICULAR"}, (1.9, 0.7, 1), "EDGE_PERPENDICULAR", (2, 0.6, 1)),
        ({"FACE"}, (1, 1, 1), "FACE", (1, 1, 1)),
        ({"VERTEX", "FACE"}, (1, 1, 1), "FACE", (1, 1, 1)),
        ({"VERTEX"}, (1, 1, 1), "", None),
        ({"VERTEX"}, (2.1, 2.1, 1), "VERTEX", (2, 2, 1)),
        ({"FACE"}, (2.1, 2.1, 1), "", None),
        ({"EDGE"}, (-2, -2, 1), "", None),
    ],
)
def test_the_element_of_blenders_rules_is_found(elements: set, place: tuple, element: str, expected: tuple) -> None:
    target = found(elements, place, source=(0.3, 0.6, 0.0))
    if expected is None:
        assert target is None
    else:
        assert target.element == element
        np.testing.assert_allclose(target.position, expected, atol=1e-6)


@pytest.mark.parametrize("view", VIEWS.values(), ids=VIEWS)
@given(pixel=st.tuples(st.floats(200, 600), st.floats(150, 450)))
def test_vertices_and_edges_are_those_nearest_in_pixels(view: View, pixel: tuple) -> None:
    """Against brute force: all corners, and many points of all edges."""
    steps = np.linspace(0.0, 1.0, 101)[:, None]
    along = [a + steps * (b - a) for a, b in zip(CORNERS, np.roll(CORNERS, -1, axis=0), strict=True)]
    for elements, points in (("VERTEX", CORNERS), ("EDGE", np.concatenate(along))):
        target = SnapSearch((Quad(),), frozenset({elements}), occlusion=False).find(pixel, view, np.zeros(3))
        least = min(math.dist(view.project(point), pixel) for point in points)
        if target is None:
            assert least >= REACH - 1e-6
        else:
            assert math.dist(view.project(target.position), pixel) <= least + 3.0


def test_a_face_hides_what_is_behind_it_unless_the_view_is_xray() -> None:
    lower = Quad(BELOW * [0.5, 0.5, 1.0])
    place = (0.95, 0.95, 1.0)
    assert found({"VERTEX"}, place, Quad(), lower) is None
    np.testing.assert_allclose(found({"VERTEX"}, place, Quad(), lower, occlusion=False).position, (1, 1, -2))
    assert found({"VERTEX"}, place, Quad(surface=False), lower) is not None
    np.testing.assert_allclose(found({"FACE"}, place, lower, Quad()).position, place, atol=1e-6)


def test_culling_skips_faces_that_face_away() -> None:
    turned, lower = Quad(upwards=False), Quad(BELOW)
    assert found({"FACE"}, (1, 1, 1), turned, lower).position[2] == pytest.approx(1.0)
    assert found({"FACE"}, (1, 1, 1), turned, lower, culling=True).position[2] == pytest.approx(-2.0)
    assert found({"VERTEX"}, (0, 0, 1), turned).position[2] == 1.0
    assert found({"VERTEX"}, (0, 0, 1), turned, culling=True) is None


def test_instances_are_found_where_they_are() -> None:
    matrix = np.diag([2.0, 0.5, 1.0, 1.0])
    matrix[:3, 3] = (-1.0, -3.0, 0.5)
    target = found({"VERTEX"}, (2.95, -2.05, 1.5), Quad(matrix=matrix))
    np.testing.assert_allclose(target.position, (3, -2, 1.5), atol=1e-6)


def test_directions_on_a_stretched_target_are_those_of_either_release() -> None:
    """4.3 transforms directions of edges and faces by the matrix, 5.2 as normals."""

    class Slope(Quad):
        def cast(self, origin: np.ndarray, direction: np.ndarray) -> tuple | None:
            hit = super().cast(origin, direction)
            return hit and (hit[0], np.array([1.0, 0.0, 1.0]), hit[2])

    slope = Slope(matrix=np.diag([2.0, 1.0, 1.0, 1.0]))
    for as_normals, expected in ((False, (2, 0, 1)), (True, (0.5, 0, 1))):
        direction = found({"FACE"}, (2, 1, 1), slope, as_normals=as_normals).direction
        np.testing.assert_allclose(direction, expected / np.linalg.norm(expected), atol=1e-6)


@pytest.mark.parametrize(
    ("chosen", "height"),
    [
        ({"steps": 1, "same_object": False}, -0.5),  # four units of the first quad's space: more than three
        ({"steps": 2, "same_object": False}, 0.5),
        ({"steps": 1, "same_object": True}, 0.5),
    ],
)
def test_the_nearest_face_is_that_of_blenders_comparison(chosen: dict, height: float) -> None:
    half, lower = np.diag([0.5, 0.5, 0.5, 1.0]), Quad(CORNERS - [0.0, 0.0, 1.5])
    goal = np.array([0.5, 0.5, 2.5])
    nearest = SnapSearch((Quad(matrix=half), lower), frozenset()).nearest(goal, goal, **chosen)
    np.testing.assert_allclose(nearest, (0.5, 0.5, height), atol=1e-12)


@pytest.mark.parametrize(("whole", "height"), [(False, -0.5), (True, -0.5)])
def test_the_middle_of_a_volume(whole: bool, height: float) -> None:
    class Slab(Quad):
        def cast(self, origin: np.ndarray, direction: np.ndarray) -> tuple | None:
            return Quad().cast(origin, direction) or Quad(BELOW).cast(origin, direction)

    slab = Slab(np.concatenate([CORNERS, BELOW])[[0, 2, 4, 6]])
    middle = SnapSearch((slab,), frozenset({"VOLUME"})).middle(VIEW.project(np.array([1.0, 1, 1])), VIEW, whole=whole)
    np.testing.assert_allclose(middle.position, (1, 1, height), atol=1e-6)
