# SPDX-License-Identifier: GPL-3.0-or-later
"""Transforms and how they respond."""

from __future__ import annotations

import bpy

from .. import availability
from ..operators import TRANSFORMS
from .drawing import SidebarPanel, draw_problem

SETTINGS = ("interference", "separation", "responders", "object_response", "smoothness", "constraints")


class STIV_PT_edit(SidebarPanel, bpy.types.Panel):
    """Transforms and how they respond."""

    bl_idname = "STIV_PT_edit"
    bl_label = "Edit without Interference"

    def draw(self, context: bpy.types.Context) -> None:
        """Buttons and settings, or why there are none."""
        if availability.problem():
            draw_problem(self.layout)
            return
        column = self.layout.column(align=True)
        for operator in TRANSFORMS:
            column.operator(operator.bl_idname, text=operator.bl_label.partition(" ")[0])
        self.layout.use_property_split = True
        settings = self.layout.column()
        for name in SETTINGS:
            settings.prop(context.scene.stiv, name)
