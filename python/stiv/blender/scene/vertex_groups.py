# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of an object's vertex groups, by name."""

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.mesh_reading import read_group_weights


def group_weights(ob: bpy.types.Object, name: str, purpose: str) -> Floats:
    """Weight of each vertex of a mesh, or point of a lattice, 0 where it is not in the group, (m,).

    In Edit Mode as of the last `update_from_editmode`. purpose: as what the settings name the group, for messages.
    Raises InputError if there is no such group.
    """
    group = ob.vertex_groups.get(name)
    if group is None:
        raise InputError(
            f'object "{ob.name}": there is no vertex group "{name}", which its settings name as {purpose}; choose '
            "another one, or make it"
        )
    if ob.type == "MESH":
        return read_group_weights(ob.data.vertices, group.index).astype(np.float64)
    return _of_lattice(ob.data, group.index)


def _of_lattice(lattice: bpy.types.Lattice, group: int) -> Floats:
    """In Edit Mode Blender looks the groups of points up in the wrong place; those of a copy are right."""
    if not lattice.is_editmode:
        return read_group_weights(lattice.points, group).astype(np.float64)
    copy = lattice.copy()
    try:
        return read_group_weights(copy.points, group).astype(np.float64)
    finally:
        bpy.data.lattices.remove(copy)
