# SPDX-License-Identifier: GPL-3.0-or-later
"""The direction in which objects fall: along gravity, or along the view at the time of the call."""

from __future__ import annotations

import bpy
from bpy.props import FloatVectorProperty
from mathutils import Vector

DIRECTIONS = (
    ("GRAVITY", "Gravity", "Along the gravity of the scene"),
    ("VIEW", "View", "Away from the viewer"),
)


class ViewDirection:
    """Mixin of operators, before their base, with a property `direction`; remembers the view for the redo panel."""

    direction: str
    view: FloatVectorProperty(options={"HIDDEN", "SKIP_SAVE"}, default=(0.0, 0.0, 0.0))

    def prepare(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        """Remember the direction of the view of the context, if it has one."""
        if context.region_data is not None:
            self.view = context.region_data.view_rotation @ Vector((0.0, 0.0, -1.0))

    def chosen_direction(self, context: bpy.types.Context) -> tuple[float, float, float] | None:
        """The direction for the layout; None for its default. Without a view, View is straight down."""
        if self.direction == "GRAVITY":
            scene = context.scene
            return tuple(scene.gravity) if scene.use_gravity and any(scene.gravity) else (0.0, 0.0, -1.0)
        if self.direction == "VIEW":
            return tuple(self.view) if any(self.view) else (0.0, 0.0, -1.0)
        return None
