# SPDX-License-Identifier: GPL-3.0-or-later
"""The fixture for pytest, in separate test sessions."""

import os
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest
from check_files import APART, CROSSING, written

import stiv

FIXTURES = Path(__file__).resolve().parents[2] / "blend_fixtures"


def run_tests(folder: Path, body: str) -> tuple[int, str]:
    """Exit code and output of a session with one test of this body."""
    test = f"def test_asset(assert_free_of_intersections):\n    {body}\n"
    (folder / "test_assets.py").write_text(test, encoding="utf-8")
    installed = any(entry.name == "stiv" for entry in metadata.entry_points(group="pytest11"))
    plugin = [] if installed else ["-p", "stiv.pytest_plugin"]
    used = [str(Path(package.__file__).parents[1]) for package in (stiv, pytest)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(used)}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *plugin, str(folder)]
    ended = subprocess.run(command, capture_output=True, text=True, env=environment, cwd=folder, check=False)
    return ended.returncode, ended.stdout


def test_a_clear_mesh_passes(tmp_path):
    code, out = run_tests(tmp_path, f"assert_free_of_intersections({written(tmp_path / 'a.obj', APART)!r})")
    assert code == 0, out


def test_intersections_fail_with_objects_and_faces_named(tmp_path):
    code, out = run_tests(tmp_path, f"assert_free_of_intersections({written(tmp_path / 'a.obj', CROSSING)!r})")
    assert code == 1
    assert "a.obj: 1 intersecting pair" in out
    assert 'object "flat", triangle 0 - object "upright ü", triangle 0' in out
    assert "subprocess" not in out  # no traceback into the plugin


def test_a_limit_to_objects_is_passed_on(tmp_path):
    mesh = written(tmp_path / "a.obj", CROSSING)
    assert run_tests(tmp_path, f"assert_free_of_intersections({mesh!r}, objects=['upright ü'])")[0] == 0


def test_a_missing_file_fails_and_says_so(tmp_path):
    code, out = run_tests(tmp_path, "assert_free_of_intersections('missing.obj')")
    assert code == 1 and "missing.obj: there is no such file" in out
