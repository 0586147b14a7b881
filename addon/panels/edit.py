# SPDX-License-Identifier: GPL-3.0-or-later
"""The first panel: transforms and the settings of the scene."""

from __future__ import annotations

import bpy

from .. import native_module, stiv_blender
from ..automatic import draw_automatic
from ..operators.classes import TRANSFORMS
from ..scene.edit_settings import edit_settings
from ..translations import translate
from .base import SidebarPanel, draw_lines, draw_problem

ICONS = {"move": "CON_LOCLIKE", "rotate": "CON_ROTLIKE", "scale": "CON_SIZELIKE"}
LABEL_WIDTH = 0.55  # fraction of the sidebar's default width that the longest label needs
SETTINGS = ("responders", "object_response", "slide_out_of_axis", "guard", "smoothness", "tight", "constraints")


class STIV_PT_edit(SidebarPanel, bpy.types.Panel):
    """Transforms and their settings."""

    bl_idname = "STIV_PT_edit"
    bl_label = "Collision Transform"

    def draw(self, context: bpy.types.Context) -> None:
        """Buttons and settings, or why the add-on cannot run."""
        if native_module.problem():
            draw_problem(self.layout)
            return
        column = self.layout.column(align=True)
        for operator in TRANSFORMS:
            column.operator(operator.bl_idname, text=operator.bl_label.split()[-1], icon=ICONS[operator.kind])
        column.operator("stiv.morph", text="Morph", icon="SHAPEKEY_DATA")
        self.layout.use_property_split, self.layout.use_property_decorate = True, False
        settings = self.layout.column()
        settings.prop(context.scene.stiv, "interference")
        scene = context.scene.stiv
        draw_automatic(settings, scene, "separation", "automatic_separation", "Minimum Distance", LABEL_WIDTH)
        for name in (*SETTINGS, *(("joint_region",) if context.mode == "POSE" else ())):
            settings.prop(context.scene.stiv, name)
        draw_lines(settings, automatic_guard(context))
        draw_lines(self.layout, context.window_manager.stiv_check.left_out)


def automatic_guard(context: bpy.types.Context) -> str:
    """The evaluations that the automatic guard chooses for the current scene; "" if the user chose."""
    if context.scene.stiv.guard != "auto":
        return ""
    try:
        guard = stiv_blender.choose_guard(context, edit_settings(context.scene))
    except ValueError:  # the operators report invalid settings
        return ""
    if guard.reason:
        return translate("Guard: Viewport (render exceeds 500K triangles)")
    return translate("Guard: {}").format(translate(guard.choice.title()))
