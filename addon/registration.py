# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers everything that the extension adds to Blender, and unregisters it in reverse order."""

import bpy

from . import (
    getting_started,
    header,
    kept_data,
    keymap,
    loop_updates,
    manual,
    menus,
    panels,
    preferences,
    properties,
    translations,
)
from .guard import completion, waiting, watcher
from .operators import classes, running
from .overlay import display
from .tools import gizmo_group, live_switch, toolbar

CLASSES = (
    *properties.CLASSES,
    *display.CLASSES,
    *classes.CLASSES,
    *waiting.CLASSES,
    *getting_started.CLASSES,
    *panels.CLASSES,
    *menus.CLASSES,
    *preferences.CLASSES,
    *gizmo_group.CLASSES,
)


def register() -> None:
    """Add classes, settings, menu entries and keys. Needs no native module."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    kept_data.register()
    properties.register()
    translations.register()
    menus.register()
    keymap.register()
    manual.register()
    loop_updates.register()
    watcher.register()
    completion.register()
    display.register()
    toolbar.register()
    header.register()
    live_switch.register()


def unregister() -> None:
    """Remove everything; a running edit restores its start first."""
    running.cancel(bpy.context)
    live_switch.unregister()
    header.unregister()
    toolbar.unregister()
    display.unregister()
    completion.unregister()
    watcher.unregister()
    loop_updates.unregister()
    manual.unregister()
    getting_started.examples.unregister()
    keymap.unregister()
    menus.unregister()
    translations.unregister()
    properties.unregister()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
    kept_data.unregister()
