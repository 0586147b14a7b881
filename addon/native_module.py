# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the native module can be used, and operators that are greyed out without it."""

from __future__ import annotations

import functools
import importlib
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy


@functools.cache
def problem() -> str:
    """Why the add-on cannot work here, one sentence a line; empty if it can. Looked up once a session."""
    try:
        importlib.import_module("stiv._native")
        importlib.import_module("stiv.blender")
    except ImportError as error:
        return _explanation(error)
    return ""


def _explanation(error: ImportError) -> str:
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    if isinstance(error, ModuleNotFoundError) and (error.name or "").partition(".")[0] == "stiv":
        what = f"STIV's native module for Python {version} is missing."
    else:
        what = f"STIV's native module cannot be loaded: {error}."
    return f"{what}\nInstall an extension zip with a wheel for Python {version}, then restart Blender."


class NeedsNativeModule:
    """Base of an operator with geometry; a subclass says in `fits` what else it needs."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """With the native module, where the operator fits."""
        if problem():
            cls.poll_message_set(problem())
            return False
        return cls.fits(context)

    @classmethod
    def fits(cls, context: bpy.types.Context) -> bool:
        """Everywhere, unless a subclass says otherwise."""
        return True
