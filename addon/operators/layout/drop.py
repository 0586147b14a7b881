# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.drop`: drops the selected objects until they rest."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty

from ... import stiv_blender
from .direction import DIRECTIONS, ViewDirection
from .layout_operator import LayoutOperator


class STIV_OT_drop(ViewDirection, LayoutOperator, bpy.types.Operator):
    """Drop the selected objects until they rest on the surfaces below"""

    bl_idname = "stiv.drop"
    bl_label = "Drop"

    direction: EnumProperty(name="Direction", items=DIRECTIONS, default="GRAVITY")
    turn: BoolProperty(name="Turn", description="Turn and slide until three contacts support the object", default=True)
    ground: BoolProperty(name="Ground Plane", description="Stop objects with nothing below at the plane Z = 0")

    def begin(self, context: bpy.types.Context) -> stiv_blender.Drop:
        """Read the scene."""
        direction = self.chosen_direction(context)
        settings = stiv_blender.DropSettings(self.settings(context), direction, self.turn, self.ground)
        return stiv_blender.Drop(context, settings)
