# SPDX-License-Identifier: GPL-3.0-or-later
"""The popup that offers the ways out where an edit cannot follow a modifier."""

from __future__ import annotations

import bpy

from ... import stiv_blender
from ..reports import message_text
from .popup import open_popup

SIMULATIONS = frozenset({"CLOTH", "SOFT_BODY", "FLUID", "DYNAMIC_PAINT"})


def offer(error: Exception) -> set[str]:
    """Show the popup if a modifier is the cause.

    Returns the operator's result; nothing for any other error.
    """
    if not isinstance(error, stiv_blender.UnsupportedStackError) or not error.modifier:
        return set()
    owner, modifier, text = error.owner, error.modifier, message_text(error)

    def draw(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
        ob = bpy.data.objects.get(owner)
        if ob is not None and modifier in ob.modifiers:
            draw_ways_out(menu.layout, ob, ob.modifiers[modifier])

    open_popup(draw, text)
    return {"CANCELLED"}


def draw_ways_out(layout: bpy.types.UILayout, ob: bpy.types.Object, modifier: bpy.types.Modifier) -> None:
    """Draw a button for each setting and operator that lets an edit follow the object."""
    layout.operator_context = "INVOKE_DEFAULT"
    if modifier.type == "TRIANGULATE":
        layout.prop_enum(modifier, "quad_method", "FIXED")
    if modifier.type in SIMULATIONS:
        layout.operator("screen.frame_jump", text="Jump to Start", icon="REW").end = False
    if modifier.show_viewport:
        layout.prop(modifier, "show_viewport", text="Show in Viewport")
    if modifier.show_render:
        layout.prop(modifier, "show_render", text="Show in Render")
    row = layout.row()
    row.context_pointer_set("object", ob)
    row.operator("object.modifier_apply", text="Apply Modifier", icon="CHECKMARK").modifier = modifier.name
