# SPDX-License-Identifier: GPL-3.0-or-later
"""All that is at hand while modelling, around the mouse."""

from __future__ import annotations

import bpy

from .operators import TRANSFORMS
from .operators.check import STIV_OT_check
from .operators.repair import STIV_OT_repair


class STIV_MT_pie(bpy.types.Menu):
    """Transforms on the left, right and below, checks above, switches in the corners."""

    bl_idname = "STIV_MT_pie"
    bl_label = "Without Interference"

    def draw(self, context: bpy.types.Context) -> None:
        """In Blender's order: left, right, below, above, then the corners."""
        pie = self.layout.menu_pie()
        for operator in TRANSFORMS:
            pie.operator(operator.bl_idname, text=operator.bl_label.partition(" ")[0])
        pie.operator(STIV_OT_check.bl_idname)
        pie.prop(context.scene.stiv, "live_guard")
        pie.prop(context.scene.stiv, "interference")
        pie.prop(context.window_manager.stiv_overlay, "show")
        pie.operator(STIV_OT_repair.bl_idname)


CLASSES = (STIV_MT_pie,)
