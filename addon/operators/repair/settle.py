# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.settle`: selected meshes come as near to their shape as the surfaces let them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import bpy
from bpy.props import FloatProperty, IntProperty

from .reshape import ReshapeOperator


class STIV_OT_settle(ReshapeOperator, bpy.types.Operator):
    """Solve again toward the rest shape, as long as the meshes get closer"""

    bl_idname = "stiv.settle"
    bl_label = "Settle"

    rounds: IntProperty(name="Rounds", description="Maximum number of rounds", default=4, min=1, soft_max=16, max=64)
    smoothness: FloatProperty(
        name="Smoothness",
        description="Higher spreads the response smoothly, lower follows the goal more tightly",
        default=0.01,
        min=1e-4,
        max=10.0,
        precision=3,
    )

    def begin(self, context: bpy.types.Context) -> Any:
        """Read the scene."""
        from stiv.blender import BlenderExpansion, ExpansionSettings  # registers without the native module

        settings = replace(self.settings(context), smoothness=self.smoothness)
        return BlenderExpansion.begin(context, ExpansionSettings(settings, rounds=self.rounds))
