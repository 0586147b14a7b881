# SPDX-License-Identifier: GPL-3.0-or-later
"""Make the short films of the guide and of the extension's page: sessions of the paper's figures as WebM.

    python docs/make_films.py [NAME ...] [--output docs/films]

Needs Blender 4.5 as a Python module and Pillow. Prints the size of each film, and fails over 3 MB.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from make_gallery import PICTURES, Stage  # noqa: E402
from session_films import films  # noqa: E402

from stiv.command_line.blender_module import quiet_blender  # noqa: E402

NAMES = ("dressing", "plant", "packing")
MOMENTS, STILL = 100, 30  # frames that move, and frames of the last moment
FRAMES_PER_SECOND = 20
SCALE = 1.5  # of the gallery's pictures
LARGEST = 3_000_000  # bytes


def render_frames(name: str, folder: Path) -> tuple[list[Path], tuple[int, int]]:
    """Render the moments of a session; returns their files and their size in pixels."""
    film = films()[name]()
    stage = Stage(film, PICTURES[name].view)
    render = bpy.context.scene.render
    render.resolution_percentage = round(100 * SCALE)
    numbers = np.unique(np.linspace(0, len(film.frames) - 1, MOMENTS).round().astype(int))
    files = []
    for number in numbers:
        files.append(folder / f"{number:04}.png")
        image = stage.picture(film.frames[number][0])
        image.resize((image.width // 2 * 2, image.height // 2 * 2)).save(files[-1])  # the codec needs even sizes
    return files + [files[-1]] * STILL, (image.width // 2 * 2, image.height // 2 * 2)


def encode(files: list[Path], size: tuple[int, int], target: Path) -> None:
    """Write pictures as a film, with Blender's sequencer."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    strip = scene.sequence_editor_create().sequences.new_image("film", str(files[0]), 1, 1)
    for file in files[1:]:
        strip.elements.append(file.name)
    scene.frame_start, scene.frame_end = 1, len(files)
    scene.view_settings.view_transform = "Standard"
    render = scene.render
    render.resolution_x, render.resolution_y = size
    render.fps = FRAMES_PER_SECOND
    render.image_settings.file_format = "FFMPEG"
    render.ffmpeg.format, render.ffmpeg.codec = "WEBM", "WEBM"
    render.ffmpeg.constant_rate_factor = "MEDIUM"
    render.use_file_extension, render.filepath = False, str(target)
    bpy.ops.render.render(animation=True)


def make(name: str, output: Path) -> None:
    """Make one film."""
    with tempfile.TemporaryDirectory() as folder, quiet_blender(errors=True):
        files, size = render_frames(name, Path(folder))
        encode(files, size, output / f"{name}.webm")
    written = (output / f"{name}.webm").stat().st_size
    print(f"{name}.webm: {size[0]} x {size[1]}, {len(files) / FRAMES_PER_SECOND:.1f} s, {written:,} bytes", flush=True)
    if written > LARGEST:
        raise SystemExit(f"{name}.webm: over {LARGEST:,} bytes")


def main() -> None:
    """Make the named films, or all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(NAMES)}")
    parser.add_argument("--output", type=Path, default=ROOT / "docs" / "films", help="folder to write to")
    arguments = parser.parse_args()
    arguments.output.mkdir(exist_ok=True)
    for name in arguments.names or NAMES:
        make(name, arguments.output)


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # the Blender module of 4.5 may hang when the interpreter ends
