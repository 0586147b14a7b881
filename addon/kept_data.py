# SPDX-License-Identifier: GPL-3.0-or-later
"""Deletes what lasts from one drag to the next, when another file is loaded or the extension removed."""

import sys

import bpy
from bpy.app.handlers import persistent

from .operators.transform import drag_results, morph_slider


def _forget_scene() -> None:
    package = sys.modules.get("stiv.blender")  # loaded at first use, and only with the native module
    if package is not None:
        package.free_kept_data()


@persistent
def _on_load(*_: object) -> None:
    _forget_scene()


def register() -> None:
    """Add the handler."""
    bpy.app.handlers.load_pre.append(_on_load)


def unregister() -> None:
    """Remove the handler, and delete everything."""
    bpy.app.handlers.load_pre.remove(_on_load)
    drag_results.clear()
    morph_slider.forget()
    _forget_scene()
