# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.move`: move what is selected; nothing goes through anything."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.props import FloatVectorProperty

from ..modal.state import State
from ..transform.frame import Frame
from ..transform.translation import Translation, measure_translation
from .adapter import TransformOperator


class STIV_OT_move(TransformOperator, bpy.types.Operator):
    """Move what is selected; surfaces give way instead of going through each other."""

    bl_idname = "stiv.move"
    bl_label = "Move without Interference"
    kind = "move"

    value: FloatVectorProperty(name="Move", description="In world space", subtype="TRANSLATION", unit="LENGTH")

    def given(self) -> Translation:
        """The transform of the properties."""
        return Translation(np.array(self.value))

    def measure(self, state: State, frame: Frame) -> Translation:
        """The transform that a drag asks for."""
        return measure_translation(state, frame)

    def keep(self, transform: Translation) -> None:
        """Store a transform for the redo panel."""
        self.value = transform.vector
