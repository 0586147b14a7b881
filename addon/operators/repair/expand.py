# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.expand`: expands the selected meshes toward their rest shape, or the shape of another object."""

from __future__ import annotations

import bpy
from bpy.props import FloatProperty, StringProperty

from ... import stiv_blender
from .reshape import ReshapeOperator


class STIV_OT_expand(ReshapeOperator, bpy.types.Operator):
    """Expand the selected meshes toward their rest shape without intersections"""

    bl_idname = "stiv.expand"
    bl_label = "Collision Expand"

    target: StringProperty(
        name="Target",
        description="Mesh with the same vertices that gives the shape; the rest shape if empty",
    )
    amount: FloatProperty(
        name="Amount", description="Fraction of the way", default=1.0, min=0.0, max=1.0, subtype="FACTOR"
    )

    def begin(self, context: bpy.types.Context) -> stiv_blender.BlenderExpansion:
        """Read the scene."""
        settings = stiv_blender.ExpansionSettings(self.settings(context), self.target, self.amount)
        return stiv_blender.BlenderExpansion.begin(context, settings)

    def draw(self, context: bpy.types.Context) -> None:
        """The redo panel, with a choice of objects."""
        self.layout.prop_search(self, "target", context.scene, "objects")
        self.layout.prop(self, "amount")
        self.layout.prop(self, "time_limit")
