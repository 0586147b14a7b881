# SPDX-License-Identifier: GPL-3.0-or-later
"""Make the guide's pictures of the layout operators: fixtures before and after, side by side.

    python docs/make_layout_pictures.py

Needs Blender as a Python module, the package `stiv`, and Pillow.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import bpy
from make_mode_pictures import GAP, ROOT, WIDTH, rendered
from PIL import Image

from stiv.blender import DropSettings, EditSettings, PlaceSettings, drop, place
from stiv.blender.scripts.blend_files import open_blend
from stiv.command_line.blender_module import quiet_blender

EDIT = EditSettings(separation=0.004)


def select(active: str, *others: str) -> None:
    """Select objects by name."""
    for ob in bpy.data.objects:
        ob.select_set(ob.name in (active, *others))
    bpy.context.view_layer.objects.active = bpy.data.objects[active]


def open_fixture(name: str) -> None:
    """Open a fixture."""
    with quiet_blender():
        open_blend(ROOT / "blend_fixtures" / f"{name}.blend")


def prepare_drop() -> None:
    """A tilted box over a slab."""
    open_fixture("box_along_wall")
    box = bpy.data.objects["Box"]
    box.location, box.rotation_euler = (0.2, 0.0, 1.0), (0.5, 0.6, 0.2)
    select("Box")


def prepare_place() -> None:
    """The box beside the slab on which its copies go."""
    open_fixture("box_along_wall")
    box = bpy.data.objects["Box"]
    box.scale = (0.5, 0.5, 0.5)
    box.location.z = 0.6
    select("Box", "Wall")


LAYOUTS: dict[str, tuple[Callable[[], None], Callable[[], object]]] = {
    "drop": (prepare_drop, lambda: drop(bpy.context, DropSettings(EDIT))),
    "place": (
        prepare_place,
        lambda: place(bpy.context, PlaceSettings(EDIT, count=30, align=False, scale_variation=0.4)),
    ),
}


def main() -> None:
    """Make all pictures."""
    with tempfile.TemporaryDirectory() as folder:
        for name, (prepare, run) in LAYOUTS.items():
            prepare()
            bpy.context.view_layer.update()
            before = rendered(Path(folder))
            print(name, run())
            whole = Image.new("RGB", (2 * WIDTH + GAP, before.height), "white")
            whole.paste(before, (0, 0))
            whole.paste(rendered(Path(folder)), (WIDTH + GAP, 0))
            whole.quantize(128).save(ROOT / "docs/images" / f"layout_{name}.png", optimize=True)


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # the Blender module of 4.2 and 4.5 may hang when the interpreter ends
