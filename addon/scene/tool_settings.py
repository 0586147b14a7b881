# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads snapping and proportional editing from the scene's tool settings, and names the settings not supported."""

from __future__ import annotations

import math
from collections.abc import Callable

import bpy
import numpy as np

from .. import stiv_blender
from ..modal.proportional import Proportional
from ..transform.snapping import GEOMETRY, Hit, Increments, Snap
from ..transform.view import Pixel, Vector, View
from ..translations import translate
from .frame import active_point, orientation_names, selected_points
from .orientations import is_supported

MIN_PIXELS = 20.0  # length of an increment in a parallel view
SUPPORTED_ELEMENTS = frozenset({"INCREMENT", "GRID", *GEOMETRY})


def read_snap(
    context: bpy.types.Context, moving: Callable[[], frozenset[str]], view: Callable[[], View | None]
) -> Snap:
    """Snapping of a drag. `moving` names the moving objects, which are not targets; `view` is the current one."""
    tools = context.scene.tool_settings
    kinds = {"move": tools.use_snap_translate, "rotate": tools.use_snap_rotate, "scale": tools.use_snap_scale}
    return Snap(
        elements=frozenset(tools.snap_elements),
        kinds=frozenset(kind for kind, snaps in kinds.items() if snaps),
        increments=_increments(context, tools),
        source=tools.snap_target,
        points=_source_points(context),
        active=active_point(context),
        cast=lambda pixel: _cast(context, view(), pixel, moving()),
    )


def _cast(context: bpy.types.Context, view: View | None, pixel: Pixel, moving: frozenset[str]) -> Hit | None:
    if view is None:
        return None
    near, far = view.unproject(pixel, -1.0), view.unproject(pixel, 1.0)
    found = stiv_blender.first_hit(context, near, far - near, moving)
    return None if found is None else Hit(*found)


def _increments(context: bpy.types.Context, tools: bpy.types.ToolSettings) -> Increments:
    scale = _grid_scale(context)
    turns = (
        getattr(tools, "snap_angle_increment_3d", math.radians(5.0)),
        getattr(tools, "snap_angle_increment_3d_precision", math.radians(1.0)),
    )
    return Increments(move=(scale, scale / 10.0), rotate=turns)


def _grid_scale(context: bpy.types.Context) -> float:
    """The grid unit of the view; in a parallel view, times the smallest power of ten that spans enough pixels."""
    space, data = context.space_data, context.region_data
    unit = float(getattr(getattr(space, "overlay", None), "grid_scale", 1.0)) or 1.0
    if data is None or data.is_perspective or context.region is None:
        return unit
    pixel = 2.0 / np.linalg.norm(np.array(data.perspective_matrix)[0, :3]) / max(context.region.width, 1)
    return float(unit * 10.0 ** math.ceil(math.log10(MIN_PIXELS * pixel / unit)))


def _source_points(context: bpy.types.Context) -> Vector:
    """Points of the selection that can move onto a target: corners of bounding boxes, or selected points."""
    if context.mode != "OBJECT":
        return selected_points(context)
    corners = [
        np.array(obj.matrix_world @ type(obj.location)(corner))
        for obj in context.selected_objects
        for corner in obj.bound_box
    ]
    return np.array(corners, dtype=float).reshape(-1, 3)


def read_proportional(context: bpy.types.Context) -> Proportional:
    """Proportional editing by the settings of the scene; available in Edit Mode."""
    tools = context.scene.tool_settings
    return Proportional(
        context.mode != "OBJECT",
        tools.use_proportional_edit,
        max(getattr(tools, _size_property(tools)), 1e-6),
        tools.proportional_edit_falloff,
        tools.use_proportional_connected,
    )


def store_proportional(context: bpy.types.Context, proportional: Proportional) -> None:
    """Store the settings at the end of a drag in the scene, as Blender's own transforms do."""
    if proportional.active:
        tools = context.scene.tool_settings
        setattr(tools, _size_property(tools), proportional.size)
        tools.proportional_edit_falloff = proportional.falloff


def _size_property(tools: bpy.types.ToolSettings) -> str:
    return "proportional_size" if hasattr(tools, "proportional_size") else "proportional_distance"


def unsupported_settings(context: bpy.types.Context) -> list[str]:
    """Notes for the header on settings of the scene that a drag does not support."""
    notes = []
    orientation = orientation_names(context)[0]
    if not is_supported(orientation):
        notes.append(translate("orientation {} is not supported; using Global").format(translate(orientation.title())))
    tools = context.scene.tool_settings
    if context.mode == "OBJECT" and tools.use_proportional_edit_objects:
        notes.append(translate("proportional editing of objects is not supported"))
    if context.mode != "OBJECT" and tools.use_proportional_edit:
        if tools.use_proportional_projected:
            notes.append(translate("projected proportional editing is not supported; using distance in space"))
        if tools.transform_pivot_point == "INDIVIDUAL_ORIGINS":
            notes.append(translate("Individual Origins are not supported with proportional editing; using the median"))
    return notes + _unsupported_snapping(tools)


def _unsupported_snapping(tools: bpy.types.ToolSettings) -> list[str]:
    others = sorted(set(tools.snap_elements) - SUPPORTED_ELEMENTS)
    if not others or not tools.use_snap:
        return []
    names = ", ".join(translate(name.replace("_", " ").title()) for name in others)
    return [translate("snapping to {} is not supported").format(names)]
