# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel of the layout operators."""

from __future__ import annotations

import bpy

from ..operators.classes import LAYOUT_ICONS
from .base import SubPanel


class STIV_PT_layout(SubPanel, bpy.types.Panel):
    """Drop, settle, place, part and pack objects."""

    bl_idname = "STIV_PT_layout"
    bl_label = "Layout"

    def draw(self, context: bpy.types.Context) -> None:
        """A button for each operator; their values are in the redo panel."""
        column = self.layout.column(align=True)
        for operator, icon in LAYOUT_ICONS:
            column.operator(operator.bl_idname, icon=icon)
