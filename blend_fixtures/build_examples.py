# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the extension's example scenes with their pictures into examples/.

    python blend_fixtures/build_examples.py [NAME...]

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
import numpy as np
from mathutils import Vector

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from blend_fixtures.characters import make_character, select_bones
from blend_fixtures.moving_characters import make_walk

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


def pose_arm() -> None:
    """A character whose arm can be lowered onto its body."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    rig, body = make_character(0.07)
    body.color = (0.62, 0.42, 0.32, 1.0)
    rig.show_in_front, rig.data.display_type = True, "STICK"
    select_bones(rig, "Arm.L")
    bpy.ops.object.mode_set(mode="OBJECT")
    view_from(Vector((2.0, -6.5, 1.6)), Vector((0.0, 0.0, 0.3)))
    select("Rig")


def morph_body() -> None:
    """A figure with the shape keys Heavier and Taller, and a shirt that yields to them."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    rig, body = make_character(0.07)
    bpy.ops.object.mode_set(mode="OBJECT")
    body.modifiers.clear()
    body.parent = None
    bpy.data.objects.remove(rig)
    bpy.context.view_layer.update()
    body.vertex_groups.clear()
    body.color = (0.62, 0.42, 0.32, 1.0)
    add_body_keys(body)
    add_shirt().color = (0.25, 0.4, 0.65, 1.0)
    bpy.context.scene.stiv.responders = "unselected"
    view_from(Vector((2.6, -5.6, 1.9)), Vector((0.0, 0.0, 0.4)))
    select("Body")


def add_body_keys(body: bpy.types.Object) -> None:
    """Heavier moves the belly outward, more in front; Taller stretches the trunk."""
    body.shape_key_add(name="Basis")
    rest = np.array([vertex.co for vertex in body.data.vertices])
    around = np.hypot(rest[:, 0], rest[:, 1])
    belly = np.exp(-(((rest[:, 2] - 0.45) / 0.35) ** 2)) * np.clip(1.6 - around / 0.34, 0, 1)
    heavier, taller = rest.copy(), rest.copy()
    heavier[:, :2] += (0.3 * belly / np.maximum(around, 0.05))[:, None] * rest[:, :2] * [1.0, 1.3]
    heavier[:, 1] -= 0.12 * belly
    taller[:, 2] += 0.2 * np.clip(rest[:, 2] / 1.2, 0, 1)
    for name, points in (("Heavier", heavier), ("Taller", taller)):
        key = body.shape_key_add(name=name)
        key.value, key.slider_min = 0.0, -0.5
        key.data.foreach_set("co", points.astype(np.float32).ravel())
    body.active_shape_key_index = 1


def add_shirt(around: int = 40, along: int = 16) -> bpy.types.Object:
    """An open tunic around the trunk; its cage yields."""
    angle = 2 * np.pi * np.arange(around) / around
    rows = [
        np.stack([0.44 * np.cos(angle), 0.44 * np.sin(angle), np.full(around, z)], axis=1)
        for z in np.linspace(-0.1, 1.1, along)
    ]
    number = np.arange(around * along).reshape(along, around)
    after = np.roll(number, -1, axis=1)
    quads = np.stack([number[:-1], after[:-1], after[1:], number[1:]], axis=-1).reshape(-1, 4)
    mesh = bpy.data.meshes.new("Shirt")
    mesh.from_pydata(np.concatenate(rows).tolist(), [], quads.tolist())
    shirt = bpy.data.objects.new("Shirt", mesh)
    bpy.context.collection.objects.link(shirt)
    shirt.stiv.deformation = "vertices"
    return shirt


def clean_walk() -> None:
    """A walk cycle whose forearms swing through the hips."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    make_walk()
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.data.objects["Body"].color = (0.35, 0.5, 0.4, 1.0)
    bpy.data.objects["Rig"].data.display_type = "STICK"
    bpy.context.scene.frame_set(13)
    view_from(Vector((3.0, -6.0, 1.4)), Vector((0.0, 0.0, 0.2)))
    select("Body")


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
    makers: tuple[Callable[[], None], ...] = (dress_figure, pot_plant, pack_box, pose_arm, morph_body, clean_walk)
    for make in makers:
        if sys.argv[1:] and make.__name__ not in sys.argv[1:]:
            continue
        make()
        with tempfile.TemporaryDirectory() as scratch:  # the path of saving is stored: not one in a home folder
            write(make.__name__, Path(scratch))


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # the Blender module of 4.2 and 4.5 may hang when the interpreter ends
