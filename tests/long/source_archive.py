# SPDX-License-Identifier: GPL-3.0-or-later
"""Install the source archive with pip, which compiles it, and run the self-test: in a bare Debian, in a folder.

Before that, without the libraries, pip ends with one message that names all of them. Without root and debootstrap, the
archive is compiled in a new environment on this system, and the reason is printed.

Usage: source_archive.py [--folder F] [--release R]   F: a new folder, default: temporary; R: of Debian
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
import venv
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT)]

from tests.window.debian_folder import bootstrap, in_folder, obstacle, run, system_mounts  # noqa: E402

COMPILER = ["g++", "python3-venv", "ca-certificates"]
LIBRARIES = ["libeigen3-dev", "libhwy-dev", "python3-dev"]
CERTIFICATES = Path("/etc/ssl/certs/ca-certificates.crt")
PIP = ["/v/bin/python", "-m", "pip", "install", "--disable-pip-version-check"]
TEST = "import stiv; result = stiv.self_test(); print(stiv.__file__, result); raise SystemExit(not result.passed)"


def archive_of(folder: Path) -> Path:
    """The source archive, made in the folder."""
    subprocess.run([ROOT / "tools/source_archive.sh", sys.executable, folder], cwd=ROOT, check=True)
    (archive,) = folder.glob("stiv-*.tar.gz")
    return archive


def install_here(archive: Path, folder: Path) -> None:
    """Compile and test in a new environment of this system."""
    venv.create(folder / "venv", with_pip=True)
    python = folder / "venv/bin/python"
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", archive], check=True)
    subprocess.run([python, "-c", TEST], cwd=folder, check=True)


def install_in_debian(archive: Path, debian: Path, release: str) -> None:
    """Compile and test in a Debian of nothing but a compiler and Python, first without the libraries."""
    print(f"Debian {release} into {debian}", flush=True)
    debian.mkdir()
    bootstrap(release, debian)
    shutil.copy(archive, debian)
    with system_mounts(debian):
        install_packages(debian, COMPILER)
        if CERTIFICATES.is_file():  # a network may have its own
            shutil.copy(CERTIFICATES, debian / CERTIFICATES.relative_to("/"))
        run(debian, ["python3", "-m", "venv", "/v"])
        check_message(debian, archive.name)
        install_packages(debian, LIBRARIES)
        print("pip install: compiling", flush=True)
        run(debian, [*PIP, "--quiet", f"/{archive.name}"])
        run(debian, ["/v/bin/python", "-c", TEST])
        run(debian, ["/v/bin/python", "-m", "stiv.command_line", "self-test"])


def install_packages(debian: Path, names: Sequence[str]) -> None:
    """Install packages of Debian, and no package that these recommend."""
    run(debian, ["apt-get", "-qq", "update"])
    run(debian, ["apt-get", "-qq", "install", "--no-install-recommends", *names], quiet=True)


def check_message(debian: Path, archive: str) -> None:
    """Without the libraries, pip's output has one message with the package of each."""
    command = in_folder(debian, [*PIP, f"/{archive}"])
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    text = done.stdout + done.stderr
    if done.returncode == 0 or text.count("STIV cannot be compiled yet") != 1 or not all(n in text for n in LIBRARIES):
        raise SystemExit(f"without the libraries, pip does not end with one message that names them:\n{text}")
    print("without the libraries: one message names them", flush=True)


def main(folder: Path, release: str) -> None:
    """Archive, install, test."""
    archive = archive_of(folder)
    if reason := obstacle():
        print(f"on this system, not in a bare Debian: {reason}")
        install_here(archive, folder)
    else:
        install_in_debian(archive, folder / "debian", release)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path)
    parser.add_argument("--release", default="bookworm")
    chosen = parser.parse_args()
    if chosen.folder:
        main(chosen.folder.resolve(), chosen.release)
    else:
        with tempfile.TemporaryDirectory() as temporary:
            main(Path(temporary), chosen.release)
