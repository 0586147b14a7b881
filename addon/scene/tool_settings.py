# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads snapping and proportional editing from the scene's tool settings, and names the settings not supported."""

from __future__ import annotations

import math
from collections.abc import Sequence

import bpy
import numpy as np

from .. import stiv_blender
from ..modal.proportional import Proportional
from ..modal.state import State
from ..transform.snap_search import SnapSearch
from ..transform.snapping import Increments, Snap
from ..transform.view import Vector
from ..translations import translate
from .frame import NO_POINTS, moved_objects, orientation_names, selected_active_point
from .orientations import is_supported

MIN_PIXELS = 12.0  # twice the pixels of the least step of a grid in a parallel view along an axis
IMPERIAL = ("thou", "in", "ft", "yd", "ch", "fur", "mi")


def read_snap(context: bpy.types.Context, selection: Sequence[Vector]) -> Snap:
    """Snapping of a drag. The targets are read when they are first needed, and stay as they are then.

    selection: of `read_selection`.
    """
    tools = context.scene.tool_settings
    return Snap(
        elements=_elements(tools),
        kinds=_kinds(tools),
        increments=_increments(context, tools),
        source=tools.snap_target,
        points=_source_points(context, selection),
        median=_median(selection),
        active=selected_active_point(context),
        whole=tools.use_snap_peel_object,
        nearest_steps=max(tools.snap_face_nearest_steps, 1),
        same_object=tools.use_snap_to_same_target,
        align=tools.use_snap_align_rotation and context.mode == "OBJECT",
        search=lambda elements: _search(context, elements, selected=False),
        search_base=lambda elements: _search(context, elements, selected=True),
    )


def snapping_kinds(context: bpy.types.Context) -> frozenset[str]:
    """The kinds of transform that snap without Ctrl."""
    tools = context.scene.tool_settings
    return _kinds(tools) if tools.use_snap else frozenset()


def store_snap(context: bpy.types.Context, state: State) -> None:
    """Store in the scene that Shift+Tab turned snapping on or off, as Blender's own transforms do."""
    tools = context.scene.tool_settings
    if state.kind in _kinds(tools) and state.base is None:
        tools.use_snap = state.kind in state.snap


def _kinds(tools: bpy.types.ToolSettings) -> frozenset[str]:
    kinds = {"move": tools.use_snap_translate, "rotate": tools.use_snap_rotate, "scale": tools.use_snap_scale}
    return frozenset(kind for kind, snaps in kinds.items() if snaps)


def _elements(tools: bpy.types.ToolSettings) -> frozenset[str]:
    elements = frozenset(tools.snap_elements)
    if getattr(tools, "use_snap_grid_absolute", False) and "INCREMENT" in elements:
        return elements - {"INCREMENT"} | {"GRID"}
    return elements


def _search(context: bpy.types.Context, elements: frozenset[str], *, selected: bool) -> SnapSearch:
    shading = getattr(context.space_data, "shading", None)
    return SnapSearch(
        stiv_blender.read_snap_targets(context, selected=selected),
        elements,
        culling=context.scene.tool_settings.use_snap_backface_culling or _culls(shading),
        occlusion=not _is_xray(shading),
        as_normals=bpy.app.version >= (5, 1, 0),
    )


def _culls(shading: bpy.types.View3DShading | None) -> bool:
    return shading is not None and shading.type == "SOLID" and shading.show_backface_culling


def _is_xray(shading: bpy.types.View3DShading | None) -> bool:
    if shading is None:
        return False
    if shading.type == "WIREFRAME":
        return bool(shading.show_xray_wireframe and shading.xray_alpha_wireframe < 1.0)
    return bool(shading.show_xray and shading.xray_alpha < 1.0)


