# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.separation_add`, `stiv.separation_remove`: pairs of objects that keep a distance of their own."""

from __future__ import annotations

import bpy
from bpy.props import IntProperty

from ...native_module import NeedsNativeModule


class STIV_OT_separation_add(NeedsNativeModule, bpy.types.Operator):
    """Let the two selected objects keep a distance of their own; one alone keeps it from itself."""

    bl_idname = "stiv.separation_add"
    bl_label = "Add Pair of Objects"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add a row."""
        chosen = list(context.selected_objects)
        if len(chosen) not in (1, 2):
            self.report({"ERROR"}, f"select one object or two; {len(chosen)} are selected")
            return {"CANCELLED"}
        row = context.scene.stiv.pair_separations.add()
        row.first, row.second = chosen[0], chosen[-1]
        return {"FINISHED"}


class STIV_OT_separation_remove(NeedsNativeModule, bpy.types.Operator):
    """Let the pair keep the scene's distance again."""

    bl_idname = "stiv.separation_remove"
    bl_label = "Remove Pair of Objects"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    index: IntProperty(name="Row", min=0)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove the row."""
        rows = context.scene.stiv.pair_separations
        if self.index >= len(rows):
            self.report({"ERROR"}, f"there are {len(rows)} pairs; there is no row {self.index}")
            return {"CANCELLED"}
        rows.remove(self.index)
        return {"FINISHED"}
