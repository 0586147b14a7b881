# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.handle_add`, `stiv.handle_remove`: the vertex groups that are handles of the active mesh."""

from __future__ import annotations

import bpy
from bpy.props import IntProperty

from ...native_module import NeedsNativeModule
from ...translations import translate


class _HandleOperator(NeedsNativeModule):
    """Base of operators on the active mesh."""

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    @classmethod
    def is_available(cls, context: bpy.types.Context) -> bool:
        """With an active mesh."""
        return getattr(context.active_object, "type", "") == "MESH"


class STIV_OT_handle_add(_HandleOperator, bpy.types.Operator):
    """Make the active vertex group a handle, or add an empty row to choose one"""

    bl_idname = "stiv.handle_add"
    bl_label = "Add Handle"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add a row, with the active group unless it already has one."""
        obj = context.active_object
        active = obj.vertex_groups.active
        rows = obj.stiv.handles
        taken = {row.name for row in rows}
        rows.add().name = active.name if active is not None and active.name not in taken else ""
        return {"FINISHED"}


class STIV_OT_handle_remove(_HandleOperator, bpy.types.Operator):
    """Remove the vertex group from the handles; the group itself stays"""

    bl_idname = "stiv.handle_remove"
    bl_label = "Remove Handle"

    index: IntProperty(name="Index", min=0)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove the row."""
        rows = context.active_object.stiv.handles
        if self.index >= len(rows):
            self.report({"ERROR"}, translate("Handle {} does not exist: the list has {}").format(self.index, len(rows)))
            return {"CANCELLED"}
        rows.remove(self.index)
        return {"FINISHED"}
