# SPDX-License-Identifier: GPL-3.0-or-later
"""A fixture for pytest that asserts that scenes and meshes are free of intersections.

    def test_the_plant_is_free(assert_free_of_intersections):
        assert_free_of_intersections("assets/plant.blend", frames="1:120")

Each check runs `stiv check` in a process of its own: Blender is never loaded into the process of the tests, and a file
that ends Blender ends one test. The ini option `stiv_blender` names an installed Blender to use.
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

LISTED = 20  # pairs in a message
_FREE, _NOT_FREE = 0, 4  # exit codes of `stiv check`

AssertFree = Callable[..., None]


def pytest_addoption(parser: pytest.Parser) -> None:
    """Adds the ini option."""
    parser.addini("stiv_blender", "an installed Blender for assert_free_of_intersections (default: bpy)", default="")


@pytest.fixture(scope="session")
def assert_free_of_intersections(pytestconfig: pytest.Config) -> AssertFree:
    """A function of a path that fails the test if anything meets.

    path: a .blend or a mesh file. frames: "A:B", "A:B:STEP" or "scene", to test these and the ways between them.
    objects: names to be limited to. baseline: file of accepted findings. scene: name of the one to test, or "all".
    render: test render levels however large. hidden: test what is hidden too. The message names objects and faces.
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
    """What to tell of a file that is not free, or could not be checked; empty for one that is."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [sys.executable, "-m", "stiv.command_line", "check", str(path), "--json", str(report), *options]
        ended = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", errors="replace", check=False)
        if ended.returncode == _FREE:
            return ""
        if ended.returncode != _NOT_FREE:
            return f"{path}: could not be checked (exit code {ended.returncode}):\n{ended.stderr.strip()}"
        (found,) = json.loads(report.read_text(encoding="utf-8"))["files"]
    lines = [f"{path}: {counted(found['intersections'], found['triangle_pairs'])}"]
    lines += [f"  {_told(pair)}" for pair in found["pairs"][:LISTED]]
    more = found["intersections"] - LISTED
    return "\n".join(lines + ([f"  ... and {more} more"] if more > 0 else []))


def _told(pair: dict[str, Any]) -> str:
    return f"{_when(pair)}{_named(pair['first'])} - {_named(pair['second'])}"


def _when(pair: dict[str, Any]) -> str:
    if "to_frame" in pair:
        return f"between frames {pair['frame']:g} and {pair['to_frame']:g}: "
    return f"frame {pair['frame']:g}: " if "frame" in pair else ""


def _named(element: dict[str, Any]) -> str:
    return f'object "{element["object"]}", {element["kind"]} {element["number"]}'
