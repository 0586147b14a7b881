# SPDX-License-Identifier: GPL-3.0-or-later
"""Write every fixture as a .blend file with its edit script; those of the paper's figures go into figures/.

    python blend_fixtures/build.py [NAME ...] [--output FOLDER]

Needs Blender as a Python module, and the package `stiv` with its add-on. Use the oldest supported Blender
(4.2): every later version opens what it writes.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import shutil
import sys
import tempfile
from pathlib import Path

os.environ["HOME"] = "/"  # Blender writes the home folder into every file it saves

import bpy

FOLDER = Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parent))

from blend_fixtures.blender_objects import build_scene  # noqa: E402
from blend_fixtures.scenes.catalogue import all_fixtures  # noqa: E402
from blend_fixtures.scenes.fixture import Fixture  # noqa: E402
from blend_fixtures.scenes.sessions.figure_fixtures import figure_fixtures  # noqa: E402


def edit_script(fixture: Fixture) -> str:
    """The text of the fixture's .edits.json."""
    head = {"schema": "stiv-edits", "version": 1, "description": fixture.summary, "settings": fixture.settings}
    lines = ",\n".join("    " + json.dumps(step) for step in fixture.steps)
    fields = "".join(f"  {json.dumps(key)}: {json.dumps(value)},\n" for key, value in head.items())
    return "{\n" + fields + '  "steps": [\n' + lines + "\n  ]\n}\n"


def write(fixture: Fixture, folder: Path) -> None:
    """Write NAME.blend and NAME.edits.json into `folder`."""
    build_scene(fixture)
    with (
        tempfile.TemporaryDirectory() as scratch
    ):  # a .blend stores the path of saving, which must not be in a home folder
        saved = Path(scratch) / f"{fixture.name}.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(saved), compress=True, check_existing=False)
        shutil.copyfile(saved, folder / saved.name)
    (folder / f"{fixture.name}.edits.json").write_text(edit_script(fixture), encoding="utf-8")
    size = (folder / f"{fixture.name}.blend").stat().st_size
    print(f"{fixture.name}: {size / 1024:.0f} KiB")


def register_addon() -> None:
    """Register the add-on, whose settings some fixtures store."""
    importlib.import_module("stiv_addon").register()


def main() -> None:
    """Build the named fixtures, or all."""
    parser = argparse.ArgumentParser(description="Write the fixtures' .blend files and edit scripts.")
    parser.add_argument("names", nargs="*", help="fixtures to write (default: all)")
    parser.add_argument("--output", type=Path, default=FOLDER, help="folder to write to")
    arguments = parser.parse_args()
    register_addon()
    figures = arguments.output / "figures"
    figures.mkdir(parents=True, exist_ok=True)
    fixtures = {fixture.name: (fixture, arguments.output) for fixture in all_fixtures()}
    fixtures |= {fixture.name: (fixture, figures) for fixture in figure_fixtures()}
    unknown = [name for name in arguments.names if name not in fixtures]
    if unknown:
        parser.error(f"no fixture named {', '.join(unknown)}; there are {', '.join(fixtures)}")
    for name in arguments.names or fixtures:
        write(*fixtures[name])


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # the Blender module of 4.2 and 4.5 may hang when the interpreter ends
