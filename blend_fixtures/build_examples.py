# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the extension's example scenes with their pictures into examples/.

    python blend_fixtures/build_examples.py

Needs Blender as a Python module, and the package `stiv` with its add-on. Use the oldest supported Blender (4.2).
"""

from __future__ import annotations

import importlib
import os
import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

os.environ["HOME"] = "/"  # Blender writes the home folder into every file it saves

import bpy
from mathutils import Vector

FOLDER = Path(__file__).resolve().parent
EXAMPLES = FOLDER / "examples"
PICTURE_SIZE = 192  # pixels
COLORS = {  # of the objects in the box
    "Suzanne": (0.55, 0.3, 0.15, 1.0), "Torus": (0.2, 0.35, 0.7, 1.0), "Cone": (0.7, 0.55, 0.1, 1.0),
    "Icosphere": (0.25, 0.55, 0.25, 1.0), "Cylinder": (0.6, 0.2, 0.25, 1.0), "Box": (0.75, 0.7, 0.62, 1.0),
}  # fmt: skip


def dress_figure() -> None:
    """Figure 1 of the paper: the body may yield a little, so that it grows to its shape."""
    bpy.ops.wm.open_mainfile(filepath=str(FOLDER / "figures/dressing.blend"))
    bpy.data.objects["Ogre"].stiv.weight_group = "Gives way"
    select("Ogre")


def pot_plant() -> None:
    """Figure 8 of the paper: the points of the plant's lattice move."""
    bpy.ops.wm.open_mainfile(filepath=str(FOLDER / "plant_in_vase.blend"))
    bpy.context.scene.stiv.object_response = "deform"
    select("Lattice")


def pack_box() -> None:
    """An open box, and objects above it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    add_box()
    bpy.ops.mesh.primitive_monkey_add(size=1.0, location=(-0.45, 0.0, 2.0), rotation=(0.0, 0.0, 0.4))
    bpy.ops.mesh.primitive_torus_add(
        major_radius=0.36, minor_radius=0.12, location=(0.6, 0.1, 1.9), rotation=(0.6, 0.2, 0)
    )
    bpy.ops.mesh.primitive_cone_add(radius1=0.4, depth=0.8, location=(0.4, -0.1, 3.0))
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=0.4, location=(-0.6, 0.0, 3.1))
    bpy.ops.mesh.primitive_cylinder_add(radius=0.25, depth=0.9, location=(0.0, 0.1, 4.0), rotation=(0.5, 0.9, 0.0))
    for ob in bpy.data.objects:
        ob.color = COLORS[ob.name]
    view_from(Vector((3.2, -6.2, 4.2)), Vector((0.0, 0.0, 1.7)))
    select("Suzanne")


def add_box() -> None:
    """A box without its top, with thick walls."""
    bpy.ops.mesh.primitive_cube_add(size=2.0, location=(0.0, 0.0, 0.5))
    box = bpy.context.object
    box.name = box.data.name = "Box"
    outer = [(x, y, z) for x in (-1.1, 1.1) for y in (-1.1, 1.1) for z in (-1.1, 0.4)]
    inner = [(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 0.4)]
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4)]
    rim = [(1, 5, 13, 9), (5, 7, 15, 13), (7, 3, 11, 15), (3, 1, 9, 11)]
    faces = sides + [tuple(8 + v for v in reversed(face)) for face in sides] + rim
    box.data.clear_geometry()
    box.data.from_pydata(outer + inner, [], faces)
    box.data.update()


def view_from(place: Vector, target: Vector) -> None:
    """A camera, which renders the picture and shows newcomers where to look."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location, camera.rotation_mode = place, "QUATERNION"
    camera.rotation_quaternion = (target - place).to_track_quat("-Z", "Y")
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def select(name: str) -> None:
    """Select one object."""
    for ob in bpy.context.view_layer.objects:
        ob.select_set(ob.name == name)
    bpy.context.view_layer.objects.active = bpy.data.objects[name]


def write(name: str, scratch: Path) -> None:
    """Write NAME.blend and NAME.png."""
    scene = bpy.context.scene
    scene["stiv_example"] = name
    scene.render.engine, scene.display.shading.color_type = "BLENDER_WORKBENCH", "OBJECT"
    scene.display.shading.show_cavity = True
    size = scene.render.resolution_x, scene.render.resolution_y
    scene.render.resolution_x = scene.render.resolution_y = PICTURE_SIZE
    scene.render.film_transparent, scene.render.filepath = True, str(scratch / f"{name}.png")
    bpy.ops.render.render(write_still=True)
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.film_transparent, scene.render.filepath = False, "//"
    bpy.ops.wm.save_as_mainfile(filepath=str(scratch / f"{name}.blend"), compress=True, check_existing=False)
    for suffix in (".png", ".blend"):
        shutil.copyfile((scratch / name).with_suffix(suffix), (EXAMPLES / name).with_suffix(suffix))


def main() -> None:
    """Write all examples."""
    importlib.import_module("stiv_addon").register()
    makers: tuple[Callable[[], None], ...] = (dress_figure, pot_plant, pack_box)
    for make in makers:
        make()
        with tempfile.TemporaryDirectory() as scratch:  # the path of saving is stored: not one in a home folder
            write(make.__name__, Path(scratch))


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # the Blender module of 4.2 and 4.5 may hang when the interpreter ends
