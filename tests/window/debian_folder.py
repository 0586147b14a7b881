# SPDX-License-Identifier: GPL-3.0-or-later
"""A Debian 13 in a folder, with the Blender of its own packages: how a current window is had on any Debian."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

RELEASE = "trixie"
PACKAGES = Path(__file__).with_name("debian_packages.txt")
STAMP = "stiv-packages-installed"
ENVIRONMENT = ("PATH=/usr/bin:/bin:/usr/sbin:/sbin", "HOME=/root", "LC_ALL=C.UTF-8", "DEBIAN_FRONTEND=noninteractive")


def obstacle() -> str:
    """Why no folder can be set up here, empty if it can."""
    if os.geteuid() != 0:
        return "setting up a Debian folder needs root"
    if shutil.which("debootstrap") is None:
        return "debootstrap is not installed (apt-get install debootstrap)"
    return ""


def prepare(folder: Path) -> None:
    """Fill the folder once; later calls only look whether the list of packages is still the same."""
    stamp, wanted = folder / STAMP, PACKAGES.read_text()
    if stamp.is_file() and stamp.read_text() == wanted:
        return
    if not (folder / "usr/bin/apt-get").exists():
        print(f"Debian {RELEASE} into {folder} (about a minute)", flush=True)
        folder.mkdir(parents=True, exist_ok=True)
        subprocess.run(["debootstrap", "--variant=minbase", RELEASE, folder], check=True, stdout=subprocess.DEVNULL)
    names = [line for line in wanted.splitlines() if line and not line.startswith("#")]
    print(f"its packages: {' '.join(names)} (about a minute)", flush=True)
    with system_mounts(folder):
        run(folder, ["apt-get", "-qq", "update"])
        run(folder, ["apt-get", "-qq", "install", "--no-install-recommends", *names], quiet=True)
    stamp.write_text(wanted)


@contextmanager
def system_mounts(folder: Path) -> Iterator[None]:
    """The process table inside the folder while needed; what was mounted before stays."""
    target = folder / "proc"
    needed = not os.path.ismount(target)
    if needed:
        subprocess.run(["mount", "-t", "proc", "proc", target], check=True)
    try:
        yield
    finally:
        if needed:
            subprocess.run(["umount", target], check=False)


def run(folder: Path, command: Sequence[str], *, quiet: bool = False, timeout: float | None = None) -> None:
    """Run a command inside the folder. Raises CalledProcessError or TimeoutExpired."""
    output = subprocess.DEVNULL if quiet else None
    full = ["chroot", str(folder), "env", "-i", *ENVIRONMENT, *command]
    subprocess.run(full, check=True, stdout=output, timeout=timeout)
