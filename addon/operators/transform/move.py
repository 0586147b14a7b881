# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.move`: moves the selection without intersections."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.props import FloatVectorProperty

from ...transform.translation import Translation
from .transform_operator import TransformOperator


class STIV_OT_move(TransformOperator, bpy.types.Operator):
    """Move the selection; surfaces collide instead of intersecting"""

    bl_idname = "stiv.move"
    bl_label = "Collision Move"
    kind = "move"

    value: FloatVectorProperty(
        name="Move", description="Translation in world space", subtype="TRANSLATION", unit="LENGTH"
    )

    def requested(self) -> Translation:
        """The transform of the properties."""
        return Translation(np.array(self.value))

    def own_values(self) -> tuple[object, ...]:
        """The values of the properties, for comparison."""
        return tuple(self.value)

    @staticmethod
    def arguments(transform: Translation) -> dict[str, object]:
        """The properties of a transform."""
        return {"value": transform.vector.tolist()}
