# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.settle`: moves the selected meshes as close to their rest shape as contact allows."""

from __future__ import annotations

from dataclasses import replace

import bpy
from bpy.props import FloatProperty, IntProperty

from ... import stiv_blender
from .reshape import ReshapeOperator


class STIV_OT_settle(ReshapeOperator, bpy.types.Operator):
    """Solve again toward the rest shape, as long as the meshes get closer"""

    bl_idname = "stiv.settle"
    bl_label = "Collision Settle"

    rounds: IntProperty(name="Rounds", description="Maximum number of rounds", default=4, min=1, soft_max=16, max=64)
    smoothness: FloatProperty(
        name="Smoothness",
        description="Higher spreads the response smoothly, lower follows the goal more tightly",
        default=0.01,
        min=1e-4,
        max=10.0,
        precision=3,
    )

    def begin(self, context: bpy.types.Context) -> stiv_blender.BlenderExpansion:
        """Read the scene."""
        settings = replace(self.settings(context), smoothness=self.smoothness)
        expansion = stiv_blender.ExpansionSettings(settings, rounds=self.rounds)
        return stiv_blender.BlenderExpansion.begin(context, expansion)
