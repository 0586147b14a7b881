# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled module exports only its entry point and needs only system libraries.

Blender loads its own OpenSubdiv and TBB; a visible symbol could bind to theirs, or theirs to ours.
"""

import importlib.util

from modules import exported_names, imported_names, inexact_functions, needed_libraries

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


def test_no_function_whose_results_differ_between_systems_is_needed() -> None:
    assert inexact_functions({"sinf", "__exp", "nextafter", "ldexp", "sincos", "atan2"}) == {
        "sinf",
        "__exp",
        "sincos",
        "atan2",
    }
    imported = imported_names(native_module())
    assert {"nextafter", "ldexp"} <= imported  # whose results are exact
    assert not inexact_functions(imported)
