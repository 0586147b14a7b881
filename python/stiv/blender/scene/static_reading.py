# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads meshes that stay as they are during an edit, once for all edits between which their data is equal."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from typing import Any

import bpy
import numpy as np

import stiv
from stiv.blender.scene.arrays import Floats, Indices, Singles, as_matrix, read_collection, transform_points
from stiv.blender.scene.deferred_meshes import EqualMeshes
from stiv.blender.scene.evaluated_scene import check_finite_positions
from stiv.blender.scene.evaluations import SHOWN
from stiv.blender.scene.mesh_reading import read_edges, view_corner_edges, view_corner_vertices, view_positions
from stiv.blender.scene.open_evaluations import OpenEvaluations
from stiv.blender.scene.quad_diagonals import QuadDiagonals
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.static_mesh import StaticMesh

_latest: dict[tuple[ObjectReference, str, int], StaticMesh] = {}


def read_static_meshes(
    context: bpy.types.Context, names: Collection[str], shown_in: frozenset[str]
) -> tuple[StaticMesh, ...]:
    """Read the meshes of the named objects as shown now. Those whose data equals the last reading's are returned again.

    shown_in: the guarded evaluations. Raises InputError as `read_scene` does.
    """
    global _latest
    found: dict[tuple[ObjectReference, str, int], StaticMesh] = {}
    counts: Counter[ObjectReference] = Counter()
    equal = EqualMeshes(context.evaluated_depsgraph_get())
    for instance, owner, source in OpenEvaluations(context).instances(SHOWN, lambda ob: ob.name in names):
        reference = ObjectReference.of(owner)
        counts[reference] += 1
        key = (reference, source.name, counts[reference])
        reader = _Reader(equal.representative(instance.object).data, as_matrix(instance.matrix_world))
        known = _latest.get(key)
        if known is None or known.shown_in != shown_in or not reader.agrees_with(known):
            known = reader.read(reference, source.name, shown_in)
        found[key] = known
    _latest = found
    return tuple(found.values())


def forget_static_meshes() -> None:
    """Free the memory of the last reading."""
    global _latest
    _latest = {}


class _Reader:
    """An evaluated mesh, whose arrays are viewed in place until they have to be copied."""

    def __init__(self, mesh: bpy.types.Mesh, matrix: Floats) -> None:
        self._mesh, self._matrix = mesh, matrix
        self._local, self._corners = view_positions(mesh), view_corner_vertices(mesh)
        self._starts: Indices | None = None
        if len(self._corners) != 3 * len(mesh.polygons):  # no face has fewer than three corners
            self._starts = np.append(read_collection(mesh.polygons, "loop_start", 1, np.int32), len(self._corners))
        self._loose = _loose_edges(mesh)

    def agrees_with(self, known: StaticMesh) -> bool:
        """Are all values equal to those of an earlier reading?"""
        loose_edges, loose_numbers = self._loose
        pairs = (
            (self._matrix, known.matrix), (self._local, known.local), (self._corners, known.corners),
            (loose_edges, known.loose_edges), (loose_numbers, known.loose_numbers),
        )  # fmt: skip
        if (self._starts is None) != (known.starts is None):
            return False
        faces = self._starts is None or np.array_equal(self._starts, np.asarray(known.starts))
        return faces and all(np.array_equal(ours, theirs) for ours, theirs in pairs)

    def read(self, owner: ObjectReference, source: str, shown_in: frozenset[str]) -> StaticMesh:
        """Make the obstacle."""
        check_finite_positions(owner.name, self._matrix, self._local)
        loose_edges, loose_numbers = self._loose
        triangles, loose_vertices = self._triangles(), self._loose_vertices()
        drawn = [triangles, loose_edges[:, [0, 1, 1]], np.repeat(loose_vertices[:, None], 3, axis=1)]
        whole = np.concatenate(drawn) if len(loose_edges) or len(loose_vertices) else triangles
        obstacle = stiv.Obstacle(transform_points(self._matrix, self._local), whole, owner.name)
        is_triangulated = self._starts is None
        corners = obstacle.triangles[: len(triangles)].reshape(-1) if is_triangulated else self._corners.copy()
        return StaticMesh(
            owner, source, self._local.copy(), self._matrix, corners, self._starts, loose_edges, loose_numbers,
            loose_vertices, shown_in, obstacle,
        )  # fmt: skip

    def _triangles(self) -> Indices:
        if self._starts is None:
            return self._corners.reshape(-1, 3)
        return triangulate(self._mesh, self._local, self._corners, self._starts)

    def _loose_vertices(self) -> Indices:
        loose = np.ones(len(self._local), np.bool_)
        loose[self._corners] = loose[self._loose[0]] = False
        return np.flatnonzero(loose).astype(np.int32)


