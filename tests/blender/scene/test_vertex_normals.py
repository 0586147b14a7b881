# SPDX-License-Identifier: GPL-3.0-or-later
"""The normals of vertices that snapping aligns with are Blender's."""

import bmesh
import bpy
import numpy as np
from building import add, mesh

from stiv.blender import read_snap_targets


def test_vertex_normals_are_blenders() -> None:
    """On triangles, quads and polygons of a squeezed ball, and at a loose vertex."""
    content = bmesh.new()
    bmesh.ops.create_uvsphere(content, u_segments=7, v_segments=5, radius=1.0)
    bmesh.ops.dissolve_verts(content, verts=content.verts[12:14])
    for vertex in content.verts:
        vertex.co *= 1.0 + 0.3 * np.sin(5.0 * vertex.co.x + vertex.co.y)
    content.verts.new((2.0, 1.0, 0.5))
    data = mesh("Ball", [], [])
    content.to_mesh(data)
    content.free()
    add("Ball", data)
    bpy.context.view_layer.update()
    target = next(iter(read_snap_targets(bpy.context)))
    found = np.array([target.mesh.vertex_normal(vertex) for vertex in range(len(data.vertices))])
    np.testing.assert_allclose(
        found, [list(vertex.normal) for vertex in data.vertices], atol=5e-5
    )  # its angles are approximate
