# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes in Blender for tests that compare with Blender's evaluation. Import bpy first."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from tests.deformation.cages import CageCase

Floats = NDArray[np.float64]


def read(collection: Any, attribute: str, width: int = 3) -> Floats:
    """An attribute of all elements of a collection, (N, width) as stored."""
    values = np.empty(len(collection) * width, np.float32)
    collection.foreach_get(attribute, values)
    return values.astype(np.float64).reshape(-1, width)


def new_mesh(case: CageCase) -> Any:
    """A mesh of the case, with its creases."""
    mesh = bpy.data.meshes.new("cage")
    mesh.from_pydata(case.vertices.tolist(), case.loose_edges, case.faces)
    mesh.update()
    if case.edge_crease:
        creases = [case.edge_crease.get(tuple(sorted(e.vertices)), 0.0) for e in mesh.edges]  # type: ignore[arg-type]
        mesh.attributes.new("crease_edge", "FLOAT", "EDGE").data.foreach_set("value", creases)
    if case.vertex_crease:
        creases = [case.vertex_crease.get(v, 0.0) for v in range(len(case.vertices))]
        mesh.attributes.new("crease_vert", "FLOAT", "POINT").data.foreach_set("value", creases)
    return mesh


@contextmanager
def linked(mesh: Any) -> Iterator[Any]:
    """An object with this mesh in the scene, removed afterwards."""
    item = bpy.data.objects.new("object", mesh)
    bpy.context.collection.objects.link(item)
    try:
        yield item
    finally:
        bpy.data.objects.remove(item)
        bpy.data.meshes.remove(mesh)


def evaluated_positions(item: Any) -> Floats:
    """Vertices of the evaluated mesh in object space, (N, 3)."""
    bpy.context.view_layer.update()
    return read(item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.vertices, "co")


def cage_of(mesh: Any) -> stiv.Cage:
    """The cage as stored in the mesh."""
    crease_edge, crease_vert = mesh.attributes.get("crease_edge"), mesh.attributes.get("crease_vert")
    return stiv.Cage.of_faces(
        [tuple(face.vertices) for face in mesh.polygons],
        len(mesh.vertices),
        np.array([tuple(edge.vertices) for edge in mesh.edges], int).reshape(-1, 2),
        None if crease_edge is None else read(crease_edge.data, "value", 1).ravel(),
        None if crease_vert is None else read(crease_vert.data, "value", 1).ravel(),
    )


def size_of(vertices: Floats) -> float:
    """The diagonal of the box around the vertices."""
    return float(np.linalg.norm(np.ptp(vertices, axis=0)))
