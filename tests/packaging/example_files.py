# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the scenes and meshes that the examples in the documents use; test_examples runs this in a
subprocess.

Usage: example_files.py DOCUMENTS   with the folder of the documents; the files go into the working directory.
"""

import os
import re
import shutil
import sys
from pathlib import Path
from typing import Any

import bpy

CUBE = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
LAST = 120


def cube(name: str, location: tuple[float, float, float], half: float = 0.5) -> Any:
    """A cube with subdivided faces, so that it can deform."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(half * x for x in corner) for corner in CUBE], [], FACES)
    ob = bpy.data.objects.new(name, mesh)
    ob.location = location
    bpy.context.scene.collection.objects.link(ob)
    bpy.context.view_layer.update()
    return ob


def saved(name: str) -> None:
    """Save the scene, and start an empty one."""
    Path(name).parent.mkdir(exist_ok=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(Path(name).absolute()))
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)


def walk(name: str, height: float) -> None:
    """A cube that passes the position of another one at this height."""
    cube("Stone", (0, 0, 0))
    walker = cube("Walker", (-3, 0, height))
    for frame, x in ((1, -3.0), (LAST, 3.0)):
        walker.location.x = x
        walker.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_end = LAST
    saved(name)


def overlapping(name: str, first: str, second: str) -> None:
    """Two cubes that overlap at a corner."""
    cube(first, (0, 0, 0))
    cube(second, (0.95, 0.9, 0.85))
    saved(name)


def shoots(name: str) -> None:
    """A lattice that deforms a cube, above a floor."""
    plant = cube("Plant", (0, 0, 2))
    cube("Floor", (0, 0, -1))
    lattice = bpy.data.objects.new("Lattice", bpy.data.lattices.new("Lattice"))
    lattice.location, lattice.scale = (0, 0, 2), (2, 2, 2)
    bpy.context.scene.collection.objects.link(lattice)
    plant.modifiers.new("Lattice", "LATTICE").object = lattice
    saved(name)


def main(documents: Path) -> None:
    """Write all files."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    walk("assets/walk.blend", 2.0)
    walk("walk.blend", 0.8)
    overlapping("figure.blend", "Torso", "Arm")
    overlapping("dressed.blend", "Body", "Dress")
    overlapping("cow.blend", "Cow", "Bell")
    cube("Crate", (0, 0, 0))
    saved("assets.blend")
    shoots("SCENE.blend")
    shoots("vase.blend")
    corners = [" ".join(str(x + offset) for x in corner) for offset in (0.0, 1.9) for corner in CUBE]
    faces = [" ".join(str(corner + 1 + first) for corner in face) for first in (0, 8) for face in FACES]
    Path("scan.obj").write_text("".join(f"v {line}\n" for line in corners) + "".join(f"f {line}\n" for line in faces))
    Path("known.json").write_text('{"schema": "stiv-baseline", "version": 1, "accepted": []}')
    shutil.copy(documents.parent / "blend_fixtures/examples/clean_walk.blend", "character.blend")
    Path("blend_fixtures").symlink_to(documents.parent / "blend_fixtures")
    blocks = {name: re.search(r"```json\n(.*?)```", (documents / f"{name}.md").read_text(), re.DOTALL)[1]
              for name in ("batch", "edit_scripts")}  # fmt: skip
    Path("job.json").write_text(blocks["batch"])
    for script in ("EDITS.json", "vase.edits.json"):
        Path(script).write_text(blocks["edit_scripts"])


if __name__ == "__main__":
    main(Path(sys.argv[1]))
    sys.stdout.flush()
    os._exit(0)
