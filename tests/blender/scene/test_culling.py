# SPDX-License-Identifier: GPL-3.0-or-later
"""Cropped meshes against a plain loop over all faces, edges and vertices."""

from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from building import add, mesh
from numpy.testing import assert_array_equal

from stiv.blender import check_scene
from stiv.blender.scene.evaluated_scene import VisibleMesh, read_scene

BOXES = [((-1, -1, -1), (1, 1, 1)), ((0.2, -9, -9), (0.9, 9, 9)), ((40, 40, 40), (41, 41, 41)), ((-99,) * 3, (99,) * 3)]


def all_kinds(seed: int) -> Any:
    """Triangles, quads and larger faces, loose edges and loose vertices, anywhere; turned, scaled and mirrored."""
    random = np.random.default_rng(seed)
    content = bmesh.new()
    for _ in range(60):
        middle, size = random.uniform(-4, 4, 3), random.uniform(0.1, 2)
        turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
        corners = random.integers(1, 8)
        angles = np.sort(random.uniform(0, 6.28, corners))
        ring = np.stack([np.cos(angles), np.sin(angles), 0.2 * random.normal(size=corners)], axis=1)
        vertices = [content.verts.new(row) for row in middle + size * ring @ turn]
        if corners == 2:
            content.edges.new(vertices)
        elif corners > 2:
            content.faces.new(vertices)
    data = bpy.data.meshes.new("All kinds")
    content.to_mesh(data)
    content.free()
    return add("All kinds", data, (0.3, -0.2, 0.5), rotation_euler=(0.4, 0.5, 0.6), scale=(1.5, -0.7, 1.0))


def read(box: Any = None) -> VisibleMesh:
    (found,) = read_scene(bpy.context, box_of=lambda name: box and tuple(np.array(side, float) for side in box)).meshes
    return found


@pytest.mark.parametrize("box", BOXES)
@pytest.mark.parametrize("seed", range(8))
def test_all_elements_that_touch_the_box_are_read(seed: int, box: Any) -> None:
    all_kinds(seed)
    low, high = map(np.array, box)
    part, whole = read(box), read()
    assert part.cropped is not None and part.size == whole.size
    world, numbers = whole.world(), part.cropped.vertices
    assert_array_equal(part.world(), world[numbers])

    def meets(vertices: Any) -> bool:
        """Whether any of many points of a vertex, an edge or a triangle lies in the box."""
        shares = np.random.default_rng(seed).dirichlet(np.ones(len(vertices)), 300)
        points = np.concatenate([world[vertices], shares @ world[vertices]])
        return bool(((points >= low) & (points <= high)).all(axis=1).any())

    faces = {int(face) for face, corners in zip(whole.faces, whole.triangles, strict=True) if meets(corners)}
    assert faces <= set(part.faces.tolist())
    held = np.isin(whole.faces, part.faces)
    assert_array_equal(part.faces, whole.faces[held])
    assert_array_equal(numbers[part.triangles], whole.triangles[held])
    edges = {int(n) for n, edge in zip(whole.loose_numbers, whole.loose_edges, strict=True) if meets(edge)}
    assert edges <= set(part.loose_numbers.tolist())
    rows = np.isin(whole.loose_numbers, part.loose_numbers)
    assert_array_equal(numbers[part.loose_edges], whole.loose_edges[rows])
    assert {n for n in range(len(world)) if meets([n])} <= set(numbers.tolist())


def test_distant_elements_are_not_read() -> None:
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=50, y_subdivisions=50, size=50)
    part = read(((-2.5, -2.5, -1), (2.5, 2.5, 1)))
    assert 25 <= len(set(part.faces.tolist())) <= 49
    assert read(((60, 60, 60), (61, 61, 61))).local.shape == (0, 3)


def test_a_singular_frame_is_not_cropped() -> None:
    add("Flat", mesh("Flat", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]), (5, 0, 0), scale=(1, 1, 0))
    assert len(read(((-1, -1, -1), (1, 1, 1))).triangles) == 1


def test_elements_are_named_by_their_numbers_in_blenders_mesh() -> None:
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=50, y_subdivisions=50, size=50)
    ground = bpy.context.object
    part, whole = read(((19.2, 19.2, -1), (19.8, 19.8, 1))), read()
    number = part.vertex_number(0)
    assert number == part.cropped.vertices[0] > 0 and ground.data.vertices[number].co.x > 18
    assert whole.vertex_number(3) == 3
    assert check_scene(bpy.context).pairs == ()
