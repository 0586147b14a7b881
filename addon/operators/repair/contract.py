# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.contract`: selected meshes shrink toward their skeletons."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty

from .reshape import ReshapeOperator


class STIV_OT_contract(ReshapeOperator, bpy.types.Operator):
    """Shrink the selected meshes toward their skeletons; Expand restores the shape"""

    bl_idname = "stiv.contract"
    bl_label = "Contract"

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

    def begin(self, context: bpy.types.Context) -> Any:
        """Read the scene."""
        from stiv.blender import BlenderContraction, ContractionSettings  # registers without the native module

        chosen = ContractionSettings(
            self.settings(context), self.steps, self.smoothing, self.until_free, self.new_original
        )
        return BlenderContraction.begin(context, chosen)
