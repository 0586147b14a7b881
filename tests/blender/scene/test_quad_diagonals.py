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
    kept = np.array([QuadDiagonals(first.corners[:, k : k + 1]).are_kept(after.local) for k in range(800)])
    splits_first = (after.triangles.reshape(-1, 6) == first.corners.T[:, [0, 1, 2, 0, 2, 3]]).all(axis=1)
    assert splits_first[kept].all() and kept[:400].mean() > 0.7 and (~splits_first).sum() > 50
    assert (kept == splits_first).mean() > 0.95


@pytest.mark.parametrize("face", [(0, 1, 2, 3, 4), (0, 3, 2, 1)])
def test_larger_faces_and_second_diagonals_are_left_to_blender(face: tuple[int, ...]) -> None:
    corners = [(-1, 0, 0), (0, -1, 2), (1, 0, 0), (0, 1, 2), (-1, 0.5, 0)]
    add("Face", mesh("Face", corners, [face]))
    assert QuadDiagonals.of(read_one()) is None


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
