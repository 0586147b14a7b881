# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads meshes that stay as they are during an edit, once for all edits between which their data is equal."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Collection, Hashable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import bpy
import numpy as np

import stiv
from stiv.blender.scene.arrays import Floats, Indices, Singles, as_matrix, read_collection, transform_points
from stiv.blender.scene.deferred_meshes import EqualMeshes, mesh_key
from stiv.blender.scene.evaluated_scene import check_finite_positions
from stiv.blender.scene.evaluations import SHOWN
from stiv.blender.scene.mesh_reading import (
    read_edges,
    view_corner_edges,
    view_corner_vertices,
    view_first_corners,
    view_positions,
)
from stiv.blender.scene.open_evaluations import OpenEvaluations
from stiv.blender.scene.quad_diagonals import QuadDiagonals
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.static_mesh import StaticMesh, StaticShape
from stiv.task import Steps

TURN = 0.1  # seconds of reading between two turns of a waiting caller
Key = tuple[ObjectReference, str, int]  # owner, name of the object with the data, number among those of the owner
_latest: dict[Key, StaticMesh] = {}


def read_static_meshes(
    context: bpy.types.Context, names: Collection[str], shown_in: frozenset[str]
) -> tuple[StaticMesh, ...]:
    """Read the meshes of the named objects as shown now. Those whose data equals the last reading's are returned again.

    shown_in: the guarded evaluations. Raises InputError as `read_scene` does.
    """
    global _latest
    found: dict[Key, StaticMesh] = {}
    readers = _Readers(context)
    for key, shown, matrix in _visible(context, names):
        reader, known = readers.reader(shown), _latest.get(key)
        if known is None or not _is_current(known, reader, matrix):
            known = _make(reader, key, matrix, shown_in)
        found[key] = known if known.shown_in == shown_in else replace(known, shown_in=shown_in)
    _latest = found
    return tuple(found.values())


def find_changed(context: bpy.types.Context, meshes: Sequence[StaticMesh]) -> str:
    """The name of an object that shows other meshes now than when they were read; "" without any."""
    left, readers = {(each.owner, each.source, each.number): each for each in meshes}, _Readers(context)
    for key, shown, matrix in _visible(context, {each.owner.name for each in meshes}):
        known = left.pop(key, None)
        if known is None or not _is_current(known, readers.reader(shown), matrix):
            return key[0].name
    return next((owner.name for owner, _, _ in left), "")


def _is_current(known: StaticMesh, reader: _Reader, matrix: Floats) -> bool:
    """Does Blender still show the mesh that was read?"""
    return np.array_equal(matrix, known.matrix) and reader.agrees_with(known.shape)


def prepare_static_meshes_steps(context: bpy.types.Context, names: Collection[str]) -> Steps[None]:
    """Steps that read the meshes of the named objects that the last reading lacks, for `read_static_meshes`.

    That compares all data once more: Blender may change it between steps.
    """
    done, shapes = set[Key](), dict[Hashable, StaticShape]()
    while not _prepare_some(context, names, done, shapes):
        yield None


def _prepare_some(
    context: bpy.types.Context, names: Collection[str], done: set[Key], shapes: dict[Hashable, StaticShape]
) -> bool:
    """Read for a turn; return whether all are read. done, shapes: those of earlier turns; extended.

    The turn begins at the first mesh that is left: to get there takes long beside thousands of objects.
    """
    end = 0.0
    readers = _Readers(context, shapes)
    for key, shown, matrix in _visible(context, names):
        if key in done:
            continue
        end = end or time.perf_counter() + TURN
        done.add(key)
        if not _is_likely_known(key, shown, matrix):
            _latest[key] = _make(readers.reader(shown), key, matrix, frozenset())
        if time.perf_counter() > end:
            readers.keep_shapes()
            return False
    return True


def _is_likely_known(key: Key, shown: bpy.types.Object, matrix: Floats) -> bool:
    known = _latest.get(key)
    return known is not None and np.array_equal(matrix, known.matrix) and known.vertex_count == len(shown.data.vertices)


def _visible(context: bpy.types.Context, names: Collection[str]) -> Iterator[tuple[Key, bpy.types.Object, Floats]]:
    """Each mesh that one of the named objects shows: the key, the evaluated object, and its placement, (4, 4)."""
    counts: Counter[ObjectReference] = Counter()
    for instance, owner, source in OpenEvaluations(context).instances(SHOWN, lambda ob: ob.name in names):
        reference = ObjectReference.of(owner)
        yield (reference, source.name, counts[reference]), instance.object, as_matrix(instance.matrix_world)
        counts[reference] += 1


def forget_static_meshes() -> None:
    """Free the memory of the last reading."""
    global _latest
    _latest = {}


