# SPDX-License-Identifier: GPL-3.0-or-later
"""The rest shape of a mesh: its shape before contraction or repair, stored with the mesh.

It is a mesh attribute, one local position for each vertex. Shape keys would change what Blender evaluates and hide
later changes of vertices. An attribute survives topology edits, copies and saving, and changes nothing visible.
"""

from __future__ import annotations

import bmesh
import bpy
import numpy as np

from stiv.blender.scene.arrays import Singles, read_collection

NAME = "stiv_original"


def read_rest_shape(ob: bpy.types.Object) -> Singles | None:
    """Local positions, (m, 3), of the stored rest shape; None if there is none or it does not fit."""
    if ob.mode == "EDIT":
        edited = bmesh.from_edit_mesh(ob.data).verts
        layer = edited.layers.float_vector.get(NAME)
        return None if layer is None else np.array([vertex[layer] for vertex in edited], np.float32).reshape(-1, 3)
    attribute = ob.data.attributes.get(NAME)
    if attribute is None or attribute.domain != "POINT" or attribute.data_type != "FLOAT_VECTOR":
        return None
    return read_collection(attribute.data, "vector", 3, np.float32)


def store_rest_shape(ob: bpy.types.Object, local: Singles) -> None:
    """Store local positions, (m, 3), as rest shape; replaces an earlier one."""
    if ob.mode == "EDIT":
        edited = bmesh.from_edit_mesh(ob.data).verts
        layer = edited.layers.float_vector.get(NAME) or edited.layers.float_vector.new(NAME)
        for vertex, position in zip(edited, local.tolist(), strict=True):
            vertex[layer] = position
        return
    remove_rest_shape(ob)
    ob.data.attributes.new(NAME, "FLOAT_VECTOR", "POINT").data.foreach_set("vector", local.ravel())


def remove_rest_shape(ob: bpy.types.Object) -> None:
    """Remove the stored rest shape."""
    if ob.mode == "EDIT":
        layers = bmesh.from_edit_mesh(ob.data).verts.layers.float_vector
        if (layer := layers.get(NAME)) is not None:
            layers.remove(layer)
    elif (attribute := ob.data.attributes.get(NAME)) is not None:
        ob.data.attributes.remove(attribute)
