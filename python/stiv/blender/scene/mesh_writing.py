# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes positions into Blender's meshes."""

import bpy

from stiv.blender.scene.arrays import Singles


def write_positions(mesh: bpy.types.Mesh, local: Singles) -> None:
    """Write local positions, (n, 3), of a mesh outside Edit Mode.

    The attribute takes them in one copy. The vertices would set each and drop what Blender derived from it, such as
    normals; so only the first one is set like this.
    """
    attribute = mesh.attributes.get("position")
    if attribute is None or not len(local):
        mesh.vertices.foreach_set("co", local.ravel())
    else:
        attribute.data.foreach_set("vector", local.ravel())
        mesh.vertices[0].co = local[0]
    mesh.update()
