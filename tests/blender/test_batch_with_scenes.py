# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv batch` on .blend files: a worker keeps its Blender and gives the results of `stiv replay`.

Files that Blender saves are not equal by bytes, so coordinates are compared.
"""

import json
import shutil
from pathlib import Path

import bpy
import pytest

from stiv.blender import read_surface
from stiv.blender.scripts.blend_files import open_blend
from stiv.command_line import program

FOLDER = Path(__file__).resolve().parents[2] / "blend_fixtures"
NAMES = ("box_along_wall", "rigid_ellipsoid")


def coordinates(path: Path):
    open_blend(path)
    return read_surface(bpy.context).positions


@pytest.mark.shared
def test_a_batch_of_scenes_gives_what_single_commands_give(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stiv_addon = pytest.importorskip("stiv_addon", reason="the add-on is not installed as a package")
    entries = []
    for name in NAMES:
        shutil.copy(FOLDER / f"{name}.blend", tmp_path)
        shutil.copy(FOLDER / f"{name}.edits.json", tmp_path)
        files = {"scene": f"{name}.blend", "edits": f"{name}.edits.json", "output": f"out/{name}.blend"}
        entries.append({"name": name, "command": "replay", **files})
        entries.append(
            {"name": f"check {name}", "command": "check", "scene": f"{name}.blend", "report": f"{name}.json"}
        )
    job = tmp_path / "job.json"
    job.write_text(json.dumps({"schema": "stiv-batch", "version": 2, "entries": entries}))
    packages = Path(stiv_addon.__file__).parents[1]
    monkeypatch.setenv("PYTHONPATH", str(packages))
    assert program.run(["batch", str(job), "--workers", "1", "--report", str(tmp_path / "report.json")]) == 0
    report = json.loads((tmp_path / "report.json").read_text())
    assert [entry["exit_code"] for entry in report["entries"]] == [0, 0, 0, 0]
    for name in NAMES:
        alone = tmp_path / f"{name}-alone.blend"
        files = [str(tmp_path / f"{name}{suffix}") for suffix in (".blend", ".edits.json")]
        assert program.run(["replay", *files, "-o", str(alone)]) == 0
        assert (coordinates(tmp_path / f"out/{name}.blend") == coordinates(alone)).all()
        assert json.loads((tmp_path / f"{name}.json").read_text())["free"]
