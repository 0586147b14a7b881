# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.contract`: selected meshes shrink toward their skeletons."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty

from .reshape import ReshapeOperator


class STIV_OT_contract(ReshapeOperator, bpy.types.Operator):
    """Shrink the selected meshes toward their skeletons, thin parts first; Expand brings the shape back."""

    bl_idname = "stiv.contract"
    bl_label = "Contract"

    steps: IntProperty(
        name="Steps", description="Each is twice as strong as the one before", default=1, min=1, soft_max=16, max=64
    )
    smoothing: FloatProperty(
        name="Strength", description="Of the first step, the same for any size", default=1.0, min=1e-6, soft_max=16.0
    )
    until_free: BoolProperty(
        name="Until Free",
        description="End as soon as nothing intersects, after so many steps at most, at the best of them",
        default=False,
    )
    new_original: BoolProperty(
        name="New Original",
        description="Keep the present shape as the one that Expand goes back to, in place of the one kept already",
        default=False,
    )

    def begin(self, context: bpy.types.Context) -> Any:
        """Read the scene."""
        from stiv.blender import BlenderContraction, ContractionSettings  # registers without the native module

        chosen = ContractionSettings(
            self.settings(context), self.steps, self.smoothing, self.until_free, self.new_original
        )
        return BlenderContraction.begin(context, chosen)
