# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv check` accepts what `stiv resolve` writes, without options: random animations, rigid and of bones."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, add_modifier, mesh, select

from stiv.blender.scene.animation_curves import channel_curves
from stiv.blender.scripts.blend_files import open_blend, save_blend
from stiv.blender.verify.keyed_frames import add_subframe_keys
from stiv.command_line import program

LAST = 15


def key_angles(bone, angles) -> None:
    """From straight to these angles."""
    bone.rotation_mode = "XYZ"
    for frame, values in ((1, (0, 0, 0)), (LAST, angles)):
        bone.rotation_euler = values
        bone.keyframe_insert("rotation_euler", frame=frame)


def arm_and_cube(angles) -> None:
    """A cylinder on two bones that turn, and a cube in the way."""
    add_cube("Cube", (1.2, 0, 0), 0.5)
    around = np.arange(16) * 2 * np.pi / 16
    points = [(0.25 * np.cos(a), 0.25 * np.sin(a), z) for z in np.linspace(0, 2, 12) for a in around]
    faces = [
        (r * 16 + c, r * 16 + (c + 1) % 16, (r + 1) * 16 + (c + 1) % 16, (r + 1) * 16 + c)
        for r in range(11)
        for c in range(16)
    ]
    cylinder, rig = add("Cylinder", mesh("Cylinder", points, faces)), add("Rig", bpy.data.armatures.new("Rig"))
    select(rig)
    bpy.ops.object.mode_set(mode="EDIT")
    low, high = (rig.data.edit_bones.new(name) for name in ("low", "high"))
    low.head, low.tail, high.head, high.tail, high.parent = (0, 0, 0), (0, 0, 1), (0, 0, 1), (0, 0, 2), low
    bpy.ops.object.mode_set(mode="OBJECT")
    groups = [cylinder.vertex_groups.new(name=name) for name in ("low", "high")]
    for number, (_, _, z) in enumerate(points):
        upper = float(np.clip((z - 0.7) / 0.6, 0, 1))
        for group, weight in zip(groups, (1 - upper, upper), strict=True):
            group.add([number], weight, "REPLACE")
    add_modifier(cylinder, "ARMATURE", object=rig)
    for bone, values in zip(rig.pose.bones, angles, strict=True):
        key_angles(bone, values)


def thrown_cubes(seed: int) -> None:
    """Cubes that turn and fly through each other and a plate."""
    random = np.random.default_rng(seed)
    add_grid("Plate", 6, 3.0)
    for number in range(4):
        cube = add_cube(f"Cube {number}", size=0.3)
        for frame in (1, 6, LAST):
            cube.location = (*random.uniform(-1.5, 1.5, 2), 0.6 + 1.2 * number if frame == 1 else random.uniform(-2, 3))
            cube.rotation_euler = random.uniform(-3, 3, 3)
            cube.keyframe_insert("location", frame=frame)
            cube.keyframe_insert("rotation_euler", frame=frame)


SCENES = {
    "bone": lambda: arm_and_cube([(0, 0, -1.9), (0, 0, -0.4)]),
    "folded": lambda: arm_and_cube(np.random.default_rng(2).normal(size=(2, 3)) * 1.2),
    "cubes 1": lambda: thrown_cubes(1),
    "cubes 2": lambda: thrown_cubes(2),
    "cubes 3": lambda: thrown_cubes(3),
}


@pytest.mark.shared
@pytest.mark.parametrize("scene", SCENES)
def test_resolved_files_pass_check(tmp_path: Path, scene: str) -> None:
    SCENES[scene]()
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 1, LAST
    source, out = (str(tmp_path / name) for name in ("scene.blend", "out.blend"))
    save_blend(Path(source))
    assert program.run(["check", source, "--frames", "scene"]) == 4
    assert program.run(["resolve", source, "--frames", "scene", "-o", out]) == 0
    assert program.run(["check", out, "--frames", "scene"]) == 0
    assert program.run(["check", out, "--frames", f"1:{LAST}"]) == 0


@pytest.mark.shared
def test_faces_that_fold_are_split_and_nothing_else_changes(tmp_path: Path) -> None:
    SCENES["folded"]()
    bpy.data.objects["Cylinder"].data.uv_layers.new(name="UV")
    out = tmp_path / "out.blend"
    save_blend(tmp_path / "scene.blend")
    assert program.run(["resolve", str(tmp_path / "scene.blend"), "--frames", f"1:{LAST}", "-o", str(out)]) == 0
    open_blend(out)
    data = bpy.data.objects["Cylinder"].data
    sizes = [polygon.loop_total for polygon in data.polygons]
    assert len(data.vertices) == 192 and data.uv_layers.keys() == ["UV"]
    assert sizes.count(3) > 0 and sizes.count(4) > 100 and sizes.count(3) / 2 + sizes.count(4) == 176


def test_keys_between_frames_are_tested_and_muted_ones_are_not() -> None:
    cube = add_cube("Cube")
    for frame in (1, 2.25, 3, 4.5, 9.5):
        cube.keyframe_insert("location", frame=frame)
    assert add_subframe_keys([1, 3, 5]) == [1, 2.25, 3, 4.5, 5]
    assert add_subframe_keys([]) == []
    action = cube.animation_data.action
    strip = cube.animation_data.nla_tracks.new().strips.new("Strip", 21, action)
    cube.animation_data.action = None
    strip.scale = 2.0
    assert add_subframe_keys([20, 30]) == [20, 23.5, 30]  # 2.25 is 1.25 after the strip's start, at half speed
    for curve in channel_curves(action):
        curve.mute = True
    assert add_subframe_keys([20, 30]) == [20, 30]
