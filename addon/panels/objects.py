# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of objects: roles, deformation with handles and weights, Loop subdivision, pair distances."""

from __future__ import annotations

import bpy

from ..operators.check.measure import STIV_OT_measure
from ..operators.setup.handles import STIV_OT_handle_add, STIV_OT_handle_remove
from ..operators.setup.loop import STIV_OT_loop_add, STIV_OT_loop_refresh, STIV_OT_loop_remove
from ..operators.setup.pair_distances import STIV_OT_separation_add, STIV_OT_separation_remove
from ..operators.transform.morph import STIV_OT_morph
from ..operators.transform.morph_drag import STIV_OT_morph_drag
from ..scene.edit_settings import refined_object
from ..translations import translate
from .base import SubPanel

EDITABLE = frozenset({"MESH", "LATTICE", "CURVE", "SURFACE"})
MAX_OBJECTS = 10  # rows of the panel of roles


class STIV_PT_roles(SubPanel, bpy.types.Panel):
    """The roles of the selected objects."""

    bl_idname = "STIV_PT_roles"
    bl_label = "Roles"

    def draw(self, context: bpy.types.Context) -> None:
        """A row for each object."""
        selected = [obj for obj in context.selected_objects if obj.type in EDITABLE]
        for obj in selected[:MAX_OBJECTS]:
            row = self.layout.row()
            row.label(text=obj.name, translate=False, icon=f"OUTLINER_OB_{obj.type}")
            row.prop(obj.stiv, "role", text="")
        if len(selected) > MAX_OBJECTS:
            self.layout.label(text=translate("and {} more").format(len(selected) - MAX_OBJECTS))
        if not selected:
            self.layout.label(text="Select objects to set their roles")


class STIV_PT_deformation(SubPanel, bpy.types.Panel):
    """How the active object deforms."""

    bl_idname = "STIV_PT_deformation"
    bl_label = "Deformation"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """For an active object with vertices or points."""
        return super().poll(context) and getattr(context.active_object, "type", "") in EDITABLE

    def draw(self, context: bpy.types.Context) -> None:
        """The deformation, its handles and the weights."""
        obj = context.active_object
        self.layout.use_property_split, self.layout.use_property_decorate = True, False
        self.layout.prop(obj.stiv, "deformation")
        if obj.stiv.deformation in {"laplacian", "arap"} and obj.type == "MESH":
            _draw_handles(self.layout, obj)
        if obj.type not in {"MESH", "LATTICE"}:  # others have no vertex groups
            return
        row = self.layout.row(align=True)
        row.prop_search(obj.stiv, "weight_group", obj, "vertex_groups")
        row.prop(obj.stiv, "weight_invert", text="", icon="ARROW_LEFTRIGHT")
        row = self.layout.row(align=True, heading="Weight Axes")
        row.active = bool(obj.stiv.weight_group)
        for index, axis in enumerate("XYZ"):
            row.prop(obj.stiv, "weight_axes", index=index, text=axis, toggle=True)


def _draw_handles(layout: bpy.types.UILayout, obj: bpy.types.Object) -> None:
    box = layout.box()
    for index, handle in enumerate(obj.stiv.handles):
        row = box.row(align=True)
        row.prop_search(handle, "name", obj, "vertex_groups", text="Handle")
        row.operator(STIV_OT_handle_remove.bl_idname, text="", icon="REMOVE").index = index
    box.operator(STIV_OT_handle_add.bl_idname, icon="ADD")
    box.prop_search(obj.stiv, "anchor", obj, "vertex_groups")
    for name in ("rest", "pull"):
        box.prop(obj.stiv, name)


class STIV_PT_shape_keys(SubPanel, bpy.types.Panel):
    """The shape keys of the active object, with a slider that stops at contact."""

    bl_idname = "STIV_PT_shape_keys"
    bl_label = "Shape Keys"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """For an active object with shape keys, in Object Mode."""
        return super().poll(context) and STIV_OT_morph.is_available(context)

    def draw(self, context: bpy.types.Context) -> None:
        """The list, the slider of the active key, and the operators."""
        ob = context.active_object
        keys = ob.data.shape_keys
        self.layout.template_list("UI_UL_list", "stiv", keys, "key_blocks", ob, "active_shape_key_index", rows=3)
        self.layout.prop(ob.stiv, "morph_value")
        row = self.layout.row(align=True)
        row.operator(STIV_OT_morph_drag.bl_idname, text="Drag", icon="ARROW_LEFTRIGHT")
        row.operator(STIV_OT_morph.bl_idname, text="Morph", icon="SHAPEKEY_DATA")


class STIV_PT_loop(SubPanel, bpy.types.Panel):
    """Loop subdivision of the active triangle cage."""

    bl_idname = "STIV_PT_loop"
    bl_label = "Loop Subdivision"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a set)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """For an active mesh."""
        return super().poll(context) and getattr(context.active_object, "type", "") == "MESH"

    def draw(self, context: bpy.types.Context) -> None:
        """A button to add it, or its settings."""
        obj = context.active_object
        if refined_object(obj) is None:
            self.layout.operator(STIV_OT_loop_add.bl_idname, icon="ADD")
            return
        self.layout.use_property_split, self.layout.use_property_decorate = True, False
        for name in ("levels", "boundary"):
            self.layout.prop(obj.stiv.loop, name)
        self.layout.operator(STIV_OT_loop_refresh.bl_idname, icon="FILE_REFRESH")
        self.layout.operator(STIV_OT_loop_remove.bl_idname, icon="REMOVE")


class STIV_PT_separation(SubPanel, bpy.types.Panel):
    """Minimum distances of pairs of objects."""

    bl_idname = "STIV_PT_separation"
    bl_label = "Pair Distances"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a set)

    def draw(self, context: bpy.types.Context) -> None:
        """A box for each pair, and buttons to add and measure."""
        for index, pair in enumerate(context.scene.stiv.pair_separations):
            box = self.layout.box()
            row = box.row(align=True)
            row.prop(pair, "first", text="")
            row.prop(pair, "second", text="")
            row.operator(STIV_OT_separation_remove.bl_idname, text="", icon="REMOVE").index = index
            box.prop(pair, "separation")
        self.layout.operator(STIV_OT_separation_add.bl_idname, icon="ADD")
        self.layout.operator(STIV_OT_measure.bl_idname, text="Measure", icon="DRIVER_DISTANCE")
