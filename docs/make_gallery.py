# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the pictures of docs/gallery anew: runs the sessions of the paper's figures and renders what they come to.

    python docs/make_gallery.py [NAME ...] [--output docs/gallery]

Needs Blender as a Python module and Pillow. Each picture shows states of one session, from the start to the end.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

import bpy  # noqa: E402
from PIL import Image  # noqa: E402

import stiv  # noqa: E402
from benchmarks.velocity_filter import compare  # noqa: E402
from blend_fixtures.blender_objects import build_scene  # noqa: E402
from blend_fixtures.scenes import colors  # noqa: E402
from blend_fixtures.scenes.fixture import Fixture, Material, MeshObject, View  # noqa: E402
from blend_fixtures.scenes.sessions import face_into_waves, packing, weighted_handles  # noqa: E402
from blend_fixtures.scenes.sessions.catalogue import table_sessions  # noqa: E402
from blend_fixtures.scenes.sessions.session import Session  # noqa: E402
from blend_fixtures.scenes.shape import Shape  # noqa: E402
from blend_fixtures.scenes.tangled import Tangle, arm_in_body  # noqa: E402
from stiv.command_line.quiet import quiet_blender  # noqa: E402

Array = NDArray[np.float64]
MATERIALS: dict[str, Material] = {
    "Shoots": colors.GRASS, "Vase": colors.GLAZE, "Hare": colors.FUR, "Pot": colors.GLAZE, "Tree": colors.LEAF,
    "Corner": colors.STILL, "Knot": colors.MOVING, "Ogre": colors.SKIN, "Shirt": colors.CLOTH, "Glasses": colors.HORN,
    "Hat": colors.FELT, "Bowl": colors.GLAZE, "Ball": colors.MOVING, "Cushion": colors.STILL, "Face": colors.FUR,
    "Waves": colors.STILL, "figure": colors.SKIN, **{material.name: material for material in colors.ORGANS},
}  # fmt: skip
FRAMES = 24  # of an animation


@dataclass(frozen=True)
class Film:
    """States of one surface, in order."""

    surface: stiv.Surface
    states: list[Array]


@dataclass(frozen=True)
class Picture:
    """How a film is shown: from where, which of its states side by side, whether it moves too."""

    film: Callable[[], Film]
    view: View
    shown: tuple[float, ...] = (0.0, 0.5, 1.0)  #: shares of the film
    moving: bool = False


def filmed(session: Session) -> Film:
    """Every accepted state of a session; its stages share one surface."""
    states, stages = [], session.stages()
    stage = next(stages)
    while True:
        solver = stiv.EditSession(stage.surface, stage.deformation, stage.controls, stiv.EditOptions(**stage.options))
        states.append(solver.surface)
        for edit in stage.edits:
            states.append(solver.edit(edit(solver.controls)).surface)
        try:
            stage = stages.send(solver.controls)
        except StopIteration:
            return Film(stage.surface, states)


def weightings() -> Film:
    """The start, and the last state of each weighting."""
    films = [filmed(session) for session in weighted_handles.sessions()]
    return Film(films[0].surface, [films[0].states[0], *(film.states[-1] for film in films)])


def pressed_face() -> Film:
    """The start, what the filter of velocities makes of the face, and what ours does."""
    states = compare()[1]
    return Film(face_into_waves.stage().surface, [states["start"], states["filter"], states["ours"]])


def untangled(tangle: Tangle) -> Film:
    """Before and after repair."""
    result = stiv.repair(tangle.surface, tangle.positions)
    return Film(tangle.surface, [tangle.positions, result.positions])


