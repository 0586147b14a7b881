# SPDX-License-Identifier: GPL-3.0-or-later
"""Make the pictures of the guide's tutorials from the extension's examples: as Blender does it, and with collisions.

    python docs/make_tutorial_pictures.py [NAME ...]

Needs Blender as a Python module, the package `stiv` with its add-on, and Pillow.
"""

from __future__ import annotations

import argparse
import math
import os
import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import bpy
import mathutils
from make_mode_pictures import ROOT, rendered, side_by_side
from PIL import Image

from stiv.blender import BlenderEdit, EditSettings, morph, select_bones
from stiv.blender.scripts.blend_files import open_blend
from stiv.command_line.blender_module import quiet_blender
from stiv.command_line.program import run

EXAMPLES = ROOT / "blend_fixtures/examples"
SETTINGS = EditSettings(separation=0.01)


def open_example(name: str) -> None:
    """Open an example for pictures."""
    open_scene(EXAMPLES / f"{name}.blend")


def open_scene(path: Path) -> None:
    """Open a file with a light background and the whole figure in view."""
    open_blend(path)
    scene = bpy.context.scene
    scene.world = scene.world or bpy.data.worlds.new("World")
    scene.world.color = (0.75, 0.77, 0.8)
    scene.render.resolution_x, scene.render.resolution_y = 640, 560
    scene.camera.data.lens = 45


def pose_arm(folder: Path) -> Image.Image:
    """An arm lowered and bent, through the body and onto it."""
    open_example("pose_arm")
    rig = bpy.data.objects["Rig"]
    rig.show_in_front = False
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="POSE")
    pictures = []
    for interference in (False, True):
        for bone in rig.pose.bones:
            bone.matrix_basis = mathutils.Matrix()
        bpy.context.view_layer.update()
        for name, degrees in (("Arm.L", 115), ("Forearm.L", 25)):
            rotate(rig, name, degrees, replace(SETTINGS, interference=interference))
        pictures.append(rendered(folder))
    return side_by_side(*pictures)


def rotate(rig: bpy.types.Object, name: str, degrees: float, settings: EditSettings) -> None:
    """Rotate a bone about its head and the Y axis of the world."""
    select_bones(rig, (name,))
    head = mathutils.Matrix.Translation(rig.matrix_world @ rig.pose.bones[name].head)
    edit = BlenderEdit.begin(bpy.context, settings, "rotate")
    edit.apply(head @ mathutils.Matrix.Rotation(math.radians(degrees), 4, "Y") @ head.inverted())
    edit.write()


def morph_body(folder: Path) -> Image.Image:
    """A heavier body through its shirt and under it."""
    open_example("morph_body")
    key = bpy.data.objects["Body"].data.shape_keys.key_blocks["Heavier"]
    key.value = 1.0
    before = rendered(folder)
    key.value = 0.0
    settings = replace(SETTINGS, responders="unselected", deformations={"Shirt": "vertices"})
    morph(bpy.context, {"Body": {"Heavier": 1.0}}, settings)
    return side_by_side(before, rendered(folder))


def clean_walk(folder: Path) -> Image.Image:
    """A frame of the walk cycle, before and after `stiv resolve --write rig`."""
    source, target = EXAMPLES / "clean_walk.blend", folder / "clean.blend"
    if run(["resolve", str(source), "--frames", "scene", "-o", str(target), "--write", "rig"]):
        raise SystemExit("the walk cycle could not be corrected")
    pictures = []
    for path in (source, target):
        open_scene(path)
        bpy.context.scene.frame_set(1)
        bpy.context.scene.camera.data.lens = 90
        pictures.append(rendered(folder))
    return side_by_side(*pictures)


MAKERS: dict[str, Callable[[Path], Image.Image]] = {
    "pose_arm": pose_arm, "morph_body": morph_body, "clean_walk": clean_walk,
}  # fmt: skip


def main() -> None:
    """Make the named pictures, or all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(MAKERS)}")
    for name in parser.parse_args().names or MAKERS:
        with tempfile.TemporaryDirectory() as folder, quiet_blender():
            picture = MAKERS[name](Path(folder))
        # A palette halves the size, and surfaces in studio light need few colours.
        picture.quantize(128).save(ROOT / "docs/images" / f"tutorial_{name}.png", optimize=True)


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # the Blender module of 4.2 and 4.5 may hang when the interpreter ends
