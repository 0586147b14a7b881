# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in Blender's menus, and the pie menu."""

from __future__ import annotations

import bpy

from .operators.check.check import STIV_OT_check
from .operators.check.measure import STIV_OT_measure
from .operators.classes import LAYOUT_ICONS, RESHAPING, TRANSFORMS
from .operators.repair.exclusions import STIV_OT_clear_exclusions, STIV_OT_exclude_intersections
from .operators.repair.guard_revert import STIV_OT_guard_revert
from .operators.repair.repair import STIV_OT_repair
from .operators.transform.morph import STIV_OT_morph
from .operators.transform.morph_drag import STIV_OT_morph_drag

# Object > Transform; the menus Transform of all edit modes are one menu.
MENUS = ("VIEW3D_MT_transform_object", "VIEW3D_MT_transform", "VIEW3D_MT_transform_armature")
# Blender's search (F3) finds an operator only through a menu.
TOOL_MENUS = (
    "VIEW3D_MT_object",
    "VIEW3D_MT_object_context_menu",
    "VIEW3D_MT_edit_mesh",
    "VIEW3D_MT_edit_mesh_context_menu",
    "VIEW3D_MT_edit_lattice",
    "VIEW3D_MT_edit_curve",
    "VIEW3D_MT_edit_curve_context_menu",
    "VIEW3D_MT_edit_surface",
    "VIEW3D_MT_pose",
    "VIEW3D_MT_pose_context_menu",
)
KEY_MENU = "MESH_MT_shape_key_context_menu"  # beside the list of shape keys
TOOLS = (
    *TRANSFORMS,
    STIV_OT_check,
    STIV_OT_measure,
    *RESHAPING,
    STIV_OT_exclude_intersections,
    STIV_OT_clear_exclusions,
    STIV_OT_guard_revert,
)


def draw(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Append the operators to a menu."""
    self.layout.separator()
    for operator in (*TRANSFORMS, STIV_OT_check):
        self.layout.operator(operator.bl_idname, text=operator.bl_label)


def draw_layout(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Append the layout operators to the Object menu."""
    self.layout.separator()
    self.layout.menu(STIV_MT_layout.bl_idname)


def draw_keys(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Append the operators of shape keys to their menu."""
    self.layout.separator()
    for operator in (STIV_OT_morph_drag, STIV_OT_morph):
        self.layout.operator(operator.bl_idname)


def draw_tools(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Append the menu of all tools."""
    self.layout.separator()
    self.layout.menu(STIV_MT_tools.bl_idname)


def register() -> None:
    """Add the entries."""
    for name in TOOL_MENUS:
        getattr(bpy.types, name).append(draw_tools)
    bpy.types.VIEW3D_MT_object.append(draw_layout)
    getattr(bpy.types, KEY_MENU).append(draw_keys)
    for name in MENUS:
        getattr(bpy.types, name).append(draw)


def unregister() -> None:
    """Remove the entries."""
    for name in TOOL_MENUS:
        getattr(bpy.types, name).remove(draw_tools)
    bpy.types.VIEW3D_MT_object.remove(draw_layout)
    getattr(bpy.types, KEY_MENU).remove(draw_keys)
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


class STIV_MT_tools(bpy.types.Menu):
    """Collision transforms, checks and repair"""

    bl_idname = "STIV_MT_tools"
    bl_label = "Collision Tools"

    def draw(self, context: bpy.types.Context) -> None:
        """An entry for each operator."""
        for operator in TOOLS:
            self.layout.operator(operator.bl_idname)


class STIV_MT_layout(bpy.types.Menu):
    """Drop, settle, place, part and pack objects without collisions"""

    bl_idname = "STIV_MT_layout"
    bl_label = "Collision Layout"

    def draw(self, context: bpy.types.Context) -> None:
        """An entry for each operator."""
        for operator, icon in LAYOUT_ICONS:
            self.layout.operator(operator.bl_idname, icon=icon)


CLASSES = (STIV_MT_pie, STIV_MT_tools, STIV_MT_layout)
