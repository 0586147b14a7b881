# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension under test: the zip installed into this Blender, with the core from its own wheel."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import bpy

NAME = "bl_ext.user_default.stiv"


def module(name: str) -> Any:
    """A module of the installed add-on by its name in addon/."""
    return importlib.import_module(f"{NAME}.{name}")


def problem() -> str:
    """Why the extension under test is not the installed zip; empty if it is."""
    if NAME not in bpy.context.preferences.addons:
        return f"{NAME} is not enabled"
    missing = module("native_module").problem()
    if missing:
        return str(missing)
    core = Path(importlib.import_module("stiv._native").__file__)
    installed = Path(bpy.utils.user_resource("EXTENSIONS"))
    return "" if installed in core.parents else f"the core comes from {core}, not from {installed}"
