# SPDX-License-Identifier: GPL-3.0-or-later
"""A Debian release in a folder, with Blender from its packages: gives a current window on any Debian."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

PACKAGES = Path(__file__).resolve().parents[2] / "tools/debian_packages_window.txt"
STAMP = "stiv-packages-installed"
ENVIRONMENT = ("PATH=/usr/bin:/bin:/usr/sbin:/sbin", "HOME=/root", "LC_ALL=C.UTF-8", "DEBIAN_FRONTEND=noninteractive")


class UnknownPackagesError(Exception):
    """The release lacks a requested package."""


def obstacle() -> str:
    """Why no folder can be set up here; empty if one can."""
    if os.geteuid() != 0:
        return "setting up a Debian folder needs root"
    if shutil.which("debootstrap") is None:
        return "debootstrap is not installed (apt-get install debootstrap)"
    return ""


def prepare(folder: Path, release: str) -> None:
    """Fill the folder once; later calls only compare the list of packages.

    Raises SubprocessError where the archive cannot be reached, UnknownPackagesError where it can and lacks a package.
    """
    stamp, wanted = folder / STAMP, PACKAGES.read_text()
    if stamp.is_file() and stamp.read_text() == wanted:
        return
    if not folder.exists():
        print(f"Debian {release} into {folder} (about a minute)", flush=True)
        # Renamed when complete: a run that was interrupted leaves nothing that looks finished.
        partial = folder.with_name(f"{folder.name}.partial")
        shutil.rmtree(partial, ignore_errors=True)
        partial.mkdir(parents=True)
        bootstrap(release, partial)
        partial.rename(folder)
    names = [line for line in wanted.splitlines() if line and not line.startswith("#")]
    print(f"its packages: {' '.join(names)} (about a minute)", flush=True)
    with system_mounts(folder):
        # A mirror that lags behind will do; signatures are checked all the same. Without the option, a list that could
        # not be fetched is not an error.
        options = ["-o", "Acquire::Check-Valid-Until=false", "-o", "APT::Update::Error-Mode=any"]
        run(folder, ["apt-get", "-qq", *options, "update"])
        check_known(folder, names)
        run(folder, ["apt-get", "-qq", "install", "--no-install-recommends", *names], quiet=True)
        run(folder, ["apt-get", "clean"])
    stamp.write_text(wanted)


def check_known(folder: Path, names: Sequence[str]) -> None:
    """Check the names without fetching. Raises UnknownPackagesError with apt's message."""
    command = in_folder(folder, ["apt-get", "-qq", "--simulate", "install", "--no-install-recommends", *names])
    done = subprocess.run(command, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        raise UnknownPackagesError(f"{PACKAGES.name}: {done.stderr.strip()}")


def bootstrap(release: str, folder: Path) -> None:
    """Install the smallest set of packages."""
    command = ["debootstrap", "--variant=minbase", release, folder]
    done = subprocess.run(command, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        print(done.stdout[-2000:])
        raise subprocess.CalledProcessError(done.returncode, "debootstrap")


@contextmanager
def system_mounts(folder: Path) -> Iterator[None]:
    """Mount the process table inside the folder while needed; earlier mounts stay."""
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
    """Run a command inside the folder. Raises CalledProcessError, or TimeoutExpired when all it started is ended."""
    whole = in_folder(folder, command)
    process = subprocess.Popen(whole, stdout=subprocess.DEVNULL if quiet else None, start_new_session=True)
    try:
        code = process.wait(timeout)
    except BaseException:
        os.killpg(process.pid, signal.SIGKILL)  # a display and its Blender would keep running
        process.wait()
        raise
    if code:
        raise subprocess.CalledProcessError(code, whole)


def in_folder(folder: Path, command: Sequence[str]) -> list[str]:
    """The command that runs another one inside the folder."""
    return ["chroot", str(folder), "env", "-i", *ENVIRONMENT, *command]
