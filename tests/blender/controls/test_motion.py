# SPDX-License-Identifier: GPL-3.0-or-later
"""Influence around a selection and origins of its own, against brute force; and in an edit of a cage."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

pytest.importorskip("bpy")

import bmesh
import bpy
import mathutils

from stiv import InputError
from stiv.blender import BlenderEdit, EditSettings, Influence, Motion, check_scene
from stiv.blender.controls.motion import FALLOFFS
from stiv.blender.controls.selection_distances import distances_along, island_centres, nearest_distances


def turn(angle: float, axis: str = "Z") -> np.ndarray:
    return np.array(mathutils.Matrix.Rotation(angle, 4, axis))


def random_points(seed: int, count: int = 30) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points, a selection of some, and random edges."""
    random = np.random.default_rng(seed)
    return random.random((count, 3)), random.random(count) < 0.3, random.integers(0, count, (25, 2)).astype(np.int32)


def turn_about(pivot: np.ndarray, angle: float, axis: str = "Z") -> np.ndarray:
    matrix = turn(angle, axis)
    matrix[:3, 3] = pivot - matrix[:3, :3] @ pivot
    return matrix


@given(st.integers(0, 1000))
def test_the_nearest_selected_point_is_found(seed: int) -> None:
    points, selected, _ = random_points(seed)
    selected[0] = True
    expected = np.linalg.norm(points[:, None] - points[selected][None], axis=2).min(axis=1)
    assert_allclose(nearest_distances(points, selected), expected, rtol=1e-6, atol=1e-9)


@given(st.integers(0, 1000))
def test_paths_along_edges_are_the_shortest(seed: int) -> None:
    """Against repeated relaxation of every edge (Bellman 1958)."""
    points, selected, edges = random_points(seed)
    expected = np.where(selected, 0.0, np.inf)
    for _ in points:
        for a, b in edges:
            length = np.linalg.norm(points[a] - points[b])
            expected[a], expected[b] = min(expected[a], expected[b] + length), min(expected[b], expected[a] + length)
    assert_allclose(distances_along(edges, points, selected), expected)


@given(st.integers(0, 1000))
def test_selected_edges_join_islands(seed: int) -> None:
    points, selected, edges = random_points(seed)
    inside = [(a, b) for a, b in edges if selected[a] and selected[b]]
    expected = []
    for first in np.flatnonzero(selected):
        island = {first}
        for _ in points:
            island |= {b for a, b in inside if a in island} | {a for a, b in inside if b in island}
        expected.append(points[sorted(island)].mean(axis=0))
    assert_allclose(island_centres(points, selected, edges), np.array(expected).reshape(-1, 3))


@pytest.mark.parametrize("falloff", FALLOFFS)
def test_a_falloff_decreases_from_one_to_zero(falloff: str) -> None:
    distances = np.array([0.0, 0.2, 0.7, 1.3, 1.999, 2.0, 5.0, np.inf])
    shares = Influence(2.0, falloff).shares(distances)
    assert shares[0] == 1 and (shares[-3:] == 0).all() and (shares[:5] > 0).all() and (shares <= 1).all()
    assert falloff == "RANDOM" or (np.diff(shares) <= 0).all()


@pytest.mark.parametrize(("size", "falloff"), [(0.0, "SMOOTH"), (np.inf, "SMOOTH"), (np.nan, "SMOOTH"), (1.0, "ODD")])
def test_invalid_influences_are_refused(size: float, falloff: str) -> None:
    with pytest.raises(InputError):
        Influence(size, falloff)


@given(st.floats(-3.0, 3.0), st.floats(0.0, 1.0))
def test_a_fraction_of_a_rotation_is_a_rotation_by_that_fraction_of_the_angle(angle: float, share: float) -> None:
    pivot, point = np.array([1.0, -2.0, 0.5]), np.array([[3.0, 1.0, 1.0]])
    moved = Motion(turn_about(pivot, angle), pivot).shared(point, np.array([share]))
    assert_allclose(moved[0], pivot + turn(share * angle)[:3, :3] @ (point[0] - pivot), atol=1e-5)