def _make(reader: _Reader, key: Key, matrix: Floats, shown_in: frozenset[str]) -> StaticMesh:
    owner, source, number = key
    shape = reader.shape
    check_finite_positions(owner.name, matrix, shape.local)
    obstacle = stiv.Obstacle(transform_points(matrix, shape.local), shape.triangles, owner.name)
    return StaticMesh(owner, source, number, shape, matrix, shown_in, obstacle)


class _Readers:
    """Makes one reader for all objects that show the same mesh."""

    def __init__(self, context: bpy.types.Context, shapes: dict[Hashable, StaticShape] | None = None) -> None:
        """Take shapes of earlier readings that are still equal."""
        self._shapes = {} if shapes is None else shapes
        self._depsgraph = context.evaluated_depsgraph_get()
        self._equal = EqualMeshes(self._depsgraph)
        self._known: dict[Hashable, _Reader] = {}

    def reader(self, shown: bpy.types.Object) -> _Reader:
        """The reader of an evaluated object's mesh."""
        key = mesh_key(shown) or self._address(shown)
        if key is None:
            return _Reader(shown.data)
        if key not in self._known:
            self._known[key] = _Reader(self._equal.representative(shown).data, self._shapes.get(key))
        return self._known[key]

    def keep_shapes(self) -> None:
        """Keep all shapes that have been read, for later readings."""
        self._shapes.update((key, reader.shape) for key, reader in self._known.items())

    def _address(self, shown: bpy.types.Object) -> int | None:
        """Where Blender stores the mesh; None if it may end with the instance that shows it."""
        address: int = shown.data.as_pointer()
        own = shown.original.evaluated_get(self._depsgraph).data
        return address if own is not None and own.as_pointer() == address else None


class _Reader:
    """An evaluated mesh, whose arrays are viewed in place until they have to be copied."""

    def __init__(self, mesh: bpy.types.Mesh, earlier: StaticShape | None = None) -> None:
        self._mesh = mesh
        self._earlier = earlier
        self._agreeing: dict[int, bool] = {}

    @cached_property
    def _local(self) -> Singles:
        return view_positions(self._mesh)

    @cached_property
    def _corners(self) -> Indices:
        return view_corner_vertices(self._mesh)

    @cached_property
    def _starts(self) -> Indices | None:
        """First corner of each face, then the number of corners; None if all faces are triangles."""
        if len(self._corners) == 3 * len(self._mesh.polygons):  # no face has fewer than three corners
            return None
        return np.append(view_first_corners(self._mesh), np.int32(len(self._corners)))

    @cached_property
    def _loose(self) -> tuple[Indices, Indices]:
        return _loose_edges(self._mesh)

    def agrees_with(self, known: StaticShape) -> bool:
        """Are all values equal to those of an earlier reading? Compared once for all instances that share it."""
        if id(known) not in self._agreeing:
            self._agreeing[id(known)] = self._equals(known)
        return self._agreeing[id(known)]

    def _equals(self, known: StaticShape) -> bool:
        loose_edges, loose_numbers = self._loose
        pairs = (
            (self._local, known.local), (self._corners, known.corners), (self._starts, known.starts),
            (loose_edges, known.loose_edges), (loose_numbers, known.loose_numbers),
        )  # fmt: skip
        return all(_are_equal(ours, theirs) for ours, theirs in pairs)

    @cached_property
    def shape(self) -> StaticShape:
        """A copy of all elements, or the earlier one if it is equal."""
        if self._earlier is not None and self.agrees_with(self._earlier):
            return self._earlier
        loose_edges, loose_numbers = self._loose
        triangles, loose_vertices = self._triangles(), self._loose_vertices()
        drawn = [triangles, loose_edges[:, [0, 1, 1]], np.repeat(loose_vertices[:, None], 3, axis=1)]
        whole = np.concatenate(drawn)
        corners = whole[: len(triangles)].reshape(-1) if self._starts is None else self._corners.copy()
        return StaticShape(self._local.copy(), corners, self._starts, loose_edges, loose_numbers, loose_vertices, whole)

    def _triangles(self) -> Indices:
        if self._starts is None:
            return self._corners.reshape(-1, 3)
        return triangulate(self._mesh, self._local, self._corners, self._starts)

    def _loose_vertices(self) -> Indices:
        loose = np.ones(len(self._local), np.bool_)
        loose[self._corners] = loose[self._loose[0]] = False
        return np.flatnonzero(loose).astype(np.int32)


def _are_equal(ours: Indices | Singles | None, theirs: Indices | Singles | None) -> bool:
    if ours is None or theirs is None:
        return ours is theirs
    return np.array_equal(ours, theirs)


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