def _increments(context: bpy.types.Context, tools: bpy.types.ToolSettings) -> Increments:
    scale = _grid_scale(context)
    turns = (
        getattr(tools, "snap_angle_increment_3d", math.radians(5.0)),
        getattr(tools, "snap_angle_increment_3d_precision", math.radians(1.0)),
    )
    return Increments(move=(scale, scale / 10.0), rotate=turns)


def _grid_scale(context: bpy.types.Context) -> float:
    """The grid unit of the view; in a parallel view along an axis, the smallest step that spans enough pixels."""
    space, data, units = context.space_data, context.region_data, context.scene.unit_settings
    grid = float(getattr(getattr(space, "overlay", None), "grid_scale", 1.0)) or 1.0
    steps, base = _grid_steps(units, grid, getattr(getattr(space, "overlay", None), "grid_subdivisions", 10))
    if data is None or data.is_perspective or context.region is None or not data.is_orthographic_side_view:
        return base
    least = MIN_PIXELS / (context.region.width * data.window_matrix[0][0])
    return next((step for step in steps if step > least), steps[-1])


def _grid_steps(units: bpy.types.UnitSettings, grid: float, subdivisions: int) -> tuple[list[float], float]:
    """Steps of a grid in a view along an axis, in increasing order, and the step in other views."""
    if units.system == "NONE":
        return [grid * float(subdivisions) ** power for power in range(-3, 5)], grid
    grid /= units.scale_length
    names = ("um", "mm", "cm", "dm", "m", "dam", "hm", "km") if units.system == "METRIC" else IMPERIAL
    base = "m" if units.system == "METRIC" else "ft"
    lengths = {name: float(bpy.utils.units.to_value(units.system, "LENGTH", f"1{name}")) for name in names}
    return [length * grid for length in lengths.values()], lengths[base] * grid


def _source_points(context: bpy.types.Context, selection: Sequence[Vector]) -> Vector:
    """Points of the selection that can move onto a target: corners of bounding boxes, or selected points."""
    if context.mode != "OBJECT":
        return np.concatenate([NO_POINTS, *selection])
    graph = context.evaluated_depsgraph_get()
    corners = [corner for obj in moved_objects(context) for corner in _corners(obj, obj.evaluated_get(graph))]
    return np.array(corners, dtype=float).reshape(-1, 3)


def _corners(obj: bpy.types.Object, evaluated: bpy.types.Object) -> list[Vector]:
    """Corners of the bounding box; the origin of an object without one."""
    matrix = np.array(obj.matrix_world)
    if obj.type in ("EMPTY", "LIGHT", "CAMERA", "SPEAKER", "LIGHT_PROBE"):
        return [matrix[:3, 3]]
    return [matrix[:3, :3] @ np.array(corner) + matrix[:3, 3] for corner in evaluated.bound_box]


def _median(selection: Sequence[Vector]) -> Vector | None:
    """The mean of the origins, or in Edit Mode of the medians of the objects; None without a selection."""
    medians = [points.mean(axis=0) for points in selection if len(points)]
    return np.asarray(np.mean(medians, axis=0)) if medians else None


def read_proportional(context: bpy.types.Context) -> Proportional:
    """Proportional editing by the settings of the scene; available in Edit Mode."""
    tools = context.scene.tool_settings
    return Proportional(
        context.mode.startswith("EDIT"),
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
    if context.mode.startswith("EDIT") and tools.use_proportional_edit:
        if tools.use_proportional_projected:
            notes.append(translate("projected proportional editing is not supported; using distance in space"))
        if tools.transform_pivot_point == "INDIVIDUAL_ORIGINS":
            notes.append(translate("Individual Origins are not supported with proportional editing; using the median"))
    if context.mode != "OBJECT" and tools.use_snap and tools.use_snap_align_rotation:
        notes.append(translate("aligning rotation to the snap target is not supported"))
    if context.mode == "POSE" and any(rig.pose.use_auto_ik for rig in context.objects_in_mode):
        notes.append(translate("Auto IK is not supported; add Inverse Kinematics"))
    return notes