def test_fraction_one_is_the_whole_transform() -> None:
    matrix = np.array([[2, 0, 0, 1], [0, 1, 0, 2], [0, 0, 0.5, 3], [0, 0, 0, 1]], float)
    points = np.random.default_rng(1).random((5, 3))
    motion = Motion(matrix, np.array([1.0, 2.0, 3.0]))
    assert_allclose(motion.shared(points, np.ones(5)), motion.whole(points))
    assert_allclose(motion.shared(points, np.zeros(5)), points)


def test_more_than_half_a_turn_takes_the_long_way() -> None:
    motion = Motion(turn(np.radians(270)), np.zeros(3), rotation=np.radians([0, 0, 270]))
    assert_allclose(motion.shared(np.array([[1.0, 0, 0]]), np.array([1 / 3])), [[0, 1, 0]], atol=1e-9)


@pytest.fixture
def strip() -> Any:
    """A strip of 11 x 2 vertices from x = 0 to 10, in Edit Mode with its first end selected."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=10, y_subdivisions=1, size=1)
    ob = bpy.context.active_object
    for vertex in ob.data.vertices:
        vertex.co = ((vertex.co.x + 0.5) * 10, vertex.co.y, 0)
    select(ob, lambda x: x < 0.1)
    return ob


def select(ob: Any, wanted: Any) -> None:
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_mode(type="VERT")
    content = bmesh.from_edit_mesh(ob.data)
    for vertex in content.verts:
        vertex.select_set(wanted(vertex.co.x))
    content.select_flush_mode()
    bmesh.update_edit_mesh(ob.data)


def places(ob: Any) -> np.ndarray:
    ob.update_from_editmode()
    return np.array([vertex.co for vertex in ob.data.vertices])


def upward(height: float, **choices: Any) -> Motion:
    matrix = np.eye(4)
    matrix[2, 3] = height
    return Motion(matrix, np.zeros(3), **choices)


def test_points_near_the_selection_follow_by_their_fraction(strip: Any) -> None:
    before = places(strip)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert edit.drag(upward(1, influence=Influence(4.0, "LINEAR"))).status == "reached"
    edit.write()
    assert_allclose(places(strip)[:, 2], np.clip(1 - before[:, 0] / 4, 0, 1), atol=1e-6)
    assert edit.drag(upward(1, influence=Influence(2.0, "CONSTANT"))).status == "reached"
    edit.write()
    assert_allclose(places(strip)[:, 2], before[:, 0] < 2, atol=1e-6)
    edit.restore()
    assert_array_equal(places(strip), before)


def test_following_points_yield_too(strip: Any) -> None:
    """A ceiling over the third quad, above a point that is not selected but follows."""
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.mesh.primitive_cube_add(size=1, location=(2, 0, 0.8))
    bpy.context.view_layer.objects.active = strip
    bpy.context.selected_objects[0].select_set(False)
    strip.select_set(True)
    select(strip, lambda x: x < 0.1)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert edit.apply(upward(1, influence=Influence(8.0, "LINEAR"))).status == "corrected"
    assert edit.write().passed
    follower = np.isclose(places(strip)[:, 0], 2)
    assert (places(strip)[follower, 2] < 0.3).all()
    assert places(strip)[:2, 2].max() > 0.3
    assert check_scene(bpy.context).pairs == ()


def test_each_island_rotates_about_its_own_centre(strip: Any) -> None:
    select(strip, lambda x: x < 1.1 or x > 8.9)
    before = places(strip)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "rotate")
    pivot = np.array([5.0, 7.0, 0.0])
    edit.apply(Motion(turn_about(pivot, 0.3, "X"), pivot, individual=True))
    edit.write()
    ends = (before[:, 0] < 1.1) | (before[:, 0] > 8.9)
    expected = before.copy()
    expected[ends] = before[ends] @ turn(0.3, "X")[:3, :3].T
    assert_allclose(places(strip), expected, atol=1e-6)


def test_each_object_rotates_about_its_own_origin() -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    for x in (0, 10):
        bpy.ops.mesh.primitive_cube_add(location=(x, 0, 0))
    bpy.ops.object.select_all(action="SELECT")
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "rotate")
    pivot = np.array([5.0, 0.0, 0.0])
    edit.apply(Motion(turn_about(pivot, 0.5), pivot, individual=True))
    edit.write()
    for ob in bpy.data.objects:
        assert_allclose(ob.location.y, 0, atol=1e-6)
        assert_allclose(ob.rotation_euler.z, 0.5, atol=1e-6)
