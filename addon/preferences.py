# SPDX-License-Identifier: GPL-3.0-or-later
"""Preferences of the extension for all files: keys, threads, overlay."""

from __future__ import annotations

import os

import bpy
import rna_keymap_ui
from bpy.props import BoolProperty, IntProperty

from . import keymap
from .automatic import AutomaticProperty, draw_automatic


class StivPreferences(bpy.types.AddonPreferences):
    """Settings for every scene."""

    bl_idname = __package__

    threads: IntProperty(name="Threads", description="Solver threads (0 uses all cores)", default=0, min=0, max=1024)
    automatic_threads: AutomaticProperty(
        of="threads", start=os.cpu_count() or 1, name="Auto Threads", description="Use all cores"
    )
    overlay: BoolProperty(
        name="Show Overlay on Startup",
        description="Show contacts, intersecting faces, clearance and speed when Blender starts",
        default=True,
    )

    def draw(self, context: bpy.types.Context) -> None:
        """The settings, then the keys as in Blender's own editor."""
        self.layout.use_property_split, self.layout.use_property_decorate = True, False
        draw_automatic(self.layout, self, "threads", "automatic_threads", "Threads")
        self.layout.prop(self, "overlay")
        draw_keys(context, self.layout.column())


def preferences(context: bpy.types.Context) -> StivPreferences | None:
    """The preferences; None if a script registered the add-on without enabling it."""
    addon = context.preferences.addons.get(__package__)
    return None if addon is None else addon.preferences


def threads(context: bpy.types.Context) -> int:
    """Number of solver threads, 0 for all cores."""
    chosen = preferences(context)
    return 0 if chosen is None else int(chosen.threads)


def overlay_at_start(context: bpy.types.Context) -> bool:
    """Whether the overlay is on when Blender starts."""
    chosen = preferences(context)
    return True if chosen is None else bool(chosen.overlay)


def draw_keys(context: bpy.types.Context, layout: bpy.types.UILayout) -> None:
    """Every key of the extension, to change, disable or restore it."""
    configuration = context.window_manager.keyconfigs.user
    if configuration is None:  # Blender without a window
        return
    for name in keymap.KEYMAPS:
        keys = configuration.keymaps.get(name)
        ours = [item for item in keys.keymap_items if keymap.is_ours(item)] if keys is not None else []
        if ours:
            layout.label(text=name)
        for item in ours:
            layout.context_pointer_set("keymap", keys)
            rna_keymap_ui.draw_kmi(["ADDON", "USER", "DEFAULT"], configuration, keys, item, layout, 0)


CLASSES = (StivPreferences,)
