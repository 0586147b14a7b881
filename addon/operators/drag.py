# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.drag`: what the transforms start when they are invoked."""

from __future__ import annotations

import bpy
from bpy.props import EnumProperty

from .dragging import OPERATORS, Dragging


class STIV_OT_drag(Dragging, bpy.types.Operator):
    """Drag what is selected; surfaces give way instead of going through each other."""

    bl_idname = "stiv.drag"
    bl_label = "Drag without Interference"
    bl_options = {"INTERNAL", "BLOCKING", "GRAB_CURSOR"}  # noqa: RUF012 (Blender reads a set)

    kind: EnumProperty(items=[(kind, kind.title(), "") for kind in OPERATORS], options={"SKIP_SAVE"})
