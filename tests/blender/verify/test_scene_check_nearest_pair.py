# SPDX-License-Identifier: GPL-3.0-or-later
import bpy
import numpy as np
import pytest
from building import add_cube, add_modifier, evaluated

from stiv.blender import EditSettings
from stiv.blender.verify.scene_check import nearest_pair


def test_the_nearest_pair_is_found_in_world_space() -> None:
    add_cube("Box", scale=(1, 2, 1))
    add_cube("Near", (0, 3.25, 0.5))
    add_cube("Far", (5, 0, 0))
    found = nearest_pair(bpy.context)
    assert found is not None
    assert found.distance == pytest.approx(0.25)
    assert set(found.bodies) == {"Box", "Near"}
    assert np.linalg.norm(found.points[1] - found.points[0]) == pytest.approx(0.25)
    assert sorted(found.points[:, 1]) == pytest.approx([2.0, 2.25])


def test_ignored_objects_are_not_measured() -> None:
    add_cube("Box")
    add_cube("Near", (3, 0, 0))
    add_cube("Far", (0, 6, 0))
    found = nearest_pair(bpy.context, EditSettings(roles={"Near": "ignored"}))
    assert found is not None and set(found.bodies) == {"Box", "Far"}
    assert found.distance == pytest.approx(4.0)


def test_the_visible_surface_is_measured() -> None:
    box = add_cube("Box")
    add_modifier(box, "SUBSURF", levels=3)
    add_cube("Other", (4, 0, 0))
    found = nearest_pair(bpy.context)
    gap = 3 - evaluated(box)[:, 0].max()
    assert gap > 2.1  # the cages are 2 apart
    assert found is not None and found.distance == pytest.approx(gap)


def test_one_object_has_no_pair() -> None:
    add_cube("Box")
    assert nearest_pair(bpy.context) is None
