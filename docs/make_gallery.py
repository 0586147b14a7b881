# SPDX-License-Identifier: GPL-3.0-or-later
"""Make the pictures of docs/gallery: run the sessions of the paper's figures and render the results.

    python docs/make_gallery.py [NAME ...] [--output docs/gallery]

Needs Blender as a Python module and Pillow. NAME.png shows states of one session, from the start to the end,
and NAME.webp the whole session.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

import bpy  # noqa: E402
from PIL import Image  # noqa: E402
from session_films import Film, films  # noqa: E402

import stiv  # noqa: E402
from blend_fixtures.blender_objects import build_scene  # noqa: E402
from blend_fixtures.scenes import colors  # noqa: E402
from blend_fixtures.scenes.fixture import Fixture, Material, MeshObject, View  # noqa: E402
from blend_fixtures.scenes.shape import Shape  # noqa: E402
from stiv.command_line.blender_module import quiet_blender  # noqa: E402

Array = NDArray[np.float64]
CLEAR = Material("Clear", (0.75, 0.9, 1.0, 0.16), 0.2)
MATERIALS: dict[str, Material] = {
    "Shoots": colors.GRASS, "Vase": colors.GLAZE, "Hare": colors.FUR, "Pot": CLEAR, "Tree": colors.LEAF,
    "Corner": colors.STILL, "Knot": colors.MOVING, "Ogre": colors.SKIN, "Shirt": colors.CLOTH, "Glasses": colors.HORN,
    "Hat": colors.FELT, "Bowl": colors.GLAZE, "Ball": colors.MOVING, "Cushion": colors.STILL, "Face": colors.FUR,
    "Waves": colors.STILL, "figure": colors.SKIN, **{material.name: material for material in colors.ORGANS},
}  # fmt: skip
FRAMES, PAUSE = 16, 4  # frames of an animation, and duration of the last one
MILLISECONDS = 170  # per frame


@dataclass(frozen=True)
class Picture:
    """The view of a film, and the fractions of it that the still picture shows side by side."""

    view: View
    shown: tuple[float, ...] = (0.0, 0.5, 1.0)


PICTURES = {
    "dressing": Picture(View((2.6, -5.4, 1.9), (0.0, 0.0, 1.22), 62.0, (380, 420)), (0.0, 0.05, 0.3, 0.7, 1.0)),
    "packing": Picture(View((3.0, -6.4, 4.4), (0.0, 0.0, 0.7), 46.0, (380, 420)), (0.6, 0.8, 1.0)),
    "untangling": Picture(View((2.4, -16.0, 3.4), (0.0, 0.0, 1.2), 45.0, (420, 400)), (0.0, 0.45, 1.0)),
    "weighted_handles": Picture(View((2.6, -4.4, 2.2), (0.0, 0.0, 0.2), 52.0, (320, 280)), (1.0,)),
    "face": Picture(View((2.2, -2.6, 2.7), (0.0, 0.0, 0.1), 50.0, (420, 360)), (0.0, 1.0)),
    "plant": Picture(View((0.0, -9.0, 3.4), (0.0, 0.0, 1.95), 60.0, (360, 420)), (0.0, 0.6, 1.0)),
    "hare": Picture(View((4.6, -4.2, 2.4), (0.0, 0.0, 0.0), 50.0, (420, 360))),
    "tree": Picture(View((6.4, 5.4, 4.2), (0.9, 0.9, 1.1), 50.0, (420, 400))),
    "knot": Picture(View((0.5, -1.0, 15.0), (0.1, 0.3, 0.0), 50.0, (400, 400))),
}


class Stage:
    """A Blender scene of the bodies of a film."""

    def __init__(self, film: Film, view: View) -> None:
        self._body = film.surface.vertex_body
        names = [body.name for body in film.surface.bodies]
        self._objects = [(number, name) for number, name in enumerate(names) if (self._body == number).any()]
        meshes = [
            MeshObject(name, self._shape(film, number), MATERIALS[name], smooth=name not in ("Tree", "Corner"))
            for number, name in self._objects
        ]
        with quiet_blender(errors=True):
            build_scene(Fixture("gallery", "", tuple(meshes), (), view))
        bpy.context.scene.display.render_aa = "5"  # there are many pictures

    def _shape(self, film: Film, number: int) -> Shape:
        kept = np.flatnonzero(self._body == number)
        triangles = film.surface.triangles
        own = np.searchsorted(kept, triangles[self._body[triangles[:, 0]] == number])
        return Shape(film.frames[0][0][kept], tuple(map(tuple, own.tolist())))

    def picture(self, state: Array) -> Image.Image:
        """A rendering of the bodies at these positions."""
        for number, name in self._objects:
            mesh = bpy.data.objects[name].data
            mesh.vertices.foreach_set("co", state[self._body == number].astype(np.float32).ravel())
            mesh.update()
        with tempfile.TemporaryDirectory() as folder, quiet_blender(errors=True):
            bpy.context.scene.render.filepath = str(Path(folder) / "frame.png")
            bpy.ops.render.render(write_still=True)
            with Image.open(bpy.context.scene.render.filepath) as image:
                return image.convert("RGB")


def side_by_side(images: list[Image.Image]) -> Image.Image:
    """Several pictures joined into one, with thin gaps."""
    width, height = images[0].size
    strip = Image.new("RGB", ((width + 4) * len(images) - 4, height), "white")
    for place, image in enumerate(images):
        strip.paste(image, (place * (width + 4), 0))
    return strip


def make(name: str, film: Film, picture: Picture, folder: Path) -> None:
    """Writes NAME.png and NAME.webp."""
    stage, last = Stage(film, picture.view), len(film.frames) - 1
    chosen = [film.frames[round(share * last)] for share in picture.shown]
    images = [stage.picture(state) for moment in _without_twins(chosen) for state in moment]
    side_by_side(images).quantize(192).save(folder / f"{name}.png", optimize=True)
    numbers = np.unique(np.linspace(0, last, FRAMES).round().astype(int))
    frames = [side_by_side([stage.picture(state) for state in film.frames[number]]) for number in numbers]
    frames += [frames[-1]] * PAUSE
    frames[0].save(
        folder / f"{name}.webp", save_all=True, append_images=frames[1:], duration=MILLISECONDS, loop=0, quality=60
    )
    pairs = [len(stiv.find_intersections(state, film.surface)) for state in film.frames[-1]]
    print(f"{name}: {len(film.frames)} moments, {pairs} intersections in the last", flush=True)


def _without_twins(moments: list[tuple[Array, ...]]) -> list[tuple[Array, ...]]:
    """The moments without repeated states."""
    return [m[:1] if all(np.array_equal(m[0], other) for other in m) else m for m in moments]


def main() -> None:
    """Make the named pictures, or all."""
    parser = argparse.ArgumentParser(description="Make the pictures of the gallery.")
    parser.add_argument("names", nargs="*", help="pictures to make (default: all)")
    parser.add_argument("--output", type=Path, default=ROOT / "docs" / "gallery", help="folder to write to")
    arguments = parser.parse_args()
    unknown = [name for name in arguments.names if name not in PICTURES]
    if unknown:
        parser.error(f"no picture named {', '.join(unknown)}; there are {', '.join(PICTURES)}")
    make_film = films()
    for name in arguments.names or PICTURES:
        make(name, make_film[name](), PICTURES[name], arguments.output)


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # the Blender module of 4.2 and 4.5 may hang when the interpreter ends
