# SPDX-License-Identifier: GPL-3.0-or-later
"""The source of OpenSubdiv is unpacked on a Debian with nothing but a compiler: `tar` finds no xz there."""

import os
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "tools/opensubdiv_source.sh"
KEYRING = Path("/usr/share/keyrings/debian-archive-keyring.gpg")
TOOLS = ["basename", "cat", "chmod", "cp", "dirname", "find", "head", "id", "mkdir", "mktemp", "mv", "rm", "sh", "tar"]

pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or not KEYRING.is_file() or shutil.which("cmake") is None, reason="needs Debian and cmake"
)


def bare_system(folder: Path, archive: Path) -> Path:
    """A folder of programs without xz, whose apt-get gives this archive as the source package."""
    folder.mkdir()
    for name in TOOLS:
        (folder / name).symlink_to(shutil.which(name) or "/nowhere")
    program(folder / "apt-get", f'case "$*" in *" source "*) cp "{archive}" . ;; esac')
    program(folder / "cmake", f"PATH='{os.environ['PATH']}' exec cmake \"$@\"")
    return folder


def program(path: Path, script: str) -> None:
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)


def made_archive(folder: Path, *names: str) -> Path:
    """A small source package."""
    top = folder / "OpenSubdiv-3_5_0"
    for name in (*names, "LICENSE.txt", "NOTICE.txt"):
        (top / name).parent.mkdir(parents=True, exist_ok=True)
        (top / name).write_text(name)
    path = folder / "opensubdiv_3.5.0.orig.tar.xz"
    with tarfile.open(path, "w:xz") as archive:
        archive.add(top, top.name)
    return path


def unpack(folder: Path, *names: str) -> subprocess.CompletedProcess[str]:
    programs = bare_system(folder / "bin", made_archive(folder, *names))
    environment = os.environ | {"PATH": str(programs)}
    command = [programs / "sh", SCRIPT, folder / "unpacked"]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


def test_it_is_unpacked_without_xz(tmp_path: Path) -> None:
    done = unpack(tmp_path, "opensubdiv/far/stencilTable.h")
    assert done.returncode == 0, done.stderr
    unpacked = tmp_path / "unpacked"
    assert (unpacked / "opensubdiv/far/stencilTable.h").is_file()
    assert {path.name for path in unpacked.iterdir()} == {"opensubdiv", "LICENSE.txt", "NOTICE.txt"}


def test_an_archive_of_something_else_is_refused(tmp_path: Path) -> None:
    done = unpack(tmp_path, "other/file.h")
    assert done.returncode == 1
    assert "does not contain opensubdiv/far" in done.stderr
