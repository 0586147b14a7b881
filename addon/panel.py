# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab "STIV" in the sidebar of the 3D view."""

from __future__ import annotations

import textwrap

import bpy

from . import availability
from .operators import TRANSFORMS
from .operators.check import STIV_OT_check


class SidebarPanel:
    """Base: a panel in the tab."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "STIV"


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
        for name in ("separation", "responders", "object_response"):
            settings.prop(context.scene.stiv, name)


class STIV_PT_roles(SidebarPanel, bpy.types.Panel):
    """How each selected object takes part."""

    bl_idname = "STIV_PT_roles"
    bl_label = "Roles"
    bl_parent_id = "STIV_PT_edit"
    MOST = 10

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """With the native module only."""
        return not availability.problem()

    def draw(self, context: bpy.types.Context) -> None:
        """One row an object."""
        chosen = [thing for thing in context.selected_objects if thing.type in {"MESH", "LATTICE"}]
        for thing in chosen[: self.MOST]:
            row = self.layout.row()
            row.label(text=thing.name, icon=f"OUTLINER_OB_{thing.type}")
            row.prop(thing.stiv, "role", text="")
        if len(chosen) > self.MOST:
            self.layout.label(text=f"and {len(chosen) - self.MOST} more")
        if not chosen:
            self.layout.label(text="Select objects to see their roles")


class STIV_PT_check(SidebarPanel, bpy.types.Panel):
    """Intersections of the scene as it is."""

    bl_idname = "STIV_PT_check"
    bl_label = "Check"
    bl_parent_id = "STIV_PT_edit"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """With the native module only."""
        return not availability.problem()

    def draw(self, context: bpy.types.Context) -> None:
        """The button, and what it found last."""
        self.layout.operator(STIV_OT_check.bl_idname, text="Check Scene", icon="VIEWZOOM")
        draw_lines(self.layout, context.window_manager.stiv_check.summary)


def draw_problem(layout: bpy.types.UILayout) -> None:
    """Say why the add-on cannot work here, and what to do."""
    box = layout.box()
    box.alert = True
    box.label(text="STIV cannot run", icon="ERROR")
    draw_lines(box, availability.problem())


def draw_lines(layout: bpy.types.UILayout, text: str, width: int = 38) -> None:
    """Text wrapped to the usual width of the sidebar."""
    column = layout.column(align=True)
    for line in text.splitlines():
        for piece in textwrap.wrap(line, width):
            column.label(text=piece)


CLASSES = (STIV_PT_edit, STIV_PT_roles, STIV_PT_check)
