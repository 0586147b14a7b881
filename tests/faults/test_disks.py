# SPDX-License-Identifier: GPL-3.0-or-later
"""Full disks (simulated by a limit of 200 bytes per file) and missing folders: nothing is lost."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import stiv
from stiv.command_line import program

pytest.importorskip("resource", reason="limits of processes are POSIX")

SCRIPT = """\
import resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (200, 200))
sys.path[:0] = [{packages!r}]
from stiv.command_line import program
sys.exit(program.run(sys.argv[1:]))
"""


def on_a_full_disk(*arguments: object) -> subprocess.CompletedProcess:
    script = SCRIPT.format(packages=str(Path(stiv.__file__).parents[1]))
    command = [sys.executable, "-c", script, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.fixture
def mesh(tmp_path: Path) -> Path:
    path = tmp_path / "two sheets ü.npz"
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]], float)
    names = np.array(["Below", "Above"])
    np.savez(path, vertices=vertices, triangles=[[0, 1, 2], [3, 4, 5]], object_names=names, triangle_object=[0, 1])
    return path


@pytest.mark.parametrize("option", ["--json", "--junit"])
def test_a_report_that_does_not_fit_preserves_the_old_one(tmp_path, mesh, option):
    report = tmp_path / "report ü"
    report.write_text("old")
    ended = on_a_full_disk("check", mesh, option, report)
    assert ended.returncode == 2, ended.stderr
    assert "report ü: cannot be written: File too large" in ended.stderr
    assert report.read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([mesh.name, report.name])


def test_a_result_that_does_not_fit_preserves_the_old_one(tmp_path, mesh):
    edits, out = tmp_path / "edits.json", tmp_path / "out.npz"
    step = {"operator": "move", "objects": ["Above"], "values": {"value": [0, 0, -0.5]}}
    edits.write_text(json.dumps({"schema": "stiv-edits", "version": 1, "steps": [step]}))
    out.write_bytes(b"old")
    ended = on_a_full_disk("replay", mesh, edits, "-o", out)
    assert ended.returncode == 2, ended.stderr
    assert "out.npz: cannot be written" in ended.stderr and out.read_bytes() == b"old"
    assert len(list(tmp_path.iterdir())) == 3


def test_a_missing_folder_is_named_before_any_work(tmp_path, mesh, capsys):
    assert program.run(["check", str(mesh), "--json", str(tmp_path / "nowhere/report.json")]) == 2
    assert "there is no folder" in capsys.readouterr().err
