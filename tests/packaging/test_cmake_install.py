# SPDX-License-Identifier: GPL-3.0-or-later
"""`cmake --install` and find_package(stiv): the example for C++ users compiles against the installation and runs."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = (
    [Path(os.environ["STIV_BUILD"])] if "STIV_BUILD" in os.environ else [ROOT / "build/native", ROOT / "build/dev"]
)
BUILD = next((folder for folder in FOLDERS if (folder / "native/libstiv.a").is_file()), None)

pytestmark = [
    pytest.mark.skipif(BUILD is None, reason="no build of the core in build/native, build/dev or $STIV_BUILD"),
    pytest.mark.skipif(shutil.which("cmake") is None, reason="no cmake"),
]


def run(*command) -> str:
    ended = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    return ended.stdout


@pytest.fixture(scope="module")
def prefix(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("installed here")
    run("cmake", "--install", BUILD, "--component", "development", "--prefix", folder)
    return folder


def test_library_headers_and_licenses_are_installed(prefix):
    installed = {path.relative_to(prefix).as_posix() for path in prefix.rglob("*") if path.is_file()}
    headers = {path.relative_to(ROOT / "native").as_posix() for path in (ROOT / "native/include").rglob("*.hpp")}
    assert headers <= installed
    assert {Path(name).name for name in installed} >= {"libstiv.a", "stivConfig.cmake", "LICENSE", "OpenSubdiv.txt"}


def test_the_installed_cmake_files_contain_no_local_path(prefix):
    for path in prefix.rglob("*.cmake"):
        assert str(ROOT) not in path.read_text() and str(BUILD) not in path.read_text()


def test_the_example_compiles_against_the_installed_library_and_runs(prefix, tmp_path):
    source = tmp_path / "two_sheets"  # a copy, so that the example cannot use neighbouring files
    shutil.copytree(ROOT / "native/examples/two_sheets", source)
    run("cmake", "-S", source, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release")
    run("cmake", "--build", tmp_path / "build")
    out = run(tmp_path / "build/two_sheets")
    assert out.startswith("corrected in ") and out.endswith(" rounds, 0 intersections\n")
