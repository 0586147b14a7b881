# SPDX-License-Identifier: GPL-3.0-or-later
"""Placements of animated objects: location, rotation and scale, or a refusal of shears."""

import pytest

pytest.importorskip("bpy")

import bpy

import stiv
from stiv.blender.animation.controls import stored_placement
from stiv.blender.scene.arrays import as_matrix
from tests.blender.building import add_cube


def test_a_shear_is_refused_also_far_from_the_origin() -> None:
    parent = add_cube("Parent", (5000, 0, 0), scale=(1.5, 1, 1))
    child = add_cube("Child", parent=parent, rotation_euler=(0, 0, 0.7))
    bpy.context.view_layer.update()
    with pytest.raises(stiv.InputError, match=r"^Child: its parent shears it; apply its transform$"):
        stored_placement(child, as_matrix(child.matrix_world))
    location, _, scale = stored_placement(parent, as_matrix(parent.matrix_world))
    assert tuple(location) == (5000, 0, 0) and tuple(scale) == pytest.approx((1.5, 1, 1))
