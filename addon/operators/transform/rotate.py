# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.rotate`: rotates the selection about the pivot without intersections."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.props import FloatProperty, FloatVectorProperty

from ... import stiv_blender
from ...transform.rotation import Rotation
from ...translations import translate
from .transform_operator import TransformOperator


class STIV_OT_rotate(TransformOperator, bpy.types.Operator):
    """Rotate the selection; surfaces collide instead of intersecting"""

    bl_idname = "stiv.rotate"
    bl_label = "Collision Rotate"
    kind = "rotate"

    angle: FloatProperty(name="Angle", subtype="ANGLE", description="Counterclockwise rotation about the axis")
    axis: FloatVectorProperty(
        name="Axis", subtype="DIRECTION", default=(0.0, 0.0, 1.0), description="Rotation axis in world space"
    )

    def requested(self) -> Rotation:
        """The transform of the properties. ValueError for a zero axis."""
        axis = np.array(self.axis)
        length = np.linalg.norm(axis)
        if not length > 0.0:
            raise stiv_blender.InputError(translate("The rotation axis is (0, 0, 0): set a direction"))
        return Rotation(self.angle, axis / length)

    def own_values(self) -> tuple[object, ...]:
        """The values of the properties, for comparison."""
        return (self.angle, *self.axis)

    @staticmethod
    def arguments(transform: Rotation) -> dict[str, object]:
        """The properties of a transform."""
        return {"angle": transform.angle, "axis": transform.axis.tolist()}
