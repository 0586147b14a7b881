# SPDX-License-Identifier: GPL-3.0-or-later
"""What to do when surfaces intersect already."""

from __future__ import annotations

import bpy

from ..operators import RESHAPING
from .drawing import SubPanel


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
