# SPDX-License-Identifier: GPL-3.0-or-later
"""Make the guide's pictures of the modes: fixtures before and after their edit scripts, side by side.

    python docs/make_mode_pictures.py [NAME ...]

Needs Blender as a Python module, the package `stiv` with its add-on, and Pillow.
"""

from __future__ import annotations

import argparse
import math
import os
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import bpy
import mathutils
from PIL import Image

from stiv.blender import BlenderEdit, EditSettings
from stiv.blender.scripts.blend_files import open_blend, render_picture
from stiv.command_line.blender_module import quiet_blender
from stiv.command_line.replay import run_script
from stiv.edit_scripts import read_edit_script

ROOT = Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT))

from blend_fixtures.characters import make_character, select_bones  # noqa: E402

FIXTURES = {  # pictures, and how many steps of the script they show; None: all
    "rigid": ("box_along_wall", 1),
    "cage": ("cage_into_wavy_wall", None),
    "modifiers": ("plate_with_modifiers", None),
    "lattice": ("lattice_bspline", None),
    "soft": ("arm_with_handles", None),
    "weighted": ("figures/weighted_handles", None),
    "loop": ("figures/dressing", None),
    "repair": ("figures/untangling", None),
}
NAMES = [*FIXTURES, "posed"]
WIDTH, GAP = 400, 8  # pixels of one state, and of the gap between two


def rendered(folder: Path) -> Image.Image:
    """A rendering of the open scene from its camera."""
    path = folder / "state.png"
    with quiet_blender(errors=True):
        render_picture(path)
    with Image.open(path) as picture:
        return picture.convert("RGB").resize((WIDTH, round(picture.height * WIDTH / picture.width)), Image.LANCZOS)


def before_and_after(fixture: Path, steps: int | None, folder: Path) -> Image.Image:
    """Two states side by side."""
    with quiet_blender():
        open_blend(fixture)
    before = rendered(folder)
    script = read_edit_script(fixture.with_suffix(".edits.json"))
    run_script(replace(script, steps=script.steps[:steps]), fixture)
    return side_by_side(before, rendered(folder))


def side_by_side(before: Image.Image, after: Image.Image) -> Image.Image:
    """Two pictures with a gap."""
    whole = Image.new("RGB", (2 * WIDTH + GAP, before.height), "white")
    whole.paste(before, (0, 0))
    whole.paste(after, (WIDTH + GAP, 0))
    return whole


def posed(folder: Path) -> Image.Image:
    """Both arms of a character lowered by Blender and by STIV."""
    with quiet_blender():
        open_blend(ROOT / "blend_fixtures/box_along_wall.blend")
        for ob in [ob for ob in bpy.data.objects if ob.type == "MESH"]:
            bpy.data.objects.remove(ob)
        rig, body = make_character(0.04)
        for face in body.data.polygons:
            face.use_smooth = True
        body.color = (0.75, 0.5, 0.38, 1)
        scene = bpy.context.scene
        scene.display.shading.color_type = "OBJECT"
        scene.camera.location, scene.camera.rotation_euler = (1.1, -6.6, 1.4), (1.4, 0, 0.17)
        states = [posed_arms(rig, folder, interference) for interference in (False, True)]
    return side_by_side(*states)


def posed_arms(rig: bpy.types.Object, folder: Path, interference: bool) -> Image.Image:
    """A rendering with both arms turned down by 125 degrees, or as far as the body lets them."""
    for side, sign in (("L", 1), ("R", -1)):
        rig.pose.bones[f"Arm.{side}"].rotation_quaternion = (1, 0, 0, 0)
        select_bones(rig, f"Arm.{side}")
        settings = EditSettings(separation=0.01, interference=interference)
        edit = BlenderEdit.begin(bpy.context, settings, "rotate")
        shoulder = mathutils.Matrix.Translation((sign * 0.5, 0, 1.35))
        edit.apply(shoulder @ mathutils.Matrix.Rotation(sign * math.radians(125), 4, "Y") @ shoulder.inverted())
        edit.write()
    return rendered(folder)


def main() -> None:
    """Make the named pictures, or all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(NAMES)}")
    chosen = parser.parse_args().names or NAMES
    with tempfile.TemporaryDirectory() as folder:
        for name in chosen:
            if name == "posed":
                picture = posed(Path(folder))
            else:
                fixture, steps = FIXTURES[name]
                picture = before_and_after(ROOT / "blend_fixtures" / f"{fixture}.blend", steps, Path(folder))
            # A palette halves the size, and surfaces in studio light need few colours.
            picture.quantize(128).save(ROOT / "docs/images" / f"mode_{name}.png", optimize=True)


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # the Blender module of 4.2 and 4.5 may hang when the interpreter ends
