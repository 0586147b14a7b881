# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds obstacles that another frame changes during an edit. States are tested against near obstacles alone."""

from __future__ import annotations

from collections.abc import Sequence

import bpy

from stiv.blender.scene.static_mesh import StaticMesh
from stiv.blender.scene.static_reading import find_changed


class ObstacleWatch:
    """Compares all obstacles with Blender's evaluation, once in each frame in which they are equal."""

    def __init__(self, frame: float) -> None:
        """frame: in which they were read."""
        self._frames = {frame}

    def message(self, context: bpy.types.Context, obstacles: Sequence[StaticMesh]) -> str:
        """The message on an obstacle that Blender shows differently in the present frame; "" without any."""
        frame = context.scene.frame_current_final
        if not obstacles or frame in self._frames:
            return ""
        name = find_changed(context, obstacles)
        if name:
            return f"{name}: this frame shows it differently; go back to frame {min(self._frames):g}"
        self._frames.add(frame)
        return ""
