# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard: its switch, and what to do where it cannot act."""

from __future__ import annotations

import bpy

from ..guard import watching
from .drawing import SubPanel, draw_lines

WAYS_OUT = ("stiv.check", "stiv.repair", "stiv.exclude_intersections")


class STIV_PT_guard(SubPanel, bpy.types.Panel):
    """Watches over every tool of Blender."""

    bl_idname = "STIV_PT_guard"
    bl_label = "Live Guard"

    def draw_header(self, context: bpy.types.Context) -> None:
        """The switch."""
        self.layout.prop(context.scene.stiv, "live_guard", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """What it does, or why it cannot."""
        layout = self.layout
        if not context.scene.stiv.live_guard:
            layout.label(text="Off: tools may go through surfaces")
        elif watching.problem():
            layout.label(text="The guard waits for a free scene", icon="ERROR")
            draw_lines(layout, watching.problem())
            column = layout.column(align=True)
            for name in WAYS_OUT:
                if is_registered(name):
                    column.operator(name)
        else:
            layout.label(text="Every tool is corrected", icon="CHECKMARK")


def is_registered(name: str) -> bool:
    """Is there an operator of this name?"""
    return hasattr(bpy.types, name.replace("stiv.", "STIV_OT_"))
