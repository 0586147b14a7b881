# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.separation_add`, `stiv.separation_remove`: pairs of objects with their own minimum distance."""

from __future__ import annotations

import bpy
from bpy.props import IntProperty

from ...native_module import NeedsNativeModule
from ...translations import translate


class STIV_OT_separation_add(NeedsNativeModule, bpy.types.Operator):
    """Set a minimum distance for two selected objects, or between parts of one object"""

    bl_idname = "stiv.separation_add"
    bl_label = "Add Pair Distance"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add a row."""
        selected = list(context.selected_objects)
        if len(selected) not in (1, 2):
            self.report({"ERROR"}, translate("Select 1 or 2 objects ({} selected)").format(len(selected)))
            return {"CANCELLED"}
        row = context.scene.stiv.pair_separations.add()
        row.first, row.second = selected[0], selected[-1]
        return {"FINISHED"}


class STIV_OT_separation_remove(NeedsNativeModule, bpy.types.Operator):
    """Use the scene's minimum distance for this pair again"""

    bl_idname = "stiv.separation_remove"
    bl_label = "Remove Pair Distance"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    index: IntProperty(name="Index", min=0)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove the row."""
        rows = context.scene.stiv.pair_separations
        if self.index >= len(rows):
            self.report({"ERROR"}, translate("Pair {} does not exist: the list has {}").format(self.index, len(rows)))
            return {"CANCELLED"}
        rows.remove(self.index)
        return {"FINISHED"}
