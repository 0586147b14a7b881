# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.expand`: selected meshes go back to their shape, or to that of another object, without intersections."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import FloatProperty, StringProperty

from .reshape import ReshapeOperator


class STIV_OT_expand(ReshapeOperator, bpy.types.Operator):
    """Expand the selected meshes toward their rest shape without intersections"""

    bl_idname = "stiv.expand"
    bl_label = "Expand"

    target: StringProperty(
        name="Target",
        description="Mesh object with the same vertices whose local shape is the goal; the rest shape if empty",
    )
    amount: FloatProperty(
        name="Amount", description="Fraction of the way", default=1.0, min=0.0, max=1.0, subtype="FACTOR"
    )

    def begin(self, context: bpy.types.Context) -> Any:
        """Read the scene."""
        from stiv.blender import BlenderExpansion, ExpansionSettings  # registers without the native module

        return BlenderExpansion.begin(context, ExpansionSettings(self.settings(context), self.target, self.amount))

    def draw(self, context: bpy.types.Context) -> None:
        """The redo panel, with a choice of objects."""
        self.layout.prop_search(self, "target", context.scene, "objects")
        self.layout.prop(self, "amount")