def _loose_edges(mesh: bpy.types.Mesh) -> tuple[Indices, Indices]:
    """The edges without a face, (l, 2), and their numbers, (l,)."""
    loose = np.ones(len(mesh.edges), np.bool_)
    loose[view_corner_edges(mesh)] = False
    numbers = np.flatnonzero(loose).astype(np.int32)
    return read_edges(mesh)[numbers] if len(numbers) else np.empty((0, 2), np.int32), numbers


FACES_AT_ONCE = 1 << 15  # so that all intermediate values stay in the cache
SINGLE_READS = 0.2  # of all triangles; up to this fraction they are read one by one


def triangulate(mesh: bpy.types.Mesh, positions: Singles, corners: Indices, starts: Indices) -> Indices:
    """Blender's triangles, (f, 3), in the order of faces.

    Those of triangles and of quads that certainly have the first diagonal follow from their corners: to read them from
    a mesh of ten million triangles takes a second.
    """
    firsts = starts - 2 * np.arange(len(starts), dtype=np.int32)  # of the triangles of each face
    triangles, unknown = np.empty((int(firsts[-1]), 3), np.int32), []
    for begin in range(0, len(starts) - 1, FACES_AT_ONCE):
        end = min(begin + FACES_AT_ONCE, len(starts) - 1)
        counts = np.diff(firsts[begin : end + 1])
        small, quads = (begin + np.flatnonzero(counts == size) for size in (1, 2))
        if len(small):
            triangles[firsts[small]] = corners[starts[small][:, None] + np.arange(3)]
        if len(quads):
            around, rows = corners[starts[quads] + np.arange(4)[:, None]], firsts[quads]
            triangles[rows], triangles[rows + 1] = around[:3].T, around[[0, 2, 3]].T
            uncertain = quads[_may_have_second_diagonal(positions, around)]
            unknown.append((firsts[uncertain][:, None] + np.arange(2)).ravel())
        large = begin + np.flatnonzero(counts > 2)
        if len(large):
            unknown.append(np.concatenate([np.arange(firsts[face], firsts[face + 1]) for face in large]))
    rows = np.concatenate([np.empty(0, np.int64), *unknown])
    if len(rows):
        triangles[rows] = _read_rows(mesh, rows)
    return triangles


def _may_have_second_diagonal(positions: Singles, around: Indices) -> Indices:
    """Numbers of the quads, with corners (4, k), that Blender may split along their second diagonal."""
    own = np.arange(around.size, dtype=np.int32).reshape(around.shape)
    quads = QuadDiagonals(own, np.zeros(around.shape[1], np.bool_))
    return quads.find_uncertain(positions[around.ravel()])


def _read_rows(mesh: bpy.types.Mesh, rows: Any) -> Indices:
    """Some triangles of Blender's triangulation, (f, 3)."""
    mesh.calc_loop_triangles()
    held = mesh.loop_triangles
    if len(rows) > SINGLE_READS * len(held):
        found: Indices = read_collection(held, "vertices", 3, np.int32)[rows]
        return found
    return np.array([held[row].vertices[:] for row in rows.tolist()], np.int32).reshape(-1, 3)
