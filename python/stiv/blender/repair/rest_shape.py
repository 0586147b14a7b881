# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape that a mesh had before it was contracted or repaired, kept with the mesh to go back to.

It is a mesh attribute, one position a vertex in the object's own frame, and not a shape key: keys decide what Blender
evaluates and hide later changes of the vertices, while an attribute is carried along by topology edits, by copies and
by the file, and changes nothing that is seen.
"""

from __future__ import annotations

import bmesh
import bpy
import numpy as np

from stiv.blender.scene.arrays import Singles, read_collection

NAME = "stiv_original"


def read_original(ob: bpy.types.Object) -> Singles | None:
    """Local positions, (m, 3), of the shape kept with the object's mesh; None if there is none, or none that fits."""
    if ob.mode == "EDIT":
        edited = bmesh.from_edit_mesh(ob.data).verts
        layer = edited.layers.float_vector.get(NAME)
        return None if layer is None else np.array([vertex[layer] for vertex in edited], np.float32).reshape(-1, 3)
    attribute = ob.data.attributes.get(NAME)
    if attribute is None or attribute.domain != "POINT" or attribute.data_type != "FLOAT_VECTOR":
        return None
    return read_collection(attribute.data, "vector", 3, np.float32)


def keep_original(ob: bpy.types.Object, local: Singles) -> None:
    """Keep local positions, (m, 3), with the object's mesh, in place of those kept before."""
    if ob.mode == "EDIT":
        edited = bmesh.from_edit_mesh(ob.data).verts
        layer = edited.layers.float_vector.get(NAME) or edited.layers.float_vector.new(NAME)
        for vertex, position in zip(edited, local.tolist(), strict=True):
            vertex[layer] = position
        return
    forget_original(ob)
    ob.data.attributes.new(NAME, "FLOAT_VECTOR", "POINT").data.foreach_set("vector", local.ravel())


def forget_original(ob: bpy.types.Object) -> None:
    """Drop what is kept with the object's mesh."""
    if ob.mode == "EDIT":
        layers = bmesh.from_edit_mesh(ob.data).verts.layers.float_vector
        if (layer := layers.get(NAME)) is not None:
            layers.remove(layer)
    elif (attribute := ob.data.attributes.get(NAME)) is not None:
        ob.data.attributes.remove(attribute)
