# SPDX-License-Identifier: GPL-3.0-or-later
"""Merges coincident vertices: first in copies of the meshes and, on success, in the originals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bmesh
import bpy
import numpy as np

from stiv import InputError
from stiv.blender.controls.editable import shared_data_error
from stiv.blender.controls.shared_meshes import other_users
from stiv.blender.scene.arrays import read_collection
from stiv.blender.scene.references import ObjectReference


@dataclass(frozen=True)
class WeldedMeshes:
    """Objects that show welded copies of their meshes. Call either `apply` or `undo`.

    `meshes` and `copies` are names of meshes, one for each object.
    """

    owners: tuple[ObjectReference, ...]
    meshes: tuple[str, ...]
    copies: tuple[str, ...]

    def apply(self) -> None:
        """Weld the original meshes, give them the positions of the copies, and remove the copies."""
        for name, copy in zip(self.meshes, self.copies, strict=True):
            mesh = bpy.data.meshes[name]
            _weld(mesh)
            positions = read_collection(bpy.data.meshes[copy].vertices, "co", 3, np.float32)
            mesh.vertices.foreach_set("co", positions.ravel())
            if mesh.shape_keys is not None:
                mesh.shape_keys.key_blocks[0].data.foreach_set("co", positions.ravel())
            mesh.update()
        self.undo()

    def undo(self) -> None:
        """Show the original meshes again, and remove the copies; a second call does nothing."""
        for owner, name, copy in zip(self.owners, self.meshes, self.copies, strict=True):
            if copy in bpy.data.meshes:
                owner.find().data = bpy.data.meshes[name]
                bpy.data.meshes.remove(bpy.data.meshes[copy])
        bpy.context.view_layer.update()


def weld_copies(objects: Sequence[bpy.types.Object]) -> WeldedMeshes:
    """Replace the meshes of objects by welded copies. Raises InputError in Edit Mode, with nothing changed."""
    for ob in objects:
        if ob.mode == "EDIT":
            raise InputError(f"{ob.name}: cannot be welded in Edit Mode; use Merge by Distance")
        if ob.data.shape_keys is not None and len(ob.data.shape_keys.key_blocks) > 1:
            raise InputError(f"{ob.name}: has shape keys and cannot be welded; use Merge by Distance")
        if users := other_users(ob):
            raise shared_data_error(ob, users[0])
    owners, meshes, copies = [], [], []
    for ob in objects:
        owners.append(ObjectReference.of(ob))
        meshes.append(ob.data.name)
        ob.data = ob.data.copy()
        copies.append(ob.data.name)
        _weld(ob.data)
    bpy.context.view_layer.update()
    return WeldedMeshes(tuple(owners), tuple(meshes), tuple(copies))


def _weld(mesh: bpy.types.Mesh) -> None:
    edited = bmesh.new()
    try:
        edited.from_mesh(mesh)
        first: dict[tuple[float, ...], bmesh.types.BMVert] = {}
        targets = {}
        for vertex in edited.verts:
            place = tuple(coordinate + 0.0 for coordinate in vertex.co)  # -0.0 and 0.0 are equal
            if first.setdefault(place, vertex) is not vertex:
                targets[vertex] = first[place]
        bmesh.ops.weld_verts(edited, targetmap=targets)
        edited.to_mesh(mesh)
    finally:
        edited.free()
    mesh.update()
