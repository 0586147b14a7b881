# SPDX-License-Identifier: GPL-3.0-or-later
"""Inspection of compiled modules with binutils."""

import re
import subprocess
from pathlib import Path


def lines_of(*command: str | Path) -> list[str]:
    """Output of a command."""
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def exported_names(module: str | Path) -> set[str]:
    """Symbols that other libraries can bind to."""
    return {line.split()[-1].split("@")[0] for line in lines_of("nm", "-D", "--defined-only", module)}


def needed_libraries(module: str | Path) -> set[str]:
    """Shared libraries that the module needs."""
    return {line.split("[")[1].rstrip("]") for line in lines_of("readelf", "-d", module) if "(NEEDED)" in line}


def newest_glibc(module: str | Path) -> tuple[int, ...]:
    """The version of the C library that the module needs."""
    found = re.findall(r"GLIBC_(\d+)\.(\d+)", "\n".join(lines_of("readelf", "-V", module)))
    return max((int(major), int(minor)) for major, minor in found)
