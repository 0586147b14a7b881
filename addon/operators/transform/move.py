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

    snap_normal: FloatVectorProperty(options={"HIDDEN", "SKIP_SAVE"})
    snap_point: FloatVectorProperty(options={"HIDDEN", "SKIP_SAVE"})

    def requested(self) -> Translation:
        """The transform of the properties; a normal of 0 turns nothing."""
        normal = np.array(self.snap_normal)
        length = float(np.linalg.norm(normal))
        aligned = (normal / length, np.array(self.snap_point)) if length > 0.0 else None
        return Translation(np.array(self.value), aligned)

    def own_values(self) -> tuple[object, ...]:
        """The values of the properties, for comparison."""
        return (*self.value, *self.snap_normal, *self.snap_point)

    @staticmethod
    def arguments(transform: Translation) -> dict[str, object]:
        """The properties of a transform."""
        values: dict[str, object] = {"value": transform.vector.tolist()}
        if transform.alignment is not None:
            values["snap_normal"], values["snap_point"] = (each.tolist() for each in transform.alignment)
        return values
