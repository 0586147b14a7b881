# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of objects: roles, deformation with handles and weights, Loop subdivision, distances of pairs."""

from __future__ import annotations

from typing import Any

import bpy

from ..operators.check.measure import STIV_OT_measure
from ..operators.setup.handles import STIV_OT_handle_add, STIV_OT_handle_remove
from ..operators.setup.loop import STIV_OT_loop_add, STIV_OT_loop_refresh, STIV_OT_loop_remove
from ..operators.setup.pair_distances import STIV_OT_separation_add, STIV_OT_separation_remove
from ..scene.edit_settings import refined_object
from ..translations import say
from .base import MOST_OBJECTS, SubPanel


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


class STIV_PT_roles(SubPanel, bpy.types.Panel):
    """How each selected object takes part."""

    bl_idname = "STIV_PT_roles"
    bl_label = "Roles"

    def draw(self, context: bpy.types.Context) -> None:
        """One row an object."""
        chosen = [thing for thing in context.selected_objects if thing.type in {"MESH", "LATTICE"}]
        for thing in chosen[:MOST_OBJECTS]:
            row = self.layout.row()
            row.label(text=thing.name, icon=f"OUTLINER_OB_{thing.type}")
            row.prop(thing.stiv, "role", text="")
        if len(chosen) > MOST_OBJECTS:
            self.layout.label(text=say("and {} more").format(len(chosen) - MOST_OBJECTS))
        if not chosen:
            self.layout.label(text="Select objects to set their roles")


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


class STIV_PT_separation(SubPanel, bpy.types.Panel):
    """Distances that pairs of objects keep."""

    bl_idname = "STIV_PT_separation"
    bl_label = "Pair Distances"
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
