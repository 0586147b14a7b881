# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads from the scene's tool settings how a drag snaps and edits proportionally, and what it does not follow."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ..modal.proportional import Proportional
from ..transform.snapping import GEOMETRY, Seen, Snap, Steps
from ..transform.view import Pixel, Vector, View
from ..translations import say
from .frame import active_point, orientation_names, selected_points
from .orientations import is_followed

PIXELS = 20.0  # the least length of an increment in a parallel view
FOLLOWED = frozenset({"INCREMENT", "GRID", *GEOMETRY})


def read_snap(context: Any, moving: Callable[[], frozenset[str]], view: Callable[[], View | None]) -> Snap:
    """Snapping of a drag. `moving` names the objects that move, which are looked through; `view` is the present one."""
    tools = context.scene.tool_settings
    kinds = {"move": tools.use_snap_translate, "rotate": tools.use_snap_rotate, "scale": tools.use_snap_scale}
    return Snap(
        elements=frozenset(tools.snap_elements),
        kinds=frozenset(kind for kind, snaps in kinds.items() if snaps),
        steps=_steps(context, tools),
        source=tools.snap_target,
        points=_source_points(context),
        active=active_point(context),
        look=lambda pixel: _look(context, view(), pixel, moving()),
    )


def read_proportional(context: Any) -> Proportional:
    """Proportional editing as the scene has it; of points in Edit Mode only."""
    tools = context.scene.tool_settings
    return Proportional(
        context.mode != "OBJECT",
        tools.use_proportional_edit,
        max(_size_owner(tools)[0], 1e-6),
        tools.proportional_edit_falloff,
        tools.use_proportional_connected,
    )


def keep_proportional(context: Any, proportional: Proportional) -> None:
    """Let the scene have what a drag ended with, as Blender's own transforms do."""
    if proportional.active:
        tools = context.scene.tool_settings
        setattr(tools, _size_owner(tools)[1], proportional.size)
        tools.proportional_edit_falloff = proportional.falloff


def _size_owner(tools: Any) -> tuple[float, str]:
    name = "proportional_size" if hasattr(tools, "proportional_size") else "proportional_distance"
    return getattr(tools, name), name


def unsupported_settings(context: Any) -> list[str]:
    """Settings of the scene that a transform does not follow, for the header."""
    found = []
    chosen = orientation_names(context)[0]
    if not is_followed(context, chosen):
        found.append(say("orientation {} is not supported; using Global").format(say(chosen.title())))
    tools = context.scene.tool_settings
    if context.mode == "OBJECT" and tools.use_proportional_edit_objects:
        found.append(say("proportional editing of objects is not supported"))
    if context.mode != "OBJECT" and tools.use_proportional_edit:
        if tools.use_proportional_projected:
            found.append(say("projected proportional editing is not supported; using distance in space"))
        if tools.transform_pivot_point == "INDIVIDUAL_ORIGINS":
            found.append(say("Individual Origins are not supported with proportional editing; using the median"))
    return found + _unsupported_snapping(context.scene)


def _unsupported_snapping(scene: Any) -> list[str]:
    """Elements to snap to that are not followed, for the header."""
    others = sorted(set(scene.tool_settings.snap_elements) - FOLLOWED)
    if not others or not scene.tool_settings.use_snap:
        return []
    names = ", ".join(say(name.replace("_", " ").title()) for name in others)
    return [say("snapping to {} is not supported").format(names)]


def _look(context: Any, view: View | None, pixel: Pixel, moving: frozenset[str]) -> Seen | None:
    from stiv.blender.scene.ray_casting import first_seen  # the add-on registers without the native module

    if view is None:
        return None
    near, far = view.unproject(pixel, -1.0), view.unproject(pixel, 1.0)
    found = first_seen(context, near, far - near, moving)
    return None if found is None else Seen(*found)


def _steps(context: Any, tools: Any) -> Steps:
    scale = _grid_scale(context)
    turns = (
        getattr(tools, "snap_angle_increment_3d", math.radians(5.0)),
        getattr(tools, "snap_angle_increment_3d_precision", math.radians(1.0)),
    )
    return Steps(move=(scale, scale / 10.0), rotate=turns)


def _grid_scale(context: Any) -> float:
    """A grid unit of the view; in a parallel view the power of ten of it that is seen large enough."""
    space, data = context.space_data, context.region_data
    unit = float(getattr(getattr(space, "overlay", None), "grid_scale", 1.0)) or 1.0
    if data is None or data.is_perspective or context.region is None:
        return unit
    pixel = 2.0 / np.linalg.norm(np.array(data.perspective_matrix)[0, :3]) / max(context.region.width, 1)
    return float(unit * 10.0 ** math.ceil(math.log10(PIXELS * pixel / unit)))


def _source_points(context: Any) -> Vector:
    """What of the selection may lie on a target: corners of the objects' boxes, or the selected points."""
    if context.mode != "OBJECT":
        return selected_points(context)
    corners = [
        np.array(thing.matrix_world @ type(thing.location)(corner))
        for thing in context.selected_objects
        for corner in thing.bound_box
    ]
    return np.array(corners, dtype=float).reshape(-1, 3)
