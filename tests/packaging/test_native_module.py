# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled module exports only its entry point and needs only system libraries.

Blender loads its own OpenSubdiv and TBB; a visible symbol could bind to theirs, or theirs to ours.
"""

import importlib.util

from modules import exported_names, needed_libraries

SYSTEM_LIBRARIES = {"libc.so.6", "libm.so.6", "libstdc++.so.6", "libgcc_s.so.1", "ld-linux-x86-64.so.2"}


def native_module() -> str:
    spec = importlib.util.find_spec("stiv._native")
    assert spec is not None and spec.origin is not None
    return spec.origin


def test_only_the_entry_point_is_exported() -> None:
    assert exported_names(native_module()) == {"PyInit__native"}


def test_only_system_libraries_are_needed() -> None:
    needed = needed_libraries(native_module())
    assert needed
    assert needed <= SYSTEM_LIBRARIES
