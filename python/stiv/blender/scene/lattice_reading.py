# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the points of lattices."""

import bpy
import numpy as np

from stiv.blender.scene.arrays import Singles, read_collection
from stiv.blender.scene.temporary_data import note_copies


def is_undeformed(lattice: bpy.types.Lattice) -> bool:
    """Are all points at rest exactly? Then the lattice changes nothing."""
    return bool(np.array_equal(read_lattice_points(lattice), read_rest_lattice_points(lattice)))


def read_lattice_points(lattice: bpy.types.Lattice) -> Singles:
    """Deformed points, (m, 3), in the lattice's frame."""
    return read_collection(lattice.points, "co_deform", 3, np.float32)


def read_selected_lattice_points(lattice: bpy.types.Lattice) -> Singles:
    """Deformed points that are selected, (k, 3), in the lattice's frame."""
    return np.asarray(read_lattice_points(lattice)[read_collection(lattice.points, "select", 1, np.bool_)])


def read_rest_lattice_points(lattice: bpy.types.Lattice) -> Singles:
    """Points at rest, (m, 3), in the lattice's frame.

    In Edit Mode Blender returns wrong rest positions, so a copy outside Edit Mode is read. The resolution alone does
    not determine them: a lattice keeps its extents when its resolution changes.
    """
    if not lattice.is_editmode:
        return read_collection(lattice.points, "co", 3, np.float32)
    note_copies()
    copy = lattice.copy()
    try:
        return read_collection(copy.points, "co", 3, np.float32)
    finally:
        bpy.data.lattices.remove(copy)
