# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.fit_into`: packs the selected objects into the active one."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty

from ... import stiv_blender
from .layout_operator import LayoutOperator

CONTAINERS = (
    ("auto", "Automatic", "Inside if the center of a closed mesh is inside it, otherwise the bounding box"),
    ("inside", "Inside", "The inside of a closed mesh"),
    ("box", "Bounding Box", "The box around the object, open above"),
)


class STIV_OT_fit_into(LayoutOperator, bpy.types.Operator):
    """Pack the selected objects into the active object, without contact"""

    bl_idname = "stiv.fit_into"
    bl_label = "Fit into"

    container: EnumProperty(name="Container", items=CONTAINERS, default="auto")
    turn: BoolProperty(name="Turn", description="Try orientations along the axes of the world", default=True)
    scale: BoolProperty(name="Scale Down", description="Scale all objects down uniformly until everything fits")
    tries: IntProperty(
        name="Tries", description="Places and orientations tried for each object", default=60, min=1, soft_max=500
    )
    seed: IntProperty(name="Seed", description="Seed of the random places", default=0, min=0)

    def begin(self, context: bpy.types.Context) -> stiv_blender.FitInto:
        """Read the scene."""
        values = (self.container, self.turn, self.scale, self.tries, self.seed)
        return stiv_blender.FitInto(context, stiv_blender.FitSettings(self.settings(context), *values))
