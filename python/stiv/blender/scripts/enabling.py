# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers the add-on's operators and settings for scripts, where no extension is installed."""

import atexit
import importlib
from types import ModuleType

import bpy

from stiv import InputError


def enable() -> None:
    """Register the operators `bpy.ops.stiv` and the settings, until the process ends.

    Does nothing if they are registered, as in a Blender with the extension enabled. Raises InputError if the add-on is
    installed neither as an extension nor with STIV's wheel.
    """
    if is_enabled():
        return
    try:
        addon = importlib.import_module("stiv_addon")
    except ModuleNotFoundError as error:
        if error.name != "stiv_addon":
            raise
        raise InputError("the add-on is missing; enable the extension, or install STIV's wheel with pip") from error
    addon.register()
    atexit.register(_disable, addon)


def is_enabled() -> bool:
    """Are the operators and settings registered?"""
    return hasattr(bpy.types.Scene, "stiv")


def _disable(addon: ModuleType) -> None:
    """Unregister: Blender as a Python module crashes (4.2) or hangs (4.5) at exit if classes are registered.

    Blender 4.2 also crashes if properties with callbacks remain, because they keep the module `bpy` alive too long.
    """
    if not is_enabled():
        return
    addon.unregister()
    for cls in importlib.import_module("stiv_addon.registration").CLASSES:
        for base in cls.__mro__:
            if base.__module__.startswith("stiv_addon."):
                vars(base).get("__annotations__", {}).clear()
