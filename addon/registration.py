# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that the extension adds to Blender, in order, and takes away again in reverse."""

import sys

import bpy

from . import keymap, loop_updates, manual, menus, operators, panels, preferences, properties, translations
from .guard import watcher
from .operators.transform import drag_results
from .overlay import display

CLASSES = (
    *properties.CLASSES,
    *display.CLASSES,
    *operators.CLASSES,
    *panels.CLASSES,
    *menus.CLASSES,
    *preferences.CLASSES,
)


def register() -> None:
    """Add classes, settings, menu entries and keys. Needs no native module."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    properties.register()
    translations.register()
    menus.register()
    keymap.register()
    manual.register()
    loop_updates.register()
    watcher.register()
    display.register()


def unregister() -> None:
    """Take everything away again."""
    display.unregister()
    watcher.unregister()
    loop_updates.unregister()
    manual.unregister()
    keymap.unregister()
    menus.unregister()
    translations.unregister()
    properties.unregister()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
    forget()


def forget() -> None:
    """Give back what is kept from one drag to the next."""
    drag_results.clear()
    cache = sys.modules.get("stiv.blender.controls.deformation_cache")  # there only if the native module was
    if cache is not None:
        cache.forget_all()
