# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances that pairs of objects keep."""

from __future__ import annotations

import bpy

from ..operators.measure import STIV_OT_measure
from ..operators.separation import STIV_OT_separation_add, STIV_OT_separation_remove
from .drawing import SubPanel


class STIV_PT_separation(SubPanel, bpy.types.Panel):
    """Distances that pairs of objects keep."""

    bl_idname = "STIV_PT_separation"
    bl_label = "Separation of Pairs"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a set)

    def draw(self, context: bpy.types.Context) -> None:
        """One row a pair; measuring."""
        for index, pair in enumerate(context.scene.stiv.pair_separations):
            box = self.layout.box()
            row = box.row(align=True)
            row.prop(pair, "first", text="")
            row.prop(pair, "second", text="")
            row.operator(STIV_OT_separation_remove.bl_idname, text="", icon="REMOVE").index = index
            box.prop(pair, "separation")
        self.layout.operator(STIV_OT_separation_add.bl_idname, icon="ADD")
        self.layout.operator(STIV_OT_measure.bl_idname, icon="DRIVER_DISTANCE")
