# SPDX-License-Identifier: GPL-3.0-or-later
"""What a line of sight meets first, of what Blender shows."""

from typing import Any

import bpy
import numpy as np

from stiv.blender.scene.arrays import Floats, as_matrix, transform_points

MOST_PASSED = 100  # surfaces of what is looked through
STEP = 1e-6  # of the way to a surface, to be behind it


def first_seen(
    context: bpy.types.Context, origin: Floats, direction: Floats, through: frozenset[str]
) -> tuple[Floats, Floats] | None:
    """The place, (3,), where a ray meets the first surface, and the corners, (k, 3), of the face there.

    Objects named in `through` are passed. None where nothing is met within the length of `direction`.
    """
    depsgraph = context.evaluated_depsgraph_get()
    length = float(np.linalg.norm(direction))
    unit, travelled = direction / length, 0.0
    for _ in range(MOST_PASSED):
        start = origin + travelled * unit
        left = length - travelled
        hit, place, _, face, thing, matrix = context.scene.ray_cast(depsgraph, start, unit, distance=left)
        if not hit:
            return None
        if thing.name not in through:
            return np.array(place), _corners(thing.evaluated_get(depsgraph), face, matrix, np.array(place))
        travelled += float(np.linalg.norm(np.array(place) - start)) * (1 + STEP) + STEP * STEP * length
    return None


def _corners(thing: bpy.types.Object, face: int, matrix: Any, place: Floats) -> Floats:
    """World positions of a face's corners; the place alone where the evaluated mesh does not have the face at hand."""
    mesh = thing.data
    if not isinstance(mesh, bpy.types.Mesh) or not 0 <= face < len(mesh.polygons):
        return place[None]
    local = [mesh.vertices[vertex].co for vertex in mesh.polygons[face].vertices]
    return transform_points(as_matrix(matrix), np.array(local))
