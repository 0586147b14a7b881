# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.scale`: scale what is selected about the pivot; nothing goes through anything."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.props import EnumProperty, FloatVectorProperty

from .. import scene_frame
from ..modal.state import State
from ..transform.frame import Frame
from ..transform.scaling import Scaling, measure_scaling
from .adapter import TransformOperator

ORIENTATIONS = (
    ("GLOBAL", "Global", "Along the axes of the world"),
    ("LOCAL", "Local", "Along the axes of the active object"),
)


class STIV_OT_scale(TransformOperator, bpy.types.Operator):
    """Scale what is selected; surfaces give way instead of going through each other."""

    bl_idname = "stiv.scale"
    bl_label = "Scale without Interference"
    kind = "scale"

    value: FloatVectorProperty(name="Scale", description="Factors", default=(1.0, 1.0, 1.0), subtype="XYZ")
    orientation: EnumProperty(name="Orientation", description="Axes of the factors", items=ORIENTATIONS)

    def frame(self, context: bpy.types.Context) -> Frame:
        """Pivot of the scene; axes as the property says, so that the redo panel means what the drag did."""
        return scene_frame.read_frame(context, orientation=self.orientation)

    def prepare(self, context: bpy.types.Context) -> None:
        """Take the scene's orientation for a drag."""
        self.orientation = scene_frame.scene_orientation(context)

    def given(self) -> Scaling:
        """The transform of the properties."""
        return Scaling(np.array(self.value))

    def measure(self, state: State, frame: Frame) -> Scaling:
        """The transform that a drag asks for."""
        return measure_scaling(state, frame)

    def keep(self, transform: Scaling) -> None:
        """Store a transform for the redo panel."""
        self.value = transform.factors
