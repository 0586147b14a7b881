# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts that a tool added to a mesh: duplicates in Edit Mode, primitives added there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from stiv.blender.guard.scene_state import ObjectState
from stiv.blender.scene.arrays import Flags, Indices, islands
from stiv.blender.scene.evaluated_scene import VisibleMesh


def find_new_part(before: ObjectState, after: ObjectState, edges: Indices) -> Flags | None:
    """Flags of the vertices, (n,), that a tool added to a mesh; None if it changed or connected others.

    edges: those after the tool, (e, 2). Blender appends new vertices to the others.
    """
    if before.points is None or after.points is None or len(after.points) <= len(before.points):
        return None
    count = len(before.points)
    added: Flags = np.arange(len(after.points)) >= count
    if not np.array_equal(after.points[:count], before.points) or joins_others(edges, added):
        return None
    return added


def joins_others(edges: Indices, part: Flags) -> bool:
    """Does any edge, (e, 2), join a vertex of a part and another one?"""
    return bool((part[edges[:, 0]] != part[edges[:, 1]]).any())


def copied_from(selected: Indices, added: Flags, edges: Indices) -> Indices | None:
    """The vertex, (k,), of which each added one is a copy; None without copies of the selected vertices.

    selected: numbers in ascending order, before the tool. Blender copies in this order.
    """
    first = len(added) - int(added.sum())
    if len(selected) != len(added) - first:
        return None
    new = added[edges[:, 0]]
    copied = np.sort(selected[edges[new] - first], axis=1)
    known = {pair.tobytes() for pair in np.sort(edges[~new], axis=1)}
    return selected if all(pair.tobytes() in known for pair in copied.astype(edges.dtype)) else None


def split_parts(meshes: tuple[VisibleMesh, ...], parts: Mapping[str, Flags]) -> list[tuple[VisibleMesh, bool]]:
    """The meshes, with each part as a mesh of its own and true beside it.

    parts: flags of vertices of the cage, by object. A mesh that does not show its cage's components is not split.
    """
    split = []
    for mesh in meshes:
        flags = _shown_part(mesh, parts[mesh.owner.name]) if mesh.owner.name in parts else None
        split += [(mesh, False)] if flags is None else [(_only(mesh, flags), True), (_only(mesh, ~flags), False)]
    return split


def _shown_part(mesh: VisibleMesh, flags: Flags) -> Flags | None:
    """Flags of the vertices that show a part of the cage, (n,); Blender's modifiers keep the cage's vertices first."""
    if mesh.strands is not None or mesh.is_instance or mesh.cropped is not None or len(mesh.local) < len(flags):
        return None
    if len(mesh.local) == len(flags):
        return flags
    sides = np.concatenate([mesh.triangles[:, :2], mesh.triangles[:, 1:], mesh.loose_edges])
    labels = islands(len(mesh.local), sides)
    shown: Flags = np.isin(labels, labels[: len(flags)][flags])
    return shown if np.array_equal(shown[: len(flags)], flags) else None


def _only(mesh: VisibleMesh, flags: Flags) -> VisibleMesh:
    """A mesh of some vertices and their elements."""
    number = np.cumsum(flags, dtype=np.int32) - 1
    faces, edges = flags[mesh.triangles].all(axis=1), flags[mesh.loose_edges].all(axis=1)
    return replace(
        mesh,
        local=mesh.local[flags],
        triangles=number[mesh.triangles[faces]].astype(np.int32),
        faces=mesh.faces[faces],
        loose_edges=number[mesh.loose_edges[edges]].astype(np.int32),
        loose_numbers=mesh.loose_numbers[edges],
    )
