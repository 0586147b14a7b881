# SPDX-License-Identifier: GPL-3.0-or-later
"""The ghost of the goal: the moved objects where they would be without collisions."""

import bpy
import pytest
from building import add_cube, add_grid, select, shift

from stiv.blender import BlenderEdit, EditSettings, GhostSource


def test_the_ghost_is_at_the_goal_and_gone_when_the_goal_is_reached() -> None:
    add_cube("Wall", (3.5, 0, 0), 1.0, scale=(0.5, 4, 4))
    select(add_cube("Box"))
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    source = GhostSource(edit)
    assert source.belongs_to(edit)
    assert source.ghost(edit.drag(shift(1))) is None
    ghost = source.ghost(edit.drag(shift(5)))
    assert ghost is not None and len(ghost.triangles) == 12
    assert ghost.points.min(axis=0) == pytest.approx([4, -1, -1])
    assert ghost.points.max(axis=0) == pytest.approx([6, 1, 1])
    assert ghost.triangles.max() < len(ghost.points)


def test_a_large_object_has_a_box_as_its_ghost() -> None:
    add_cube("Wall", (0, 0, 3.5), 1.0, scale=(4, 4, 0.5))
    select(add_grid("Cloth", 110))
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    source, result = GhostSource(edit), edit.drag(shift(0, 0, 5))
    ghost = source.ghost(result, shift(0, 0, 5))
    assert ghost is not None and len(ghost.triangles) == 0 and len(ghost.edges) == 12
    assert ghost.points.min(axis=0) == pytest.approx([-1, -1, 5])
    assert ghost.points.max(axis=0) == pytest.approx([1, 1, 5])
    assert source.ghost(result) is None  # parts of it move: where the box would be is unknown
