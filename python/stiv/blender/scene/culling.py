# SPDX-License-Identifier: GPL-3.0-or-later
"""Culls obstacles: those outside a box around the moving objects are left out, and large ones are cropped to it."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from stiv.blender.scene.arrays import Floats, Indices, Singles, as_matrix, invert, read_collection, transform_points
from stiv.blender.scene.dependencies import dependencies, find_dependents
from stiv.blender.scene.evaluations import RENDER, SURFACE_TYPES, VIEWPORT, is_visible, signature
from stiv.blender.scene.mesh_reading import read_corners, read_edges, read_loose_numbers, read_positions
from stiv.blender.scene.quad_diagonals import QuadDiagonals
from stiv.blender.settings import EditSettings

MIN_FACES = 50_000  # of all obstacles; smaller scenes are not culled
MIN_CROPPED_FACES = 20_000  # faces of one obstacle; smaller ones are not cropped
GROWTH = 0.5  # of the box of the moving objects on each side, in its diagonals
MARGIN = 0.01  # in sizes of the box, between the moving objects and its sides


@dataclass(frozen=True)
class CullingBox:
    """A box from `low` to `high`, (3,), which the moving surface must not leave.

    Objects in `left_out` do not touch the box. For objects in `cropped`, only the faces that touch it are read.
    """

    low: Floats
    high: Floats
    left_out: frozenset[str]
    cropped: frozenset[str]
    separation: float = 0.0

    def box_of(self, name: str) -> tuple[Floats, Floats] | None:
        """The box to which the named object is cropped, (3,) and (3,); None if it is not cropped."""
        return (self.low, self.high) if name in self.cropped else None

    def contains(self, points: Floats) -> bool:
        """Are all points, (n, 3), inside the box by a margin and twice the separation?"""
        margin = MARGIN * float(np.linalg.norm(self.high - self.low)) + 2 * self.separation
        return bool(((points >= self.low + margin) & (points <= self.high - margin)).all())


def find_culling_box(
    context: bpy.types.Context,
    moving_names: Collection[str],
    settings: EditSettings,
    beyond: Floats = np.empty((0, 3)),  # noqa: B008 (never written)
) -> CullingBox | None:
    """Find the box beyond which obstacles are not read: that of the moving objects, grown by half of its diagonal.

    Returns None if culling saves nothing.

    moving_names: of the objects that move. beyond: further points, (n, 3), that the box includes. Only independent
    meshes are left out or cropped. Objects with parents, children, modifiers or constraints that refer to others,
    instancers, and objects named in the settings are always read.
    """
    objects = [ob for ob in context.view_layer.objects if is_visible(context, ob)]
    candidates = [ob for ob in objects if _is_independent(ob) and _is_rendered_alike(ob, context.scene)]
    if sum(len(ob.data.polygons) for ob in candidates) < MIN_FACES:
        return None
    named = {*settings.named_objects(), *settings.excluded.shapes}
    linked = find_dependents(objects, set(moving_names))
    depsgraph = context.evaluated_depsgraph_get()
    moving = [_box(ob, depsgraph) for ob in objects if ob.name in linked and ob.type in SURFACE_TYPES]
    if not moving:
        return None
    low = np.min([*(box[0] for box in moving), *beyond], axis=0)
    high = np.max([*(box[1] for box in moving), *beyond], axis=0)
    size = GROWTH * float(np.linalg.norm(high - low)) + 2 * settings.separation
    low, high = low - size, high + size
    free = [ob for ob in candidates if ob.name not in linked | named]
    distant = frozenset(ob.name for ob in free if _are_apart(_box(ob, depsgraph), (low, high)))
    cropped = frozenset(
        ob.name for ob in free
        if ob.name not in distant and len(ob.data.polygons) >= MIN_CROPPED_FACES
        and not _contains((low, high), _box(ob, depsgraph))
    )  # fmt: skip
    return CullingBox(low, high, distant, cropped, settings.separation) if distant or cropped else None


def _is_independent(ob: bpy.types.Object) -> bool:
    alone = ob.type == "MESH" and ob.mode == "OBJECT" and ob.instance_type == "NONE"
    return bool(alone and ob.parent is None and not ob.children and not any(dependencies(ob)))


def _is_rendered_alike(ob: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """Is the render like the viewport, so that the bounds are those of both?"""
    return signature(ob, scene, VIEWPORT) == signature(ob, scene, RENDER)


def _box(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> tuple[Floats, Floats]:
    """World bounds of an evaluated object, (3,) each."""
    evaluated = ob.evaluated_get(depsgraph)
    corners = transform_points(
        as_matrix(evaluated.matrix_world), np.array([list(each) for each in evaluated.bound_box])
    )
    return corners.min(axis=0), corners.max(axis=0)


def _contains(outer: tuple[Floats, Floats], inner: tuple[Floats, Floats]) -> bool:
    return bool((outer[0] <= inner[0]).all() and (inner[1] <= outer[1]).all())


def _are_apart(a: tuple[Floats, Floats], b: tuple[Floats, Floats]) -> bool:
    return bool((a[0] > b[1]).any() or (b[0] > a[1]).any())


SINGLE_READS = 0.2  # of all triangles; up to this fraction they are read one by one


@dataclass(frozen=True)
class CroppedMesh:
    """Some faces, loose edges and loose vertices of a mesh.

    Attributes:
        vertices: ascending vertex numbers, (n,).
        local: positions, (n, 3).
        triangles: Blender's triangulation, indices into `vertices`, (f, 3).
        faces: face of each triangle, (f,).
        loose_edges: indices into `vertices`, (l, 2).
        loose_numbers: edge number of each loose edge, (l,).
        size: number of vertices of the whole mesh.
    """

    vertices: Indices
    local: Singles
    triangles: Indices
    faces: Indices
    loose_edges: Indices
    loose_numbers: Indices
    size: int


def read_cropped_mesh(mesh: bpy.types.Mesh, matrix: Floats, low: Floats, high: Floats) -> CroppedMesh:
    """Read the elements of a mesh that touch a world box, `low` to `high`, (3,), with a small tolerance.

    matrix: from the mesh to the world, (4, 4). Elements with coordinates that are not finite are included.
    """
    positions = read_positions(mesh)
    sides = _outcodes(positions, *_local_box(matrix, low, high))
    corners, starts = read_corners(mesh)
    cropped = (
        np.flatnonzero(np.bitwise_and.reduceat(sides[corners], starts[:-1]) == 0) if len(starts) > 1 else starts[:0]
    )
    triangles, faces = _triangles_of(mesh, positions, cropped.astype(np.int32), corners, starts)
    loose = read_loose_numbers(mesh)
    edges = read_edges(mesh)[loose] if len(loose) else np.empty((0, 2), np.int32)
    touching = (sides[edges[:, 0]] & sides[edges[:, 1]]) == 0
    edges, loose = edges[touching], loose[touching]
    used = sides == 0  # loose vertices are included
    used[triangles] = used[edges] = True
    place = np.cumsum(used, dtype=np.int32) - 1
    vertices = np.flatnonzero(used).astype(np.int32)
    return CroppedMesh(vertices, positions[vertices], place[triangles], faces, place[edges], loose, len(positions))


def _local_box(matrix: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Bounds in the mesh's frame of a world box; infinite if the frame is singular."""
    if not np.isfinite(matrix).all() or np.linalg.matrix_rank(matrix[:3, :3]) < 3:
        return np.full(3, -np.inf), np.full(3, np.inf)
    corners: Floats = np.stack(np.meshgrid(*np.stack([low, high], axis=1), indexing="ij"), axis=-1).reshape(-1, 3)
    inverse = invert(matrix)
    seen = transform_points(inverse, corners)
    slack = 1e-6 * np.abs(seen).max(axis=0)  # the mesh is stored in single precision
    return seen.min(axis=0) - slack, seen.max(axis=0) + slack


