# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands in folders with spaces, umlauts, Japanese names, and paths of more than 260 characters."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest
from json_schemas import read_valid

import stiv
from stiv.command_line.program import run
from tests.batch.jobs import ball_and_wall, edits, write_job

LONG = Path(*["long folder ü " + 48 * str(number) for number in range(5)])
FOLDERS = [Path("with spaces and ümläuts"), Path("ユーザー 山田太郎/デスクトップ"), LONG]


@pytest.fixture(params=FOLDERS, ids=["umlauts", "japanese", "long"])
def folder(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    made = tmp_path / request.param
    made.mkdir(parents=True)
    assert request.param is not LONG or len(str(made)) > 260
    return made


def test_meshes_are_edited_repaired_checked_and_reported(folder: Path) -> None:
    scene, script, edited, mended = (folder / name for name in ("a ö.npz", "e ö.json", "b ö.npz", "c ö.obj"))
    stiv_mesh(scene)
    script.write_text(json.dumps(edits(0, 1)), encoding="utf-8")
    assert run(["replay", str(scene), str(script), "--output", str(edited), "--report", str(folder / "r ö.json")]) == 0
    assert run(["repair", str(edited), "--output", str(mended), "--report", str(folder / "m ö.json")]) == 0
    junit, report = folder / "j ö.xml", folder / "k ö.json"
    assert run(["check", str(mended), "--junit", str(junit), "--json", str(report)]) == 0
    assert [file["file"] for file in read_valid(report, "check")["files"]] == [mended.as_posix()]
    assert [suite.get("name") for suite in ElementTree.parse(junit).getroot()] == [mended.as_posix()]


def stiv_mesh(path: Path) -> None:
    """A free scene: a ball above a wall."""
    from stiv.mesh_files import write_mesh

    write_mesh(path, ball_and_wall(0))


def test_a_batch_runs_for_a_user_with_this_home(folder: Path) -> None:
    job = write_job(folder, 2, repeat=1)
    home = {"HOME": str(folder), "USERPROFILE": str(folder), "TEMP": str(folder), "TMPDIR": str(folder)}
    packages = [str(Path(package.__file__).parents[1]) for package in (stiv, np)]
    search = {"PYTHONPATH": os.pathsep.join(packages)}
    command = [sys.executable, "-m", "stiv.command_line", "batch", str(job), "--workers", "1"]
    done = subprocess.run(
        command, env=os.environ | home | search, capture_output=True, encoding="utf-8", errors="replace", timeout=120,
        check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert sorted(path.name for path in (folder / "out").iterdir()) == ["result 0.npz", "result 1.npz"]
