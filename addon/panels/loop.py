# SPDX-License-Identifier: GPL-3.0-or-later
"""Loop subdivision of the active cage of triangles."""

from __future__ import annotations

import bpy

from ..object_choices import refined_object
from ..operators.loop import STIV_OT_loop_add, STIV_OT_loop_refresh, STIV_OT_loop_remove
from .drawing import SubPanel


class STIV_PT_loop(SubPanel, bpy.types.Panel):
    """Loop subdivision of the active cage of triangles."""

    bl_idname = "STIV_PT_loop"
    bl_label = "Loop Subdivision"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a set)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """For an active mesh."""
        return super().poll(context) and getattr(context.active_object, "type", "") == "MESH"

    def draw(self, context: bpy.types.Context) -> None:
        """Add, or levels and the way back."""
        thing = context.active_object
        if refined_object(thing) is None:
            self.layout.operator(STIV_OT_loop_add.bl_idname, icon="ADD")
            return
        self.layout.use_property_split = True
        for name in ("levels", "boundary"):
            self.layout.prop(thing.stiv.loop, name)
        self.layout.operator(STIV_OT_loop_refresh.bl_idname, icon="FILE_REFRESH")
        self.layout.operator(STIV_OT_loop_remove.bl_idname, icon="REMOVE")
