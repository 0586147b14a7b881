# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn over the 3D view."""

from __future__ import annotations

import bpy

from ..operators.check.measure import STIV_OT_measure
from .base import SubPanel


class STIV_PT_overlay(SubPanel, bpy.types.Panel):
    """What is drawn over the 3D view."""

    bl_idname = "STIV_PT_overlay"
    bl_label = "Overlay"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a set)

    def draw_header(self, context: bpy.types.Context) -> None:
        """The switch of all of it."""
        self.layout.prop(context.window_manager.stiv_overlay, "show", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """A switch each."""
        chosen = context.window_manager.stiv_overlay
        column = self.layout.column()
        column.active = chosen.show
        for name in ("contacts", "intersections", "clearance", "while_dragging", "speed"):
            column.prop(chosen, name)
        self.layout.operator(STIV_OT_measure.bl_idname, icon="DRIVER_DISTANCE")
