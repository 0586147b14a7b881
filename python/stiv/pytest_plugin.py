# SPDX-License-Identifier: GPL-3.0-or-later
"""A fixture for pytest that asserts that scenes and meshes are free of intersections.

    def test_the_plant_is_free(assert_free_of_intersections):
        assert_free_of_intersections("assets/plant.blend", frames="1:120")

Each check runs `stiv check` in its own process. So the test process never loads Blender, and a crash of Blender only
fails one test. The ini option `stiv_blender` names an installed Blender to use.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

import pytest

from stiv.checks.findings import counted
from stiv.exit_codes import ExitCode

LISTED = 20  # pairs in a message
AssertFree = Callable[..., None]


def pytest_addoption(parser: pytest.Parser) -> None:
    """Adds the ini option."""
    parser.addini("stiv_blender", "an installed Blender for assert_free_of_intersections (default: bpy)", default="")


@pytest.fixture(scope="session")
def assert_free_of_intersections(pytestconfig: pytest.Config) -> AssertFree:
    """A function that fails the test if a file has intersections. The message names objects and faces.

    path: a .blend or a mesh file. frames: "A:B", "A:B:STEP" or "scene", to test these and the motion between them.
    objects: names of the objects to test, empty for all. baseline: a file of accepted findings. scene: name of the
    scene to test, or "all". render: whether to test render levels of any size. hidden: whether to test hidden objects.
    """
    blender = pytestconfig.getini("stiv_blender")

    def assert_free(
        path: str | PathLike[str],
        *,
        frames: str | None = None,
        objects: Sequence[str] = (),
        baseline: str | PathLike[str] | None = None,
        scene: str = "all",
        render: bool = False,
        hidden: bool = False,
    ) -> None:
        __tracebackhide__ = True
        options = [f"--object={name}" for name in objects]
        options += [f"--{name}={value}" for name, value in (("frames", frames), ("baseline", baseline)) if value]
        options += [f"--scene={scene}"] + ["--render"] * render + ["--hidden"] * hidden
        options += ["--blender", blender] if blender else []
        message = _check(Path(path), options)
        if message:
            pytest.fail(message, pytrace=False)

    return assert_free


def _check(path: Path, options: Sequence[str]) -> str:
    """The message on a file with intersections or an error; empty for a file without."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [sys.executable, "-m", "stiv.command_line", "check", str(path), "--json", str(report), *options]
        ended = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", errors="replace", check=False)
        if ended.returncode == ExitCode.DONE:
            return ""
        if ended.returncode != ExitCode.NOT_FREE:
            return f"{path}: could not be checked (exit code {ended.returncode}):\n{ended.stderr.strip()}"
        (found,) = json.loads(report.read_text(encoding="utf-8"))["files"]
    lines = [f"{path}: {counted(found['intersections'], found['triangle_pairs'])}"]
    lines += [f"  {_text(pair)}" for pair in found["pairs"][:LISTED]]
    more = found["intersections"] - LISTED
    return "\n".join(lines + ([f"  ... and {more} more"] if more > 0 else []))


def _text(pair: dict[str, Any]) -> str:
    return f"{_when(pair)}{_named(pair['first'])} - {_named(pair['second'])}"


def _when(pair: dict[str, Any]) -> str:
    if "to_frame" in pair:
        return f"between frames {pair['frame']:g} and {pair['to_frame']:g}: "
    return f"frame {pair['frame']:g}: " if "frame" in pair else ""


def _named(element: dict[str, Any]) -> str:
    return f'object "{element["object"]}", {element["kind"]} {element["number"]}'
