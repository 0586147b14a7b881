# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes of the open scene, as a tool makes them, that the live guard corrects."""

from typing import Any

import bpy

from stiv.blender import AcceptedScene, EditSettings, find_intersections, guard_result


def guarded(change: Any, **settings: Any) -> Any:
    """Read the scene, change it, guard the result."""
    chosen = EditSettings(**settings)
    accepted = AcceptedScene.read(bpy.context, find_intersections(bpy.context, chosen))
    change()
    bpy.context.view_layer.update()
    return guard_result(bpy.context, chosen, accepted)
