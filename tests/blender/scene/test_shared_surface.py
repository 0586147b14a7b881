# SPDX-License-Identifier: GPL-3.0-or-later
"""Consecutive readings share a surface only as long as nothing but positions changed."""

import weakref
from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from building import add, cube_above_floor, mesh

import stiv
from stiv.blender.scene.assembly import assemble
from stiv.blender.scene.evaluated_scene import read_scene
from stiv.blender.scene.shared_surface import are_equal


def read(ignored: tuple[tuple[str, str], ...] = (), mobility: str = "deformable") -> stiv.Surface:
    bpy.context.view_layer.update()
    meshes = read_scene(bpy.context).meshes
    return assemble(meshes, [mobility] * len(meshes), ignored=ignored).surface


def test_moved_vertices_and_objects_leave_the_surface() -> None:
    cube = cube_above_floor()
    first = read()
    cube.location.x += 1
    cube.data.vertices[0].co.z -= 0.1
    cube.data.update()
    assert read() is first


def test_a_surface_that_nothing_uses_is_not_kept() -> None:
    cube_above_floor()
    surface = read()
    found = weakref.ref(surface)
    del surface
    assert found() is None


def rename(cube: Any) -> None:
    cube.name = "Another"


def hide(cube: Any) -> None:
    cube.hide_viewport = True


def turn_faces(cube: Any) -> None:
    cube.data.flip_normals()


def subdivide(cube: Any) -> None:
    cube.modifiers.new("Subdivision", "SUBSURF")


@pytest.mark.parametrize("change", [rename, hide, turn_faces, subdivide])
def test_any_other_change_makes_another_surface(change: Callable[[Any], None]) -> None:
    cube = cube_above_floor()
    first = read()
    change(cube)
    second = read()
    assert second is not first and not are_equal(first, second)


def test_other_bodies_and_pairs_make_another_surface() -> None:
    cube_above_floor()
    first = read()
    names = (first.bodies[0].name, first.bodies[1].name)
    surfaces = [first, read(mobility="rigid"), read(ignored=(names,)), read()]
    for k, one in enumerate(surfaces):
        for other in surfaces[:k]:
            assert are_equal(one, other) == (k == 3 and other is surfaces[0])


def test_another_diagonal_with_as_many_triangles_makes_another_surface() -> None:
    corners = [(-1, 0, 0), (0, -1, 0), (1, 0, 0), (0, 1, 0)]
    quad = add("Quad", mesh("Quad", corners, [(0, 1, 2, 3)]))
    first = read()
    for corner in (1, 3):
        quad.data.vertices[corner].co.z = 2.0
    quad.data.update()
    second = read()
    assert first.triangles.shape == second.triangles.shape and not np.array_equal(first.triangles, second.triangles)
    assert not are_equal(first, second)
