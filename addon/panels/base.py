# SPDX-License-Identifier: GPL-3.0-or-later
"""Bases of the panels, and text in them."""

from __future__ import annotations

import textwrap

import bpy

from .. import native_module


class SidebarPanel:
    """Base of panels in the tab."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "STIV"


class SubPanel(SidebarPanel):
    """Base of panels within the first panel of the tab."""

    bl_parent_id = "STIV_PT_edit"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the native module is available."""
        return not native_module.problem()


def draw_problem(layout: bpy.types.UILayout) -> None:
    """Draw why the add-on cannot run, and what to do."""
    box = layout.box()
    box.alert = True
    box.label(text="STIV cannot run", icon="ERROR")
    draw_lines(box, native_module.problem())


def draw_lines(layout: bpy.types.UILayout, text: str, width: int = 38) -> None:
    """Draw text wrapped to the usual width of the sidebar."""
    column = layout.column(align=True)
    for line in text.splitlines():
        for piece in textwrap.wrap(line, width):
            column.label(text=piece)
