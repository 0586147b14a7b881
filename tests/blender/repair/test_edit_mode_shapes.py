# SPDX-License-Identifier: GPL-3.0-or-later
"""The shapes of meshes in Edit Mode, shown again later."""

from collections.abc import Iterator

import bmesh
import bpy
import numpy as np
import pytest

from stiv.blender.repair.edit_mode_shapes import EditModeShapes
from stiv.blender.repair.rest_shape import read_rest_shape, remove_rest_shape, store_rest_shape


@pytest.fixture(autouse=True)
def cubes() -> Iterator[None]:
    """Two cubes in Edit Mode, and one in Object Mode."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    for _ in range(3):
        bpy.ops.mesh.primitive_cube_add()
    bpy.data.objects["Cube"].select_set(True)
    bpy.data.objects["Cube.001"].select_set(True)
    bpy.data.objects["Cube.002"].select_set(False)
    bpy.context.view_layer.objects.active = bpy.data.objects["Cube"]
    bpy.ops.object.mode_set(mode="EDIT")
    yield
    bpy.ops.object.mode_set(mode="OBJECT")


def positions(name: str) -> np.ndarray:
    return np.array([vertex.co for vertex in bmesh.from_edit_mesh(bpy.data.objects[name].data).verts])


def move(name: str) -> None:
    edited = bmesh.from_edit_mesh(bpy.data.objects[name].data)
    for vertex in edited.verts:
        vertex.co.x += 0.1
    bmesh.update_edit_mesh(bpy.data.objects[name].data)


def test_vertices_and_rest_shapes_of_the_start_are_shown_inside_alone() -> None:
    names = ("Cube", "Cube.001")
    first, second = (bpy.data.objects[name] for name in names)
    rest = np.arange(24, dtype=np.float32).reshape(-1, 3)
    store_rest_shape(second, rest)
    before = [positions(name) for name in names]
    start = EditModeShapes(list(bpy.context.view_layer.objects))
    for name in names:
        move(name)
    store_rest_shape(first, rest)
    remove_rest_shape(second)
    after = [positions(name) for name in names]
    with start.shown():
        assert np.array_equal([positions(name) for name in names], before)
        assert read_rest_shape(first) is None and np.array_equal(read_rest_shape(second), rest)
    assert np.array_equal([positions(name) for name in names], after) and not np.array_equal(before, after)
    assert np.array_equal(read_rest_shape(first), rest) and read_rest_shape(second) is None