def pictures() -> dict[str, Picture]:
    """All of the gallery, by the name of their files."""
    sessions = table_sessions()

    def of(name: str) -> Callable[[], Film]:
        return lambda: filmed(sessions[name])

    half, four = (0.0, 1.0), (0.0, 0.25, 0.5, 0.75, 1.0)
    return {
        "dressing": Picture(
            of("dressing"), View((2.6, -5.4, 1.9), (0.0, 0.0, 1.22), 62.0, (380, 420)), (0.0, 0.4, 0.7, 1.0), True
        ),
        "packing": Picture(
            lambda: filmed(packing.session()),
            View((3.0, -6.4, 4.4), (0.0, 0.0, 0.7), 46.0, (380, 420)),
            (0.6, 0.8, 1.0),
        ),
        "untangling": Picture(
            lambda: untangled(arm_in_body()), View((2.4, -16.0, 3.4), (0.0, 0.0, 1.2), 45.0, (420, 400)), half
        ),
        "weighted_handles": Picture(weightings, View((2.6, -4.4, 2.2), (0.0, 0.0, 0.2), 52.0, (320, 280)), four),
        "face": Picture(pressed_face, View((2.2, -2.6, 2.7), (0.0, 0.0, 0.1), 50.0, (420, 360))),
        "plant": Picture(
            of("plant"), View((0.0, -9.0, 3.4), (0.0, 0.0, 1.95), 60.0, (360, 420)), (0.0, 0.6, 1.0), True
        ),
        "hare": Picture(of("hare"), View((4.6, -4.2, 2.4), (0.0, 0.0, 0.0), 50.0, (420, 360))),
        "tree": Picture(of("tree"), View((6.4, 5.4, 4.2), (0.9, 0.9, 1.1), 50.0, (420, 400))),
        "knot": Picture(of("knot"), View((0.5, -1.0, 15.0), (0.1, 0.3, 0.0), 50.0, (400, 400)), moving=True),
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

    def _shape(self, film: Film, number: int) -> Shape:
        kept = np.flatnonzero(self._body == number)
        triangles = film.surface.triangles
        own = np.searchsorted(kept, triangles[self._body[triangles[:, 0]] == number])
        return Shape(film.states[0][kept], tuple(map(tuple, own.tolist())))

    def picture(self, state: Array) -> Image.Image:
        """The bodies at these positions."""
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
    """One picture of several, with thin gaps."""
    width, height = images[0].size
    strip = Image.new("RGB", ((width + 4) * len(images) - 4, height), "white")
    for place, image in enumerate(images):
        strip.paste(image, (place * (width + 4), 0))
    return strip


def make(name: str, picture: Picture, folder: Path) -> None:
    """Writes NAME.png, and NAME.webp if it moves."""
    film = picture.film()
    stage, last = Stage(film, picture.view), len(film.states) - 1
    images = [stage.picture(film.states[round(share * last)]) for share in picture.shown]
    side_by_side(images).quantize(192).save(folder / f"{name}.png", optimize=True)
    pairs = len(stiv.find_intersections(film.states[-1], film.surface))
    print(f"{name}: {len(film.states)} states, {pairs} intersections in the last", flush=True)
    if picture.moving:
        numbers = np.linspace(0, last, FRAMES).round().astype(int)
        frames = [stage.picture(film.states[number]) for number in numbers]
        frames += [frames[-1]] * 6
        frames[0].save(
            folder / f"{name}.webp", save_all=True, append_images=frames[1:], duration=120, loop=0, quality=60
        )


def main() -> None:
    """Makes the pictures named, or all."""
    parser = argparse.ArgumentParser(description="Make the pictures of the gallery.")
    parser.add_argument("names", nargs="*", help="pictures to make (default: all)")
    parser.add_argument("--output", type=Path, default=ROOT / "docs" / "gallery", help="folder to write to")
    arguments = parser.parse_args()
    known = pictures()
    unknown = [name for name in arguments.names if name not in known]
    if unknown:
        parser.error(f"no picture named {', '.join(unknown)}; there are {', '.join(known)}")
    for name in arguments.names or known:
        make(name, known[name], arguments.output)


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # the Blender module of 4.2 and 4.5 may hang when the interpreter ends
