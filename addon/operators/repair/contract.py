# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.contract`: shrinks the selected meshes toward their skeletons."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty

from ... import stiv_blender
from .reshape import ReshapeOperator


class STIV_OT_contract(ReshapeOperator, bpy.types.Operator):
    """Shrink the selected meshes toward their skeletons; Expand restores the shape"""

    bl_idname = "stiv.contract"
    bl_label = "Collision Contract"

    steps: IntProperty(
        name="Steps",
        description="Number of steps; each is twice as strong as the previous one",
        default=1,
        min=1,
        soft_max=16,
        max=64,
    )
    smoothing: FloatProperty(
        name="Strength",
        description="Strength of the first step, independent of the object's size",
        default=1.0,
        min=1e-6,
        soft_max=16.0,
    )
    until_free: BoolProperty(
        name="Stop When Clear",
        description="Stop when nothing intersects, or use the best of these steps",
        default=False,
    )
    new_original: BoolProperty(
        name="Reset Rest Shape",
        description="Store the current shape as the rest shape that Expand restores",
        default=False,
    )

    def begin(self, context: bpy.types.Context) -> stiv_blender.BlenderContraction:
        """Read the scene."""
        settings = stiv_blender.ContractionSettings(
            self.settings(context), self.steps, self.smoothing, self.until_free, self.new_original
        )
        return stiv_blender.BlenderContraction.begin(context, settings)
