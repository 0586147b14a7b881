# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.repair`: resolves the intersections of the selected meshes."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, FloatProperty

from ... import stiv_blender
from ...scene.edit_settings import edit_settings
from ..task_operator import TimeLimitProperty
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
    time_limit: TimeLimitProperty(description="Take the best result within this time; 0 for no limit")

    def settings(self, context: bpy.types.Context) -> stiv_blender.EditSettings:
        """The settings of the scene, with the time limit."""
        return edit_settings(context.scene, time_budget=self.time_limit)

    def begin(self, context: bpy.types.Context) -> stiv_blender.BlenderRepair:
        """Read the scene."""
        settings = stiv_blender.RepairSettings(self.settings(context), self.max_deviation, self.weld)
        return stiv_blender.BlenderRepair.begin(context, settings)
