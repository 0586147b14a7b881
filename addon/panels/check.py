# SPDX-License-Identifier: GPL-3.0-or-later
"""Intersections of the scene as it is."""

from __future__ import annotations

import bpy

from ..operators.check import STIV_OT_check
from .drawing import SubPanel, draw_lines


class STIV_PT_check(SubPanel, bpy.types.Panel):
    """Intersections of the scene as it is."""

    bl_idname = "STIV_PT_check"
    bl_label = "Check"

    def draw(self, context: bpy.types.Context) -> None:
        """The button, and what it found last."""
        self.layout.operator(STIV_OT_check.bl_idname, text="Check Scene", icon="VIEWZOOM")
        draw_lines(self.layout, context.window_manager.stiv_check.summary)
