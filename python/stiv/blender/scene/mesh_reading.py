# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays out of Blender's mesh data."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from typing import Any

import bmesh
import bpy
import numpy as np

from stiv.blender.scene.arrays import Indices, Singles, read_collection


@contextmanager
def evaluated_mesh(evaluated: bpy.types.Object) -> Iterator[bpy.types.Mesh]:
    """The mesh of an evaluated object, for as long as the context lasts.

    In Edit Mode the evaluated data may be an empty shell around the edit mesh (no attributes, no vertices when there
    is no modifier), so there a copy is made of it.
    """
    mesh = evaluated.data
    if isinstance(mesh, bpy.types.Mesh) and mesh.attributes.get("position") is not None:
        yield mesh
        return
    copy = evaluated.to_mesh()
    try:
        yield copy
    finally:
        evaluated.to_mesh_clear()


def read_positions(mesh: bpy.types.Mesh) -> Singles:
    """Local positions, (n, 3), as stored."""
    attribute = mesh.attributes.get("position")
    if attribute is None:
        return read_collection(mesh.vertices, "co", 3, np.float32)
    return read_collection(attribute.data, "vector", 3, np.float32)


def read_triangles(mesh: bpy.types.Mesh) -> tuple[Indices, Indices]:
    """Blender's own triangulation: corners, (f, 3), and the face each triangle belongs to, (f,)."""
    mesh.calc_loop_triangles()
    sizes = read_collection(mesh.polygons, "loop_total", 1, np.int32)
    faces = np.repeat(np.arange(len(sizes), dtype=np.int32), sizes - 2)  # in their order; faster than to ask for it
    return read_collection(mesh.loop_triangles, "vertices", 3, np.int32), faces


def read_edges(mesh: bpy.types.Mesh) -> Indices:
    """All edges, (e, 2), as stored."""
    return read_collection(mesh.edges, "vertices", 2, np.int32)


def read_loose_numbers(mesh: bpy.types.Mesh) -> Indices:
    """Numbers of the edges of no face, (l,)."""
    used = mesh.attributes.get(".corner_edge")
    if used is None:
        loose = read_collection(mesh.edges, "is_loose", 1, np.bool_)
    else:  # a tenth of the time
        loose = np.ones(len(mesh.edges), np.bool_)
        loose[read_collection(used.data, "value", 1, np.int32)] = False
    return np.flatnonzero(loose).astype(np.int32)


def read_corners(mesh: bpy.types.Mesh) -> tuple[Indices, Indices]:
    """As `read_faces`, a hundred times faster for evaluated meshes."""
    attribute = mesh.attributes.get(".corner_vert")
    if attribute is None:
        return read_faces(mesh)
    corners = read_collection(attribute.data, "value", 1, np.int32)
    starts = read_collection(mesh.polygons, "loop_start", 1, np.int32)
    return corners, np.append(starts, len(corners)).astype(np.int32)


def read_faces(mesh: bpy.types.Mesh) -> tuple[Indices, Indices]:
    """Corners of all faces, one after the other, and the first corner of each face with the end added, (F + 1,)."""
    corners = read_collection(mesh.loops, "vertex_index", 1, np.int32)
    starts = read_collection(mesh.polygons, "loop_start", 1, np.int32)
    return corners, np.append(starts, len(corners)).astype(np.int32)


def read_creases(mesh: bpy.types.Mesh) -> tuple[Singles | None, Singles | None]:
    """Creases of edges, (E,), and of vertices, (V,); None where there are none."""
    if mesh.is_editmode:  # attributes are empty there
        edited = bmesh.from_edit_mesh(mesh)
        return _edited_creases(edited.edges, "crease_edge"), _edited_creases(edited.verts, "crease_vert")

    def values(name: str) -> Singles | None:
        attribute = mesh.attributes.get(name)
        return None if attribute is None else read_collection(attribute.data, "value", 1, np.float32)

    return values("crease_edge"), values("crease_vert")


def _edited_creases(elements: Any, name: str) -> Singles | None:
    layer = elements.layers.float.get(name)
    return None if layer is None else np.array([element[layer] for element in elements], np.float32)


def read_group_weights(vertices: Collection[Any], group: int) -> Singles:
    """Weights of a vertex group by its index, (n,); 0 where a vertex is not in it."""
    weights = np.zeros(len(vertices), np.float32)
    for index, vertex in enumerate(vertices):
        for element in vertex.groups:
            if element.group == group:
                weights[index] = element.weight
    return weights
