# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that Edit Mode and Object Mode show alike: edits solve for one of both, and read both after each write."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace

import bpy
import numpy as np

from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.evaluated_scene import EvaluatedPositions, VisibleMesh, read_positions_of
from stiv.blender.scene.evaluations import SHOWN, VIEWPORT, signature
from stiv.blender.scene.open_evaluations import OpenEvaluations
from stiv.blender.scene.references import SceneChangedError

Placed = list[EvaluatedPositions | None]  # of each mesh of an assembly; None for strands
COMPARED = ("local", "matrix", "triangles", "loose_edges")


def merge_modes(meshes: Sequence[VisibleMesh], scene: bpy.types.Scene) -> tuple[VisibleMesh, ...]:
    """Merge each mesh of Object Mode into that of the present mode, if modifiers and all values are equal.

    Equal values alone are not enough. A modifier that Edit Mode hides may begin to act when the mesh moves. An empty
    shape key moves the mesh of Object Mode by its value only.
    """
    counts = Counter((mesh.owner, mesh.read_from) for mesh in meshes)
    apart = {mesh.owner: mesh for mesh in meshes if mesh.read_from == VIEWPORT}
    result: list[VisibleMesh] = []
    left_out: list[VisibleMesh] = []
    for mesh in meshes:
        other = apart.get(mesh.owner) if mesh.read_from == SHOWN else None
        is_single = other is not None and counts[mesh.owner, SHOWN] == counts[mesh.owner, VIEWPORT] == 1
        if other is not None and is_single and _are_alike(mesh, other, scene):
            left_out.append(other)
            result.append(replace(mesh, shown_in=mesh.shown_in | other.shown_in, also_in=frozenset({VIEWPORT})))
        else:
            result.append(mesh)
    return tuple(mesh for mesh in result if not any(mesh is other for other in left_out))


def read_apart(assembly: Assembly, placed: Placed, opened: OpenEvaluations) -> Iterator[tuple[Assembly, Placed]]:
    """The assembly and positions as another evaluation shows its merged meshes, unless they still agree to the last
    bit with the positions `placed`. Raises SceneChangedError if one of them is gone or has another size.
    """
    numbers = [number for number, mesh in enumerate(assembly.meshes) if VIEWPORT in mesh.also_in]
    if not numbers or VIEWPORT not in opened.read_from:
        return
    owners = frozenset(assembly.meshes[number].owner.session_uid for number in numbers)
    found = {each.owner: each for each in read_positions_of(owners, opened, VIEWPORT)}
    meshes, other = list(assembly.meshes), list(placed)
    for number in numbers:
        mesh, each = meshes[number], found.get(meshes[number].owner)
        if each is None or len(each.local) != mesh.size:
            raise SceneChangedError("objects were shown, hidden or changed during the edit; begin again")
        meshes[number] = replace(mesh, read_from=VIEWPORT)
        other[number] = each if mesh.cropped is None else each.limited_to(mesh.cropped.vertices)
    if any(not _agree(placed[number], other[number]) for number in numbers):
        yield replace(assembly, meshes=tuple(meshes)), other


def _are_alike(mesh: VisibleMesh, other: VisibleMesh, scene: bpy.types.Scene) -> bool:
    ob = mesh.owner.find()
    if ob.type == "MESH" and ob.data.shape_keys is not None:
        return False
    return signature(ob, scene, SHOWN) == signature(ob, scene, VIEWPORT) and all(
        np.array_equal(getattr(mesh, name), getattr(other, name)) for name in COMPARED
    )


def _agree(one: EvaluatedPositions | None, other: EvaluatedPositions | None) -> bool:
    if one is None or other is None:
        return one is other
    return np.array_equal(one.local, other.local) and np.array_equal(one.matrix, other.matrix)
