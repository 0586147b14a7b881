# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads weights of vertex groups."""

from collections.abc import Collection
from typing import Any

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.scene.arrays import Floats, Singles
from stiv.blender.scene.temporary_data import note_copies


def group_weights(ob: bpy.types.Object, name: str, purpose: str) -> Floats:
    """Weight of each vertex of a mesh, or point of a lattice, (m,); 0 outside the group.

    In Edit Mode as of the last `update_from_editmode`. purpose: use of the group in the settings, for messages. Raises
    InputError if there is no such group.
    """
    group = ob.vertex_groups.get(name)
    if group is None:
        raise InputError(f'{ob.name}: there is no vertex group "{name}" for {purpose}; choose another')
    if ob.type == "MESH":
        return read_group_weights(ob.data.vertices, group.index).astype(np.float64)
    return _of_lattice(ob.data, group.index)


def _of_lattice(lattice: bpy.types.Lattice, group: int) -> Floats:
    """In Edit Mode Blender returns wrong groups of points, so a copy outside Edit Mode is read."""
    if not lattice.is_editmode:
        return read_group_weights(lattice.points, group).astype(np.float64)
    note_copies()
    copy = lattice.copy()
    try:
        return read_group_weights(copy.points, group).astype(np.float64)
    finally:
        bpy.data.lattices.remove(copy)


def read_group_weights(vertices: Collection[Any], group: int) -> Singles:
    """Weights of a vertex group by its index, (n,); 0 outside the group."""
    weights = np.zeros(len(vertices), np.float32)
    for index, vertex in enumerate(vertices):
        for element in vertex.groups:
            if element.group == group:
                weights[index] = element.weight
    return weights
