# SPDX-License-Identifier: GPL-3.0-or-later
"""Points of lattices in Edit Mode."""

import bpy
import building
import numpy as np

from stiv.blender import read_selected_lattice_points


def test_selected_points_are_the_deformed_ones_in_their_order():
    lattice = building.add_lattice("Lattice", (2, 2, 2))
    for index, point in enumerate(lattice.data.points):
        point.co_deform = (index, 2 * index, -index)
    building.edit_mode(lattice)
    for index, point in enumerate(lattice.data.points):
        point.select = index in (1, 6)
    assert np.array_equal(read_selected_lattice_points(lattice.data), [(1, 2, -1), (6, 12, -6)])
    bpy.ops.lattice.select_all(action="DESELECT")
    assert read_selected_lattice_points(lattice.data).shape == (0, 3)
