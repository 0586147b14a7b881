# SPDX-License-Identifier: GPL-3.0-or-later
"""The popup that offers the ways out where an edit cannot start: the start intersects, or a modifier is the cause."""

from __future__ import annotations

import bpy

from ... import stiv_blender
from ..reports import message_text
from . import refusals
from .passing import STIV_OT_let_pass
from .popup import open_popup
from .repair import STIV_OT_repair
from .separate import STIV_OT_separate

MAX_PAIRS = 5  # pairs of objects in the popup


def offer(context: bpy.types.Context, error: Exception) -> set[str]:
    """Show the popup if objects intersect each other, or a modifier is the cause.

    Returns the operator's result; nothing without a window, or for any other error.
    """
    if bpy.app.background or context.window is None:
        return set()
    if not isinstance(error, stiv_blender.ObjectsIntersectError) or not error.objects:
        return refusals.offer(error)
    lines = [message_text(stiv_blender.intersection_text(*pair)) for pair in error.objects]

    def draw(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
        for line in lines[1:MAX_PAIRS]:
            menu.layout.label(text=line, translate=False)
        draw_ways_out(menu.layout)

    open_popup(draw, lines[0])
    return {"CANCELLED"}


def draw_ways_out(layout: bpy.types.UILayout) -> None:
    """Draw a button for each operator that resolves or allows the intersections."""
    layout.operator_context = "INVOKE_DEFAULT"
    layout.operator(STIV_OT_repair.bl_idname, text="Repair", icon="MODIFIER")
    layout.operator(STIV_OT_separate.bl_idname, text="Separate", icon="FULLSCREEN_ENTER")
    layout.operator(STIV_OT_let_pass.bl_idname, text="Let These Pass", icon="GHOST_ENABLED")
