# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that the extension adds to Blender, in order, and takes away again in reverse."""

import sys

import bpy

from . import keymap, live_loops, manual, menus, operators, panels, pie_menu, preferences, properties, translations
from .guard import watching
from .operators import outcomes
from .overlay import showing

CLASSES = (
    *properties.CLASSES,
    *showing.CLASSES,
    *operators.CLASSES,
    *panels.CLASSES,
    *pie_menu.CLASSES,
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
    live_loops.register()
    watching.register()
    showing.register()


def unregister() -> None:
    """Take everything away again."""
    showing.unregister()
    watching.unregister()
    live_loops.unregister()
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
    outcomes.clear()
    remembering = sys.modules.get("stiv.blender.remembering")  # there only if the native module was
    if remembering is not None:
        remembering.forget_all()
