# SPDX-License-Identifier: GPL-3.0-or-later
"""Casts rays at what Blender shows."""

from typing import Any

import bpy
import numpy as np

from stiv.blender.scene.arrays import Floats, as_matrix, transform_points

MAX_PASSED = 100  # surfaces of transparent objects
STEP = 1e-6  # of the distance to a surface, to continue behind it


def first_hit(
    context: bpy.types.Context, origin: Floats, direction: Floats, through: frozenset[str]
) -> tuple[Floats, Floats] | None:
    """Point, (3,), where a ray hits the first surface, and the corners, (k, 3), of that face.

    The ray passes through objects named in `through`. None if it hits nothing within the length of `direction`.
    """
    depsgraph = context.evaluated_depsgraph_get()
    length = float(np.linalg.norm(direction))
    unit, travelled = direction / length, 0.0
    for _ in range(MAX_PASSED):
        start = origin + travelled * unit
        left = length - travelled
        hit, place, _, face, shown, matrix = context.scene.ray_cast(depsgraph, start, unit, distance=left)
        if not hit:
            return None
        if shown.name not in through:
            return np.array(place), _corners(shown.evaluated_get(depsgraph), face, matrix, np.array(place))
        travelled += float(np.linalg.norm(np.array(place) - start)) * (1 + STEP) + STEP * STEP * length
    return None


def _corners(shown: bpy.types.Object, face: int, matrix: Any, place: Floats) -> Floats:
    """World positions of a face's corners; the hit point alone if the evaluated mesh does not have the face."""
    mesh = shown.data
    if not isinstance(mesh, bpy.types.Mesh) or not 0 <= face < len(mesh.polygons):
        return place[None]
    local = [mesh.vertices[vertex].co for vertex in mesh.polygons[face].vertices]
    return transform_points(as_matrix(matrix), np.array(local))
