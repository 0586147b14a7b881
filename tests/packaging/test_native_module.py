# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled module shows nothing but its entry point and needs nothing but the system's own libraries.

Blender loads its own OpenSubdiv and TBB; a visible symbol of ours could bind to theirs, or theirs to ours.
"""

import importlib.util
import subprocess

SYSTEM_LIBRARIES = {"libc.so.6", "libm.so.6", "libstdc++.so.6", "libgcc_s.so.1", "ld-linux-x86-64.so.2"}


def native_module() -> str:
    spec = importlib.util.find_spec("stiv._native")
    assert spec is not None and spec.origin is not None
    return spec.origin


def lines_of(*command: str) -> list[str]:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def test_only_the_entry_point_is_exported() -> None:
    exported = {line.split()[-1] for line in lines_of("nm", "-D", "--defined-only", native_module())}
    assert exported == {"PyInit__native"}


def test_only_system_libraries_are_needed() -> None:
    needed = {
        line.split("[")[1].rstrip("]") for line in lines_of("readelf", "-d", native_module()) if "(NEEDED)" in line
    }
    assert needed
    assert needed <= SYSTEM_LIBRARIES
