# SPDX-License-Identifier: GPL-3.0-or-later
"""Positions in Blender's meshes, compared with writing each vertex."""

import bpy
import numpy as np
from building import add, mesh

from blend_fixtures.scenes.primitives import icosphere
from stiv.blender.scene.arrays import Floats, Singles
from stiv.blender.scene.mesh_writing import write_positions

BALL = icosphere(2, 0.5)


def test_blender_derives_the_same_as_from_vertices_set_one_by_one() -> None:
    """Box, normals and the tree of ray casts follow, in the mesh and in its evaluation."""
    one, other = _ball("One"), _ball("Other")
    before = _derived(one)
    assert np.array_equal(before, _derived(other))
    random = np.random.default_rng(4)
    for scale in (2.0, 0.5, 1.25):
        local = (scale * np.array(BALL.vertices) + random.normal(0, 0.02, (len(BALL.vertices), 3))).astype(np.float32)
        write_positions(one.data, local)
        for vertex, position in zip(other.data.vertices, local.tolist(), strict=True):
            vertex.co = position
        other.data.update()
        after = _derived(one)
        assert not np.array_equal(after, before)
        assert np.array_equal(after, _derived(other))


def test_a_mesh_without_vertices() -> None:
    write_positions(bpy.data.meshes.new("Nothing"), np.empty((0, 3), np.float32))


def _ball(name: str) -> bpy.types.Object:
    return add(name, mesh(name, BALL.vertices, BALL.faces))


def _derived(ob: bpy.types.Object) -> Floats:
    bpy.context.view_layer.update()
    evaluated = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    values = []
    for each in (ob, evaluated):
        hit = each.ray_cast((9.0, 0.01, 0.02), (-1.0, 0.0, 0.0))
        values += [
            _values(each.data, "co"),
            _values(each.data, "normal"),
            np.ravel([*map(list, each.bound_box)]),
            hit[1],
        ]
    return np.concatenate(values)


def _values(mesh: bpy.types.Mesh, name: str) -> Singles:
    values = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get(name, values)
    return values
