# SPDX-License-Identifier: GPL-3.0-or-later
"""The shapes of the meshes in Edit Mode, shown again later."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bmesh
import bpy
import numpy as np

from stiv.blender.repair.rest_shape import read_rest_shape, remove_rest_shape, store_rest_shape
from stiv.blender.scene.arrays import Singles
from stiv.blender.scene.references import ObjectReference


class EditModeShapes:
    """Vertices and rest shapes at the time of a call."""

    def __init__(self, objects: list[bpy.types.Object]) -> None:
        """Read the meshes among the objects that are in Edit Mode."""
        edited = [ob for ob in objects if ob.type == "MESH" and ob.mode == "EDIT"]
        self._references = [ObjectReference.of(ob) for ob in edited]
        self._shapes = [(_positions(ob), read_rest_shape(ob)) for ob in edited]

    @contextmanager
    def shown(self) -> Iterator[None]:
        """Blender shows these shapes inside, and the present ones again afterwards. Raises SceneChangedError."""
        present = EditModeShapes([each.find() for each in self._references])
        self._show()
        try:
            yield
        finally:
            present._show()

    def _show(self) -> None:
        for reference, (positions, rest_shape) in zip(self._references, self._shapes, strict=True):
            ob = reference.find_in_mode("EDIT")
            if rest_shape is None:
                remove_rest_shape(ob)
            else:
                store_rest_shape(ob, rest_shape)
            edited = bmesh.from_edit_mesh(ob.data)
            for vertex, position in zip(edited.verts, positions.tolist(), strict=True):
                vertex.co = position
            edited.normal_update()
            bmesh.update_edit_mesh(ob.data, loop_triangles=True, destructive=False)


def _positions(ob: bpy.types.Object) -> Singles:
    """Local positions of the edited vertices, (m, 3)."""
    return np.array([vertex.co for vertex in bmesh.from_edit_mesh(ob.data).verts], np.float32).reshape(-1, 3)
