# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of objects with their own minimum distance, stored in the file and respected by the operators."""

from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture(autouse=True)
def scene() -> None:
    """A selected box above a floor, and another box far away."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    for name, z in (("Floor", -2.0), ("Far", 9.0), ("Box", 0.0)):
        bpy.ops.mesh.primitive_cube_add(size=2.0, location=(0, 0, z - (name == "Floor")))
        bpy.context.active_object.name = name


def choose(*names: str) -> None:
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj.name in names)


def test_a_pair_is_kept_apart_after_saving_renaming_and_loading(tmp_path: Path) -> None:
    choose("Box", "Floor")
    assert bpy.ops.stiv.separation_add() == {"FINISHED"}
    bpy.context.scene.stiv.pair_separations[0].separation = 0.4
    bpy.data.objects["Floor"].name = "Ground"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "pair.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "pair.blend"))
    choose("Box")
    bpy.ops.stiv.move(value=(0.0, 0.0, -3.0))
    gap = bpy.data.objects["Box"].location.z - 1 + 2
    assert 0.4 * (1 - 1e-6) <= gap < 0.85
    bpy.ops.stiv.separation_remove(index=0)
    assert len(bpy.context.scene.stiv.pair_separations) == 0


def test_other_numbers_of_objects_are_rejected() -> None:
    choose("Box", "Floor", "Far")
    with pytest.raises(RuntimeError, match=r"\(3 selected\)"):
        bpy.ops.stiv.separation_add()
    with pytest.raises(RuntimeError, match="Pair 2 does not exist"):
        bpy.ops.stiv.separation_remove(index=2)


def test_one_object_alone_is_paired_with_itself_and_a_deleted_one_is_left_out() -> None:
    choose("Far")
    bpy.ops.stiv.separation_add()
    row = bpy.context.scene.stiv.pair_separations[0]
    assert row.first == row.second == bpy.data.objects["Far"]
    bpy.data.objects.remove(bpy.data.objects["Far"])
    bpy.context.view_layer.update()
    choose("Box")
    bpy.ops.stiv.move(value=(1.0, 0.0, 0.0))
    assert np.allclose(bpy.data.objects["Box"].location, (1, 0, 0))
