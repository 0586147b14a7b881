# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.scale`: scales the selection about the pivot without intersections."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.props import EnumProperty, FloatVectorProperty

from ...scene.orientations import active_axes
from ...transform.scaling import Scaling
from .transform_operator import TransformOperator

ORIENTATIONS = (
    ("GLOBAL", "Global", "Axes of the world"),
    ("LOCAL", "Local", "Axes of the active object"),
    ("DRAGGED", "As Dragged", "Axes that the drag used"),
)


class STIV_OT_scale(TransformOperator, bpy.types.Operator):
    """Scale the selection; surfaces collide instead of intersecting"""

    bl_idname = "stiv.scale"
    bl_label = "Collision Scale"
    kind = "scale"

    value: FloatVectorProperty(name="Scale", description="Scale factors", default=(1.0, 1.0, 1.0), subtype="XYZ")
    orientation: EnumProperty(name="Orientation", description="Axes of the scale factors", items=ORIENTATIONS)
    axes: FloatVectorProperty(size=9, default=(1, 0, 0, 0, 1, 0, 0, 0, 1), options={"HIDDEN", "SKIP_SAVE"})

    def requested(self) -> Scaling:
        """The transform of the properties."""
        if self.orientation == "GLOBAL":
            return Scaling(np.array(self.value))
        dragged = self.orientation == "DRAGGED"
        axes = np.array(self.axes).reshape(3, 3) if dragged else active_axes(bpy.context)
        return Scaling(np.array(self.value), axes)

    def own_values(self) -> tuple[object, ...]:
        """The values of the properties, for comparison."""
        return (*self.value, self.orientation, *self.axes)

    @staticmethod
    def arguments(transform: Scaling) -> dict[str, object]:
        """The properties of a transform."""
        if np.array_equal(transform.axes, np.eye(3)):
            return {"value": transform.factors.tolist(), "orientation": "GLOBAL"}
        axes = transform.axes.ravel().tolist()
        return {"value": transform.factors.tolist(), "orientation": "DRAGGED", "axes": axes}
