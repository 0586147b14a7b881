# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of a large mesh that touches a box: all that an edit needs of an obstacle that it meets in one place."""

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from stiv.blender.scene.arrays import Floats, Indices, Singles, read_collection, transform_points
from stiv.blender.scene.mesh_reading import read_corners, read_edges, read_loose_numbers, read_positions

FEW = 0.2  # of all triangles: up to this share they are asked for one by one


@dataclass(frozen=True)
class NearFaces:
    """Some faces, loose edges and loose vertices of a mesh.

    Attributes:
        vertices: numbers of all that they use, rising, (n,).
        local: their positions, (n, 3).
        triangles: Blender's triangulation over these vertices, (f, 3).
        faces: the face each triangle belongs to, (f,).
        loose_edges: (l, 2), over these vertices too.
        loose_numbers: their numbers among all edges, (l,).
        size: number of all vertices of the mesh.
    """

    vertices: Indices
    local: Singles
    triangles: Indices
    faces: Indices
    loose_edges: Indices
    loose_numbers: Indices
    size: int


def read_near_faces(mesh: bpy.types.Mesh, matrix: Floats, low: Floats, high: Floats) -> NearFaces:
    """What of a mesh meets a box of the world, `low` to `high`, (3,), and a little beside it.

    matrix: from the mesh to the world, (4, 4). What has a coordinate that is not finite is among them.
    """
    positions = read_positions(mesh)
    sides = _sides_passed(positions, *_box_in(matrix, low, high))
    corners, starts = read_corners(mesh)
    near = np.flatnonzero(np.bitwise_and.reduceat(sides[corners], starts[:-1]) == 0) if len(starts) > 1 else starts[:0]
    triangles, faces = _triangles_of(mesh, near.astype(np.int32), starts)
    loose = read_loose_numbers(mesh)
    edges = read_edges(mesh)[loose] if len(loose) else np.empty((0, 2), np.int32)
    touching = (sides[edges[:, 0]] & sides[edges[:, 1]]) == 0
    edges, loose = edges[touching], loose[touching]
    used = sides == 0  # loose vertices too
    used[triangles] = used[edges] = True
    place = np.cumsum(used, dtype=np.int32) - 1
    vertices = np.flatnonzero(used).astype(np.int32)
    return NearFaces(vertices, positions[vertices], place[triangles], faces, place[edges], loose, len(positions))


def _box_in(matrix: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """A box of the mesh's own frame around a box of the world; everything where the frame is flat."""
    if not np.isfinite(matrix).all() or np.linalg.matrix_rank(matrix[:3, :3]) < 3:
        return np.full(3, -np.inf), np.full(3, np.inf)
    corners: Floats = np.stack(np.meshgrid(*np.stack([low, high], axis=1), indexing="ij"), axis=-1).reshape(-1, 3)
    inverse = np.linalg.inv(matrix).astype(np.float64)
    seen = transform_points(inverse, corners)
    slack = 1e-6 * np.abs(seen).max(axis=0)  # the mesh is stored in single precision
    return seen.min(axis=0) - slack, seen.max(axis=0) + slack


def _sides_passed(points: Singles, low: Floats, high: Floats) -> NDArray[np.uint8]:
    """For each point, (n,), a bit for each of the six sides of a box that it lies beyond (Cohen and Sutherland).

    What has all its points beyond the same side does not touch the box.
    """
    sides = np.zeros(len(points), np.uint8)
    for axis in range(3):
        coordinate = np.ascontiguousarray(points[:, axis])
        sides |= (coordinate < np.float32(low[axis])).astype(np.uint8) << np.uint8(2 * axis)
        sides |= (coordinate > np.float32(high[axis])).astype(np.uint8) << np.uint8(2 * axis + 1)
    return sides


def _triangles_of(mesh: bpy.types.Mesh, faces: Indices, starts: Indices) -> tuple[Indices, Indices]:
    """Blender's triangles of some faces, (f, 3), and the face of each, (f,): n - 2 a face, in the order of faces."""
    mesh.calc_loop_triangles()
    counts = starts[faces + 1] - starts[faces] - 2
    owners = np.repeat(faces, counts)
    within = np.arange(len(owners)) - np.repeat(np.cumsum(counts) - counts, counts)
    rows = starts[owners] - 2 * owners + within
    held = mesh.loop_triangles
    if len(rows) > FEW * len(held):
        return read_collection(held, "vertices", 3, np.int32)[rows], owners
    return np.array([held[row].vertices[:] for row in rows.tolist()], np.int32).reshape(-1, 3), owners
