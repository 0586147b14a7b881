# SPDX-License-Identifier: GPL-3.0-or-later
"""Intersections of the scene as it is, and their repair."""

from __future__ import annotations

import bpy

from ..operators import RESHAPING
from ..operators.check.check import STIV_OT_check
from ..operators.repair.exclusions import STIV_OT_clear_exclusions, STIV_OT_exclude_intersections, excluded_count
from .base import SubPanel, draw_lines


class STIV_PT_check(SubPanel, bpy.types.Panel):
    """Intersections of the scene as it is."""

    bl_idname = "STIV_PT_check"
    bl_label = "Check"

    def draw(self, context: bpy.types.Context) -> None:
        """The button, and what it found last."""
        self.layout.operator(STIV_OT_check.bl_idname, text="Check Scene", icon="VIEWZOOM")
        draw_lines(self.layout, context.window_manager.stiv_check.summary)


class STIV_PT_repair(SubPanel, bpy.types.Panel):
    """Repair, and the steps that it is made of."""

    bl_idname = "STIV_PT_repair"
    bl_label = "Repair"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a set)

    def draw(self, context: bpy.types.Context) -> None:
        """One button an operator; values are in the redo panel."""
        column = self.layout.column(align=True)
        for operator in RESHAPING:
            column.operator(operator.bl_idname)
        row = self.layout.row(align=True)
        row.operator(STIV_OT_exclude_intersections.bl_idname)
        told = excluded_count(context.scene.stiv.excluded)
        if told:
            row.operator(STIV_OT_clear_exclusions.bl_idname, text="", icon="X")
            draw_lines(self.layout, told)
