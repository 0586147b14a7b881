# SPDX-License-Identifier: GPL-3.0-or-later
"""Data for the overlay is at the right positions."""

import bpy
import numpy as np
import pytest
from building import add_cube, add_grid, select, shift

from stiv import Events
from stiv.blender import BlenderEdit, EditSettings, check_scene, contacts_of, triangles_of
from stiv.blender.edit.drawable import MAX_CONTACTS, contacts_at


@pytest.mark.parametrize("direction", [1, -1])
def test_contacts_lie_between_box_and_wall_and_block_the_way(direction: int) -> None:
    add_cube("Wall", (direction * 3.5, 0, 0), 1.0, scale=(0.5, 4, 4))
    select(add_cube("Box"))
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.drag(shift(direction * 1.9))
    found = contacts_of(edit, edit.drag(shift(direction * 2.6)))
    assert len(found.points)
    assert np.abs(found.points[:, 0]) == pytest.approx(3.0, abs=0.1)
    assert np.abs(found.points[:, 1:]).max() < 1.1
    assert found.blocked @ [direction, 0, 0] == pytest.approx(1.0, abs=1e-3)


def test_without_contacts_nothing_is_drawn() -> None:
    select(add_cube("Box"))
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    found = contacts_of(edit, edit.drag(shift(1)))
    assert found.points.shape == found.blocked.shape == (0, 3)


def test_many_contacts_are_sampled() -> None:
    count = 3 * MAX_CONTACTS
    events = Events(
        np.zeros(count, np.uint8), np.tile(np.arange(4, dtype=np.int32), (count, 1)), np.zeros(count),
        np.tile([1, -0.5, -0.25, -0.25], (count, 1)), np.tile([0.0, 0, 1], (count, 1)),
        np.ones(count),
    )  # fmt: skip
    surface = np.array([[0.0, 0, 2], [0, 0, 0], [4, 0, 0], [0, 4, 0]])
    found = contacts_at(events, surface, np.array([True, False, False, False]))
    assert 0 < len(found.points) <= MAX_CONTACTS
    assert found.points == pytest.approx(np.tile([0.5, 0.5, 1.0], (len(found.points), 1)))
    assert found.blocked == pytest.approx(np.tile([0.0, 0, -1], (len(found.points), 1)))


def test_intersecting_triangles_are_those_of_the_faces() -> None:
    add_grid("Floor", 4)  # 16 faces of edge 0.5
    add_cube("Peg", (0.25, 0.25, 0), 0.1)
    triangles = triangles_of(bpy.context, check_scene(bpy.context).pairs)
    on_floor = triangles[(triangles[:, :, 2] == 0).all(axis=1)]
    assert len(on_floor) == 2
    assert on_floor.min(axis=(0, 1)) == pytest.approx([0, 0, 0])
    assert on_floor.max(axis=(0, 1)) == pytest.approx([0.5, 0.5, 0])
    assert len(triangles) - len(on_floor) == 8  # the four sides of the peg
