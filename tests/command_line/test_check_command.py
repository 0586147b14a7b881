# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv check` on mesh files: exit codes, report, names."""

import importlib.util
import json
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from json_schemas import read_valid

from stiv import mesh_files
from stiv.command_line import check, file_checking, program
from tests.checks.check_files import APART, CROSSING, written

TOUCHING = APART.replace("v 0 0 1\n", "v 0.25 0.25 0\n")


def test_a_free_mesh_ends_with_0(tmp_path, capsys):
    assert program.run(["check", written(tmp_path / "two sheets ä.obj", APART)]) == 0
    assert "two sheets ä.obj: free of intersections (6 vertices, 2 triangles, 2 objects" in capsys.readouterr().out


@pytest.mark.parametrize("text", [CROSSING, TOUCHING], ids=["crossing", "touching"])
def test_intersections_end_with_4(tmp_path, text):
    assert program.run(["check", written(tmp_path / "a.obj", text)]) == 4


def test_pairs_are_named_for_people_and_in_the_report(tmp_path, capsys):
    report = tmp_path / "the report.json"
    code = program.run(["check", "--json", str(report), written(tmp_path / "a.obj", CROSSING)])
    assert code == 4
    assert 'object "flat", triangle 0 - object "upright ü", triangle 0' in capsys.readouterr().out
    data = json.loads(report.read_text(encoding="utf-8"))
    assert (data["schema"], data["version"], data["free"], data["intersections"]) == ("stiv-check", 2, False, 1)
    (pair,) = data["files"][0]["pairs"]
    assert pair["first"] == {"object": "flat", "kind": "triangle", "number": 0}
    assert pair["second"] == {"object": "upright ü", "kind": "triangle", "number": 0}
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith(".")] == []


def unwelded_tetrahedra():
    """Two tetrahedra of which every triangle has vertices of its own: 4 vertices in 3 triangles each, 12 corners."""
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
    faces = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
    vertices = np.concatenate([corners[faces].reshape(-1, 3), corners[faces].reshape(-1, 3) + (0, 0, 2)])
    return vertices, np.arange(24).reshape(8, 3), np.repeat([0, 1], 4)


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".npz"])
def test_seams_of_an_object_are_counted_and_no_intersections(tmp_path, capsys, suffix):
    vertices, triangles, owners = unwelded_tetrahedra()
    mesh = mesh_files.mesh.checked_mesh(vertices, triangles, ("One", "Two"), owners)
    path, report = tmp_path / f"seams{suffix}", tmp_path / "report.json"
    mesh_files.write_mesh(path, mesh)
    assert program.run(["check", "--seams", "--json", str(report), str(path)]) == 0
    assert "triangle 0 - object" in capsys.readouterr().out
    (data,) = read_valid(report, "check")["files"]
    assert (data["intersections"], data["seams"], len(data["seam_pairs"])) == (0, 12, 12)
    for height, code in ((0.875, 0), (1.0, 4)):  # the tip of one object meets the middle of the other's base
        moved = vertices - np.outer(owners.repeat(3), (0.25, 0.25, height))
        mesh_files.write_mesh(path, replace(mesh, vertices=moved))
        assert program.run(["check", str(path)]) == code


def test_duplicate_triangles_of_an_object_are_not_a_seam(tmp_path):
    path = tmp_path / "doubled.npz"
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)], float)
    np.savez(path, vertices=np.concatenate([corners, corners]), triangles=np.arange(6).reshape(2, 3))
    assert program.run(["check", str(path)]) == 4


def test_many_pairs_are_counted_and_the_first_listed(tmp_path, capsys):
    corners = np.random.default_rng(3).normal(size=(90, 3))
    path = tmp_path / "soup.npz"
    np.savez(path, vertices=corners, triangles=np.arange(90).reshape(30, 3))
    assert program.run(["check", str(path)]) == 4
    out = capsys.readouterr().out
    assert "more" in out and len(out.splitlines()) == 12


@pytest.mark.parametrize("name", ["missing.obj", "missing.blend", "."])
def test_a_missing_file_ends_with_2(tmp_path, capsys, name):
    assert program.run(["check", str(tmp_path / name)]) == 2
    assert "there is no such file" in capsys.readouterr().err


def test_a_bad_file_ends_with_2_and_writes_nothing(tmp_path, capsys):
    report = tmp_path / "report.json"
    bad = written(tmp_path / "bad.obj", "v 0 0 nan\n")
    assert program.run(["check", "--json", str(report), bad]) == 2
    assert "bad.obj: vertex 0: coordinate is not finite" in capsys.readouterr().err
    assert not report.exists()


def test_a_report_that_cannot_be_written_ends_with_2_before_any_work(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(check, "check_path", lambda *rest: pytest.fail("worked before looking at the folder"))
    mesh = written(tmp_path / "a.obj", APART)
    assert program.run(["check", "--json", str(tmp_path / "nowhere" / "report.json"), mesh]) == 2
    assert "there is no folder" in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["melt"],
        ["check"],
        ["check", "a", "--frames", "9:1"],
        ["check", "a", "--frames", "all"],
        ["check", "a", "--fast"],
    ],
)
def test_wrong_usage_ends_with_1(arguments, capsys):
    assert program.run(arguments) == 1
    assert "usage: stiv" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [["--help"], ["check", "--help"], ["replay", "--help"]])
def test_help_ends_with_0(arguments, capsys):
    assert program.run(arguments) == 0
    assert "usage: stiv" in capsys.readouterr().out


@pytest.mark.parametrize("name", ["check", "replay", "repair", "resolve", "batch"])
def test_help_has_examples_and_exit_codes(name, capsys):
    program.run([name, "--help"])
    out = capsys.readouterr().out
    assert f"  stiv {name} " in out and "exit codes:" in out


def test_a_fault_of_the_program_ends_with_3(tmp_path, capsys, monkeypatch):
    def fail(path):
        raise ZeroDivisionError("a fault")

    monkeypatch.setattr(file_checking, "read_mesh", fail)
    assert program.run(["check", written(tmp_path / "a.obj", APART)]) == 3
    assert "ZeroDivisionError: a fault" in capsys.readouterr().err


def test_ctrl_c_ends_with_5(tmp_path, monkeypatch):
    def interrupt(path):
        raise KeyboardInterrupt

    monkeypatch.setattr(file_checking, "read_mesh", interrupt)
    assert program.run(["check", written(tmp_path / "a.obj", APART)]) == 5


def test_without_blender_a_blend_ends_with_2_and_says_how_to_get_it(tmp_path, capsys, monkeypatch):
    real = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name, *rest: None if name == "bpy" else real(name, *rest))
    assert program.run(["check", written(tmp_path / "a.blend", "")]) == 2
    assert "pip install bpy" in capsys.readouterr().err


def test_the_module_runs_as_a_program(tmp_path):
    command = [sys.executable, "-m", "stiv.command_line", "check", written(tmp_path / "a.obj", CROSSING)]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ended.returncode == 4, ended.stderr
