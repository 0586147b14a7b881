# SPDX-License-Identifier: GPL-3.0-or-later
"""By what the active object is moved, its handles and weights."""

from __future__ import annotations

from typing import Any

import bpy

from ..operators.handles import STIV_OT_handle_add, STIV_OT_handle_remove
from .drawing import SubPanel


class STIV_PT_deformation(SubPanel, bpy.types.Panel):
    """By what the active object is moved and gives way."""

    bl_idname = "STIV_PT_deformation"
    bl_label = "Deformation"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """For an active mesh or lattice."""
        return super().poll(context) and getattr(context.active_object, "type", "") in {"MESH", "LATTICE"}

    def draw(self, context: bpy.types.Context) -> None:
        """The deformation; handles where it has some; weights."""
        thing = context.active_object
        self.layout.use_property_split = True
        self.layout.prop(thing.stiv, "deformation")
        if thing.stiv.deformation in {"laplacian", "arap"} and thing.type == "MESH":
            _draw_handles(self.layout, thing)
        row = self.layout.row(align=True)
        row.prop_search(thing.stiv, "weight_group", thing, "vertex_groups")
        row.prop(thing.stiv, "weight_invert", text="", icon="ARROW_LEFTRIGHT")
        row = self.layout.row(align=True, heading="Weight Axes")
        row.active = bool(thing.stiv.weight_group)
        for index, axis in enumerate("XYZ"):
            row.prop(thing.stiv, "weight_axes", index=index, text=axis, toggle=True)


def _draw_handles(layout: Any, thing: Any) -> None:
    box = layout.box()
    for index, handle in enumerate(thing.stiv.handles):
        row = box.row(align=True)
        row.prop_search(handle, "name", thing, "vertex_groups", text="Handle")
        row.operator(STIV_OT_handle_remove.bl_idname, text="", icon="REMOVE").index = index
    box.operator(STIV_OT_handle_add.bl_idname, icon="ADD")
    box.prop_search(thing.stiv, "anchor", thing, "vertex_groups")
    for name in ("rest", "pull"):
        box.prop(thing.stiv, name)
