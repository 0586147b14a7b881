# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.settle_contact`: moves the selected objects into contact with the nearest surfaces."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty

from ... import stiv_blender
from ...automatic import AutomaticProperty, draw_automatic
from .direction import DIRECTIONS, ViewDirection
from .layout_operator import LayoutOperator

NEAREST = (("NEAREST", "Nearest Surface", "Toward the nearest surface of each object"),)


class STIV_OT_settle_contact(ViewDirection, LayoutOperator, bpy.types.Operator):
    """Move the selected objects against the nearest surfaces until they rest"""

    bl_idname = "stiv.settle_contact"
    bl_label = "Settle into Contact"

    direction: EnumProperty(name="Direction", items=(*NEAREST, *DIRECTIONS), default="NEAREST")
    turn: BoolProperty(name="Turn", description="Turn and slide until three contacts support the object", default=True)
    max_distance: FloatProperty(
        name="Max Distance",
        description="Longest way of an object; 0 for its own size",
        subtype="DISTANCE",
        default=0.0,
        min=0.0,
    )
    automatic_distance: AutomaticProperty(
        of="max_distance", start=1.0, name="Auto Distance", description="Let each object go as far as its own size"
    )

    def begin(self, context: bpy.types.Context) -> stiv_blender.SettleIntoContact:
        """Read the scene."""
        direction = self.chosen_direction(context)
        settings = stiv_blender.SettleSettings(self.settings(context), direction, self.turn, self.max_distance)
        return stiv_blender.SettleIntoContact(context, settings)

    def shown_properties(self) -> tuple[str, ...]:
        """The distance has a row of its own."""
        return ("direction", "turn")

    def draw(self, context: bpy.types.Context) -> None:
        """The redo panel."""
        super().draw(context)
        draw_automatic(self.layout, self, "max_distance", "automatic_distance", "Max Distance")
