# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.move`, `stiv.rotate` and `stiv.scale` in Pose Mode: contact, undo, Auto Keying, and what they refuse."""

from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
from blend_fixtures.characters import make_character, select_bones  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture
def rig() -> Any:
    """A character with a box below its left forearm."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    rig, _ = make_character(0.12)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.mesh.primitive_cube_add(size=0.6, location=(1.3, 0, 0.6))
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="POSE")
    select_bones(rig, "Arm.L")
    bpy.context.scene.stiv.separation = 0.01
    return rig


def rotate(angle: float) -> set[str]:
    result: set[str] = bpy.ops.stiv.rotate("EXEC_DEFAULT", True, angle=np.radians(angle), axis=(0, 1, 0))
    return result


def angle(rig: Any, name: str = "Arm.L") -> float:
    return float(np.degrees(rig.pose.bones[name].rotation_quaternion.angle))


def test_a_rotation_stops_at_contact_and_is_one_undo_step(rig: Any) -> None:
    bpy.ops.ed.undo_push(message="start")
    assert rotate(60) == {"FINISHED"}
    assert 15 < angle(rig) < 25
    bpy.ops.ed.undo()
    rig = bpy.data.objects["Rig"]
    assert angle(rig) == 0 and bpy.context.mode == "POSE"
    assert rig.animation_data is None


def test_auto_keying_inserts_keyframes_for_the_rotation_alone(rig: Any) -> None:
    bpy.context.scene.tool_settings.use_keyframe_insert_auto = True
    bpy.context.scene.frame_set(7)
    rotate(60)
    reached = angle(rig)
    bpy.context.scene.frame_set(8)
    assert angle(rig) == reached > 15
    rig.pose.bones["Arm.L"].location = (0.1, 0, 0)
    bpy.context.scene.frame_set(9)
    assert angle(rig) == reached and rig.pose.bones["Arm.L"].location.x == np.float32(0.1)


def test_bones_move_and_scale(rig: Any) -> None:
    assert bpy.ops.stiv.move("EXEC_DEFAULT", True, value=(0, 0, -1)) == {"FINISHED"}
    assert 0.2 < rig.pose.bones["Arm.L"].location.length < 0.5
    select_bones(rig, "Head")
    assert bpy.ops.stiv.scale("EXEC_DEFAULT", True, value=(1.5, 1.5, 1.5)) == {"FINISHED"}
    assert rig.pose.bones["Head"].scale[:] == pytest.approx((1.5, 1.5, 1.5))


def test_refusals_name_rig_and_bone(rig: Any) -> None:
    select_bones(rig, "Forearm.L")
    with pytest.raises(RuntimeError, match=r"Rig: Forearm.L is connected to its parent; rotate it"):
        bpy.ops.stiv.move("EXEC_DEFAULT", True, value=(0, 0, -1))
    select_bones(rig)
    with pytest.raises(RuntimeError, match="no bone is selected; select one"):
        rotate(60)
    assert angle(rig) == 0