def _outcodes(points: Singles, low: Floats, high: Floats) -> NDArray[np.uint8]:
    """Outcode of each point, (n,): a bit for each side of the box beyond which it lies (Cohen and Sutherland).

    An element whose points share a bit does not touch the box.
    """
    sides = np.zeros(len(points), np.uint8)
    for axis in range(3):
        coordinate = np.ascontiguousarray(points[:, axis])
        sides |= (coordinate < np.float32(low[axis])).astype(np.uint8) << np.uint8(2 * axis)
        sides |= (coordinate > np.float32(high[axis])).astype(np.uint8) << np.uint8(2 * axis + 1)
    return sides


def _triangles_of(
    mesh: bpy.types.Mesh, positions: Singles, faces: Indices, corners: Indices, starts: Indices
) -> tuple[Indices, Indices]:
    """Blender's triangles of some faces, (f, 3), and the face of each, (f,), in the order of faces.

    Those of triangles and of quads that certainly have the first diagonal follow from their corners: to read them from
    a mesh of ten million triangles takes a second.
    """
    counts = starts[faces + 1] - starts[faces] - 2
    owners = np.repeat(faces, counts)
    first = np.cumsum(counts) - counts
    triangles = np.empty((len(owners), 3), np.int32)
    small, quads = np.flatnonzero(counts == 1), np.flatnonzero(counts == 2)
    triangles[first[small]] = corners[starts[faces[small]][:, None] + np.arange(3)]
    around = corners[starts[faces[quads]] + np.arange(4)[:, None]]
    triangles[first[quads]], triangles[first[quads] + 1] = around[:3].T, around[[0, 2, 3]].T
    uncertain = QuadDiagonals(around, np.zeros(len(quads), np.bool_)).find_uncertain(positions)
    unknown = np.repeat(counts > 2, counts)
    unknown[np.add.outer(first[quads[uncertain]], np.arange(2))] = True
    within = np.arange(len(owners)) - np.repeat(first, counts)
    triangles[unknown] = _read_rows(mesh, (starts[owners] - 2 * owners + within)[unknown])
    return triangles, owners


def _read_rows(mesh: bpy.types.Mesh, rows: Indices) -> Indices:
    """Some triangles of Blender's triangulation, (f, 3)."""
    if len(rows) == 0:
        return np.empty((0, 3), np.int32)
    mesh.calc_loop_triangles()
    held = mesh.loop_triangles
    if len(rows) > SINGLE_READS * len(held):
        return read_collection(held, "vertices", 3, np.int32)[rows]
    return np.array([held[row].vertices[:] for row in rows.tolist()], np.int32).reshape(-1, 3)
