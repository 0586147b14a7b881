# SPDX-License-Identifier: GPL-3.0-or-later
"""`--blender PATH`. A small program replaces Blender: it accepts the same options and has its own Python.

Where STIV_TEST_BLENDER names an installed Blender, that is used as well.
"""

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from stiv.command_line import program

CROSSING = "o flat\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no upright\nv 0.2 0.2 -1\nv 0.2 0.2 1\nv 2 2 0\nf 4 5 6\n"
STAND_IN = """\
#!{python}
import runpy, sys
assert sys.argv[1:7] == ["-b", "--factory-startup", "--disable-autoexec", "--python-exit-code", "3", "--python"]
print("Blender 4.9.0", flush=True)
runpy.run_path(sys.argv[7], run_name="__main__")
"""


@pytest.fixture
def stand_in(tmp_path: Path) -> str:
    path = tmp_path / "my blender"
    path.write_text(STAND_IN.format(python=sys.executable))
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return str(path)


@pytest.mark.skipif(sys.platform == "win32", reason="the stand-in is a script of Unix")
def test_the_command_runs_inside_and_its_exit_code_comes_back(tmp_path, capsys, stand_in):
    mesh = tmp_path / "a ü.obj"
    mesh.write_text(CROSSING)
    assert program.run(["check", str(mesh), "--blender", stand_in]) == 4
    out = capsys.readouterr().out
    assert "1 intersecting pair" in out and "Blender 4.9.0" not in out
    assert program.run(["check", f"--blender={stand_in}", str(tmp_path / "missing.obj")]) == 2


def test_a_program_that_is_not_there_ends_with_2(tmp_path, capsys):
    assert program.run(["check", "a.blend", "--blender", str(tmp_path / "none")]) == 2
    assert "is not an executable program" in capsys.readouterr().err


def test_a_file_that_is_not_a_program_ends_with_2(monkeypatch, capsys):
    def refuse(*_, **__):
        raise OSError(193, "not a valid application")

    monkeypatch.setattr(subprocess, "Popen", refuse)
    assert program.run(["check", "a.blend", "--blender", sys.executable]) == 2
    assert "is not an executable program" in capsys.readouterr().err


@pytest.mark.skipif(sys.platform == "win32", reason="the program is one of Unix")
def test_a_program_that_is_not_blender_ends_with_2(capsys):
    assert program.run(["check", "a.blend", "--blender", "/bin/true"]) == 2
    assert "did not run STIV's script" in capsys.readouterr().err


@pytest.mark.skipif("STIV_TEST_BLENDER" not in os.environ, reason="STIV_TEST_BLENDER names no installed Blender")
def test_an_installed_blender_checks_a_file():
    scene = Path(__file__).resolve().parents[2] / "blend_fixtures/box_along_wall.blend"
    assert program.run(["check", str(scene), "--blender", os.environ["STIV_TEST_BLENDER"]]) == 0
