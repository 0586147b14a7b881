# SPDX-License-Identifier: GPL-3.0-or-later
"""The fixture for pytest on .blend files: intersections between frames are named."""

from pathlib import Path

import bpy
from building import add_cube, add_grid

from stiv.blender.scripts.blend_files import save_blend
from stiv.pytest_plugin import _check


def test_a_scene_is_opened_and_intersections_are_named(tmp_path: Path) -> None:
    add_grid("Plate", 1, 2.0)
    cube = add_cube("Cube ü", (0.3, 0.2, 1), 0.1)
    for frame, height in ((1, 1), (2, -1)):
        cube.location.z = height
        cube.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_set(1)
    scene = tmp_path / "scene.blend"
    save_blend(scene)
    assert _check(scene, []) == ""
    message = _check(scene, ["--frames=1:2"])
    assert message.splitlines()[0].endswith("intersecting pairs")
    assert 'between frames 1 and 2: object "Cube ü", face' in message and 'object "Plate", face 0' in message
