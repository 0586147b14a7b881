# SPDX-License-Identifier: GPL-3.0-or-later
"""What to do when surfaces intersect already."""

from __future__ import annotations

import bpy

from ..operators import RESHAPING
from ..operators.exclude import STIV_OT_clear_exclusions, STIV_OT_exclude_intersections, excluded_count
from .drawing import SubPanel, draw_lines


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
