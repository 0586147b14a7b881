# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads Blender's meshes as arrays."""

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from stiv.blender.scene.arrays import Indices, Singles, read_collection
from stiv.blender.scene.shape_keys import read_mix


@contextmanager
def evaluated_mesh(evaluated: bpy.types.Object) -> Iterator[bpy.types.Mesh]:
    """The mesh of an evaluated object, valid inside the `with` statement.

    In Edit Mode the evaluated data may be an empty shell around the edit mesh (without attributes, and without vertices
    if there is no modifier). In that case a copy is made.
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


def view_positions(mesh: bpy.types.Mesh) -> Singles:
    """As `read_positions`, where Blender stores them: read-only, valid until Blender evaluates again."""
    attribute = mesh.attributes.get("position")
    return read_positions(mesh) if attribute is None else _view(attribute.data, "vector", 3, np.float32)


def view_corner_vertices(mesh: bpy.types.Mesh) -> Indices:
    """As `read_corner_vertices`, where Blender stores them, like `view_positions`."""
    attribute = mesh.attributes.get(".corner_vert")
    return read_corner_vertices(mesh) if attribute is None else _view(attribute.data, "value", 1, np.int32)


def view_corner_edges(mesh: bpy.types.Mesh) -> Indices:
    """The edge of each corner of all faces, stacked, where Blender stores them, like `view_positions`."""
    attribute = mesh.attributes.get(".corner_edge")
    if attribute is None:
        return read_collection(mesh.loops, "edge_index", 1, np.int32)
    return _view(attribute.data, "value", 1, np.int32)


def view_first_corners(mesh: bpy.types.Mesh) -> Indices:
    """The first corner of each face, (F,), where Blender stores them, like `view_positions`.

    Blender's own reading asks for each face, and takes 80 ms for a million.
    """
    faces = mesh.polygons
    found = _view(faces, "loop_start", 1, np.int32)
    last = len(faces) - 1
    samples = sorted({0, last // 3, last // 2, last}) if len(faces) else []
    is_stored = all(found[face] == faces[face].loop_start for face in samples)  # in all known versions
    return found if is_stored else read_collection(faces, "loop_start", 1, np.int32)


def _view(items: Any, name: str, width: int, dtype: type) -> NDArray[Any]:
    """The values of an attribute in Blender's memory; a copy if they do not follow each other there."""
    count, size = len(items), width * np.dtype(dtype).itemsize
    first = items[0].as_pointer() if count else 0
    if count == 0 or items[count - 1].as_pointer() - first != (count - 1) * size:
        return read_collection(items, name, width, dtype)
    memory = memoryview((ctypes.c_char * (count * size)).from_address(first))
    values: NDArray[Any] = np.frombuffer(memory, np.dtype(dtype))
    values.setflags(write=False)
    return values if width == 1 else values.reshape(-1, width)


def read_triangles(mesh: bpy.types.Mesh) -> tuple[Indices, Indices]:
    """Blender's triangulation: corners, (f, 3), and the face of each triangle, (f,)."""
    if len(mesh.loops) == 3 * len(mesh.polygons):  # no face has fewer than three corners, so all are triangles
        return read_corner_vertices(mesh).reshape(-1, 3), np.arange(len(mesh.polygons), dtype=np.int32)
    mesh.calc_loop_triangles()
    sizes = read_collection(mesh.polygons, "loop_total", 1, np.int32)
    faces = np.repeat(np.arange(len(sizes), dtype=np.int32), sizes - 2)  # in the order of faces
    return read_collection(mesh.loop_triangles, "vertices", 3, np.int32), faces


def read_edges(mesh: bpy.types.Mesh) -> Indices:
    """All edges, (e, 2), as stored."""
    attribute = None if mesh.is_editmode else mesh.attributes.get(".edge_verts")  # attributes are empty in Edit Mode
    if attribute is None:
        return read_collection(mesh.edges, "vertices", 2, np.int32)
    return read_collection(attribute.data, "value", 2, np.int32)  # a hundred times faster


def read_loose_numbers(mesh: bpy.types.Mesh) -> Indices:
    """Numbers of the edges without a face, (l,)."""
    used = mesh.attributes.get(".corner_edge")
    if used is None:
        loose = read_collection(mesh.edges, "is_loose", 1, np.bool_)
    else:  # ten times faster
        loose = np.ones(len(mesh.edges), np.bool_)
        loose[read_collection(used.data, "value", 1, np.int32)] = False
    return np.flatnonzero(loose).astype(np.int32)


def read_corners(mesh: bpy.types.Mesh) -> tuple[Indices, Indices]:
    """As `read_faces`, a hundred times faster for evaluated meshes."""
    if mesh.attributes.get(".corner_vert") is None:
        return read_faces(mesh)
    corners = read_corner_vertices(mesh)
    return corners, _read_starts(mesh, len(corners))


def _read_starts(mesh: bpy.types.Mesh, corners: int) -> Indices:
    starts = np.empty(len(mesh.polygons) + 1, np.int32)
    mesh.polygons.foreach_get("loop_start", starts[:-1])
    starts[-1] = corners
    return starts


def read_corner_vertices(mesh: bpy.types.Mesh) -> Indices:
    """The vertex of each corner of all faces, stacked."""
    attribute = mesh.attributes.get(".corner_vert")
    if attribute is None:
        return read_collection(mesh.loops, "vertex_index", 1, np.int32)
    return read_collection(attribute.data, "value", 1, np.int32)


def read_faces(mesh: bpy.types.Mesh) -> tuple[Indices, Indices]:
    """Corners of all faces, stacked, and the first corner of each face followed by the total, (F + 1,)."""
    corners = read_collection(mesh.loops, "vertex_index", 1, np.int32)
    return corners, _read_starts(mesh, len(corners))


def read_creases(mesh: bpy.types.Mesh) -> tuple[Singles | None, Singles | None]:
    """Creases of edges, (E,), and of vertices, (V,); None if there are none."""
    if mesh.is_editmode:  # attributes are empty in Edit Mode
        edited = bmesh.from_edit_mesh(mesh)
        return _edited_creases(edited.edges, "crease_edge"), _edited_creases(edited.verts, "crease_vert")

    def values(name: str) -> Singles | None:
        attribute = mesh.attributes.get(name)
        return None if attribute is None else read_collection(attribute.data, "value", 1, np.float32)

    return values("crease_edge"), values("crease_vert")


def _edited_creases(elements: Any, name: str) -> Singles | None:
    layer = elements.layers.float.get(name)
    return None if layer is None else np.array([element[layer] for element in elements], np.float32)


def read_cage(ob: bpy.types.Object) -> Singles:
    """Local positions of the cage as shown now, (m, 3); in Edit Mode as of the last `update_from_editmode`."""
    if ob.data.shape_keys is not None:
        return read_mix(ob).positions
    return read_collection(ob.data.vertices, "co", 3, np.float32)
