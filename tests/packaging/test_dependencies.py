# SPDX-License-Identifier: GPL-3.0-or-later
"""CMake finds all libraries, and Python's headers, or names those that are missing in one message, with the way out."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROJECT = """
cmake_minimum_required(VERSION 3.25)
project(found LANGUAGES NONE)
include({}/cmake/dependencies.cmake)
message("found ${{STIV_OPENSUBDIV_SOURCE}} ${{STIV_HIGHWAY_INCLUDE}} ${{Eigen3_FOUND}}")
"""
NO_EIGEN = "-DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON"
NO_PYTHON = "-DSTIV_BUILD_PYTHON=ON", "-DCMAKE_DISABLE_FIND_PACKAGE_Python=ON"
NO_HIGHWAY = "-DSTIV_HIGHWAY_INCLUDE=STIV_HIGHWAY_INCLUDE-NOTFOUND"

pytestmark = pytest.mark.skipif(shutil.which("cmake") is None, reason="no cmake")


def configure(folder: Path, *options: str) -> tuple[int, str]:
    """Exit code and output of CMake, on one line, as CMake wraps messages."""
    (folder / "CMakeLists.txt").write_text(PROJECT.format(ROOT.as_posix()))
    command = [shutil.which("cmake"), "-S", folder, "-B", folder / "build", *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.returncode, re.sub(r"\s+", " ", done.stdout + done.stderr)


@pytest.fixture
def opensubdiv(tmp_path: Path) -> str:
    folder = tmp_path / "opensubdiv 3.5"
    (folder / "opensubdiv/far").mkdir(parents=True)
    (folder / "opensubdiv/far/stencilTable.h").touch()
    return f"-DSTIV_OPENSUBDIV_SOURCE={folder}"


def test_a_complete_machine_configures(tmp_path: Path, opensubdiv: str) -> None:
    code, text = configure(tmp_path, opensubdiv)
    assert code == 0, text
    assert "opensubdiv 3.5" in text and "STIV cannot be compiled" not in text


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ([NO_EIGEN], ["apt-get install libeigen3-dev", "-DEigen3_DIR="]),
        ([NO_HIGHWAY, "-DCMAKE_FIND_ROOT_PATH=/nowhere", "-DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY"],
         ["apt-get install libhwy-dev", "-DSTIV_HIGHWAY_INCLUDE="]),
        ([*NO_PYTHON], ["apt-get install python3-dev", "-DPython_ROOT_DIR="]),
    ],
    ids=["Eigen", "Highway", "Python"],
)  # fmt: skip
def test_a_missing_library_names_its_package_and_the_way_out(
    tmp_path: Path, opensubdiv: str, options: list[str], named: list[str]
) -> None:
    code, text = configure(tmp_path, opensubdiv, *options)
    assert code == 1
    for part in (*named, "--config-settings=cmake.define.NAME=VALUE"):
        assert part in text
    assert "opensubdiv_source.sh" not in text


def test_everything_missing_is_in_one_message(tmp_path: Path) -> None:
    code, text = configure(tmp_path, NO_EIGEN, *NO_PYTHON, "-DSTIV_OPENSUBDIV_SOURCE=/nowhere")
    assert code == 1
    assert "libeigen3-dev" in text and "python3-dev" in text and "tools/opensubdiv_source.sh" in text
    assert text.count("CMake Error") == 1


@pytest.mark.parametrize("downloads", [True, False])
def test_a_build_by_pip_downloads_opensubdiv(tmp_path: Path, downloads: bool) -> None:
    shell = tmp_path / "sh"
    download = 'mkdir -p "$2/opensubdiv/far"; touch "$2/opensubdiv/far/stencilTable.h"' if downloads else "false"
    shell.write_text(f'#!/bin/sh\necho "$@"\n{download}\n')
    shell.chmod(0o755)
    code, text = configure(tmp_path, "-DSKBUILD=2", f"-DSTIV_SHELL={shell}")
    assert "tools/opensubdiv_source.sh" in text
    assert code == (0 if downloads else 1)
    assert ("-DSTIV_OPENSUBDIV_SOURCE=FOLDER" in text) == (not downloads)
