# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.push_apart`: moves the selected objects apart."""

from __future__ import annotations

import bpy

from ... import stiv_blender
from .layout_operator import LayoutOperator


class STIV_OT_push_apart(LayoutOperator, bpy.types.Operator):
    """Move the selected objects as little as possible until none intersect"""

    bl_idname = "stiv.push_apart"
    bl_label = "Push Apart"

    def begin(self, context: bpy.types.Context) -> stiv_blender.PushApart:
        """Read the scene."""
        return stiv_blender.PushApart(context, self.settings(context))
