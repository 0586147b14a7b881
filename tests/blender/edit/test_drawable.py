# SPDX-License-Identifier: GPL-3.0-or-later
"""Intersecting faces for the overlay are at the right positions."""

import bpy
import pytest
from building import add_cube, add_grid

from stiv.blender import check_scene, triangles_of


def test_intersecting_triangles_are_those_of_the_faces() -> None:
    add_grid("Floor", 4)  # 16 faces of edge 0.5
    add_cube("Peg", (0.25, 0.25, 0), 0.1)
    triangles = triangles_of(bpy.context, check_scene(bpy.context).pairs)
    on_floor = triangles[(triangles[:, :, 2] == 0).all(axis=1)]
    assert len(on_floor) == 2
    assert on_floor.min(axis=(0, 1)) == pytest.approx([0, 0, 0])
    assert on_floor.max(axis=(0, 1)) == pytest.approx([0.5, 0.5, 0])
    assert len(triangles) - len(on_floor) == 8  # the four sides of the peg
