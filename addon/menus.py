# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in Blender's menus, and the pie menu."""

from __future__ import annotations

import bpy

from .operators import LAYOUT_ICONS, TRANSFORMS
from .operators.check.check import STIV_OT_check
from .operators.repair.repair import STIV_OT_repair

# Object > Transform; Mesh > Transform and Lattice > Transform are one menu.
MENUS = ("VIEW3D_MT_transform_object", "VIEW3D_MT_transform")


def draw(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Append the operators to a menu."""
    self.layout.separator()
    for operator in (*TRANSFORMS, STIV_OT_check):
        self.layout.operator(operator.bl_idname, text=operator.bl_label)


def draw_layout(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Append the layout operators to the Object menu."""
    self.layout.separator()
    self.layout.menu(STIV_MT_layout.bl_idname)


def register() -> None:
    """Add the entries."""
    bpy.types.VIEW3D_MT_object.append(draw_layout)
    for name in MENUS:
        getattr(bpy.types, name).append(draw)


def unregister() -> None:
    """Remove the entries."""
    bpy.types.VIEW3D_MT_object.remove(draw_layout)
    for name in MENUS:
        getattr(bpy.types, name).remove(draw)


class STIV_MT_pie(bpy.types.Menu):
    """Collision transforms, checks and switches"""

    bl_idname = "STIV_MT_pie"
    bl_label = "Collision Tools"

    def draw(self, context: bpy.types.Context) -> None:
        """In Blender's order: left, right, below, above, then the corners."""
        pie = self.layout.menu_pie()
        for operator in TRANSFORMS:
            pie.operator(operator.bl_idname, text=operator.bl_label.split()[-1])
        pie.operator(STIV_OT_check.bl_idname)
        pie.prop(context.scene.stiv, "live_guard")
        pie.prop(context.scene.stiv, "interference")
        pie.prop(context.window_manager.stiv_overlay, "show")
        pie.operator(STIV_OT_repair.bl_idname)


class STIV_MT_layout(bpy.types.Menu):
    """Drop, settle, place, part and pack objects without collisions"""

    bl_idname = "STIV_MT_layout"
    bl_label = "Collision Layout"

    def draw(self, context: bpy.types.Context) -> None:
        """An entry for each operator."""
        for operator, icon in LAYOUT_ICONS:
            self.layout.operator(operator.bl_idname, icon=icon)


CLASSES = (STIV_MT_pie, STIV_MT_layout)
