# SPDX-License-Identifier: GPL-3.0-or-later
"""The region that holds an edit up: on both sides, near the contacts of the surface shown, and nowhere else."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from building import add_cube, add_grid, select, shift

from stiv import EditResult
from stiv.blender import BlenderEdit, ContactRegion, EditSettings, contact_region
from stiv.blender.edit.contact_region import GLOW, MAX_TRIANGLES


def pressed(direction: int, far: float = 2.6) -> tuple[BlenderEdit, EditResult]:
    """A box of edge 2 pressed at a wall whose face is at x = 3 in the direction."""
    add_cube("Wall", (direction * 3.5, 0, 0), 1.0, scale=(0.5, 4, 4))
    select(add_cube("Box"))
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.drag(shift(direction * 1.9))
    return edit, edit.drag(shift(direction * far))


def heights(region: ContactRegion, direction: int) -> np.ndarray:
    """Distances of all corners from the wall's face, positive on the box's side."""
    return 3.0 - direction * region.triangles[..., 0]


@pytest.mark.parametrize("direction", [1, -1])
def test_both_sides_are_lit_where_they_touch_and_fade_out(direction: int) -> None:
    edit, result = pressed(direction)
    region = contact_region(edit.assembly, result)
    x = heights(region, direction)
    on_wall = np.abs(x).max(axis=1) < 1e-6
    assert on_wall.any() and (x.min(axis=1) > 1e-6).any()
    assert region.strengths.min() >= 0.0 and region.strengths.max() > 0.9
    radius = 2.0 * GLOW * 2.0  # of a box of edge 2
    lit = region.triangles[region.strengths > 0]
    beyond = np.maximum(np.abs(lit[:, 1:]) - 1.0, 0.0)  # the box touches the wall within |y|, |z| <= 1
    assert np.linalg.norm(beyond, axis=1).max() <= radius * 1.01
    assert np.abs(heights(region, direction)[region.strengths > 0]).max() <= radius * 1.01


def test_the_area_between_the_contacts_is_lit_too() -> None:
    """Corners alone touch, but the whole face holds the box up."""
    edit, result = pressed(1)
    region = contact_region(edit.assembly, result)
    middle = np.linalg.norm(region.triangles[..., 1:], axis=2) < 0.3
    assert middle.any() and region.strengths[middle].min() > 0.15
    for side in (np.abs(heights(region, 1)) < 1e-6, heights(region, 1) > 1e-6):
        assert (middle & side).any()


def test_the_closest_contact_joins_both_sides() -> None:
    edit, result = pressed(1)
    region = contact_region(edit.assembly, result)
    assert region.closest is not None
    first, second = np.sort(region.closest[:, 0])
    assert second == pytest.approx(3.0, abs=1e-6) and 0.0 < second - first < 0.01


def test_nothing_is_lit_while_the_surface_shown_is_far_from_the_contacts() -> None:
    add_cube("Wall", (3.5, 0, 0), 1.0, scale=(0.5, 4, 4))
    select(add_cube("Box"))
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    start = edit.surface
    result = edit.drag(shift(2.6))
    result = replace(result, surface=start)  # as if the solve had ended before it accepted a state
    assert not len(contact_region(edit.assembly, result).triangles)
    assert not len(contact_region(edit.assembly, edit.drag(shift(-1))).triangles)


def test_a_dense_surface_gives_a_limited_number_of_faces() -> None:
    add_grid("Floor", 150)
    select(add_cube("Box", (0, 0, 1.5)))
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.drag(shift(0, 0, -0.4))
    region = contact_region(edit.assembly, edit.drag(shift(0, 0, -0.8)))
    assert 0 < len(region.triangles) <= MAX_TRIANGLES
