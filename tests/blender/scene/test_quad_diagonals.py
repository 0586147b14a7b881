# SPDX-License-Identifier: GPL-3.0-or-later
"""The quads that certainly keep their first diagonal, compared with Blender's own triangulation."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import add, mesh

from stiv.blender import BlenderEdit, EditSettings
from stiv.blender.scene import triangulation_flips
from stiv.blender.scene.evaluated_scene import VisibleMesh, read_scene
from stiv.blender.scene.quad_diagonals import QuadDiagonals

SQUARE = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)


def read_one() -> VisibleMesh:
    (found,) = read_scene(bpy.context).meshes
    return found


def add_quads(corners: Any) -> Any:
    faces = np.arange(len(corners) * 4).reshape(-1, 4)
    return add("Quads", mesh("Quads", corners.reshape(-1, 3).tolist(), faces.tolist()))


def test_blender_splits_certain_quads_along_the_first_diagonal() -> None:
    chance = np.random.default_rng(1)
    bends = np.repeat([0.0, 0.3, 1.0, 3.0], 200)[:, None, None] * chance.normal(size=(800, 4, 3))
    quads = add_quads(np.tile(SQUARE, (800, 1, 1)))
    first = QuadDiagonals.of(read_one())
    assert first is not None
    quads.data.vertices.foreach_set("co", (SQUARE + bends).astype(np.float32).ravel())
    quads.data.update()
    bpy.context.view_layer.update()
    after = read_one()
    kept = np.ones(800, bool)
    kept[first.find_uncertain(after.local)] = False
    splits_first = (after.triangles.reshape(-1, 6) == first.corners.T[:, [0, 1, 2, 0, 2, 3]]).all(axis=1)
    assert splits_first[kept].all() and kept[:400].mean() > 0.7 and (~splits_first).sum() > 50
    assert (kept == splits_first).mean() > 0.95


@pytest.mark.parametrize("height", [1e-2, 1e-1, 1.0])
def test_far_from_the_origin_thin_quads_are_uncertain(height: float) -> None:
    """With known normals of faces, Blender compares products with coordinates, which rounding may exceed."""
    chance = np.random.default_rng(2)
    corners = SQUARE * (1, height, 1) + height * 0.2 * chance.normal(size=(400, 4, 3)) + (3e4, -2e4, 1e4)
    quads = add_quads(corners)
    assert len(quads.data.polygon_normals) == 400
    quads.data.update()
    bpy.context.view_layer.update()
    seen = read_one()
    known = QuadDiagonals(np.arange(1600).reshape(4, 400, order="F"), np.zeros(400, np.bool_))
    certain = np.ones(400, np.bool_)
    certain[known.find_uncertain(seen.local)] = False
    splits_first = (seen.triangles.reshape(-1, 6) == known.corners.T[:, [0, 1, 2, 0, 2, 3]]).all(axis=1)
    assert splits_first[certain].all() and certain.any() == (height > 0.05)


@pytest.mark.parametrize("size", [1e-7, 1.0, 1e7])
def test_the_size_of_flat_quads_does_not_make_them_uncertain(size: float) -> None:
    add_quads(size * np.tile(SQUARE, (3, 1, 1)))
    quads = QuadDiagonals.of(read_one())
    assert quads is not None and len(quads.find_uncertain(read_one().local)) == 0


CORNERS = [(-1, 0, 0), (0, -1, 2), (1, 0, 0), (0, 1, 2), (-1, 0.5, 0)]


def test_larger_faces_are_left_to_blender() -> None:
    add("Face", mesh("Face", CORNERS, [(0, 1, 2, 3, 4)]))
    assert QuadDiagonals.of(read_one()) is None


@pytest.mark.parametrize("first", range(4))
def test_the_other_triangles_are_those_that_blender_flips_to(first: int) -> None:
    """From either diagonal, and also back."""
    face = tuple(np.roll(range(4), first).tolist())
    quad = add("Face", mesh("Face", CORNERS[:4], [face]))
    shown = [read_one()]
    for corner in (1, 3):
        quad.data.vertices[corner].co.z = 0.0
    quad.data.update()
    bpy.context.view_layer.update()
    shown.append(read_one())
    bent, flat = (QuadDiagonals.of(each) for each in shown)
    assert bent is not None and flat is not None
    assert bent.second.all() and not flat.second.any()
    only = np.array([0], np.int32)
    assert np.array_equal(bent.other_triangles(only), shown[1].triangles)
    assert np.array_equal(flat.other_triangles(only), shown[0].triangles)
    assert [quads.find_uncertain(shown[0].local).tolist() for quads in (bent, flat)] == [[0], [0]]
    assert flat.find_uncertain(shown[1].local).tolist() == []


def test_an_edit_reads_no_triangles_as_long_as_all_quads_are_certain(monkeypatch: pytest.MonkeyPatch) -> None:
    quads = add_quads(np.tile(SQUARE, (1, 1, 1)))
    quads.select_set(True)
    edit = BlenderEdit.begin(bpy.context, EditSettings(object_response="deform"), "move")
    reads: list[int] = []
    read = triangulation_flips.read_triangles
    monkeypatch.setattr(triangulation_flips, "read_triangles", lambda each: reads.append(1) or read(each))
    matrix = np.eye(4)
    matrix[0, 3] = 0.5
    edit.drag(matrix)
    assert edit.write().passed and not reads
    assert quads.data.vertices[0].co.x == 0.5
