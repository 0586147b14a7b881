# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.repair`: resolves the intersections of the selected meshes."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, FloatProperty

from ... import stiv_blender
from .reshape import ReshapeOperator


class STIV_OT_repair(ReshapeOperator, bpy.types.Operator):
    """Contract the selected meshes until nothing intersects, then expand them again"""

    bl_idname = "stiv.repair"
    bl_label = "Collision Repair"

    max_deviation: FloatProperty(
        name="Max Deviation",
        description="Reject results that deviate more on average, relative to the object's size",
        default=0.05,
        min=0.0,
        soft_max=0.2,
        precision=3,
    )
    weld: BoolProperty(name="Weld", description="Merge coincident vertices first", default=False)

    def begin(self, context: bpy.types.Context) -> stiv_blender.BlenderRepair:
        """Read the scene."""
        settings = stiv_blender.RepairSettings(self.settings(context), self.max_deviation, self.weld)
        return stiv_blender.BlenderRepair.begin(context, settings)
