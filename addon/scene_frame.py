# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads from the context what a transform refers to: pivot, orientation, view."""

from __future__ import annotations

from typing import Any

import bmesh
import numpy as np

from .transform.frame import Frame, orthonormal
from .transform.pivot import pivot_of
from .transform.view import Vector, View


def read_frame(context: Any, *, orientation: str = "") -> Frame:
    """Pivot and axes of the scene's settings, and the view if the context has one.

    Args:
        context: Blender's context.
        orientation: "GLOBAL" or "LOCAL"; empty takes the scene's.

    """
    scene = context.scene
    pivot = pivot_of(
        _selected_points(context),
        scene.tool_settings.transform_pivot_point,
        cursor=np.array(scene.cursor.location),
        active=_active_point(context),
    )
    return Frame(pivot, _axes(context, orientation or scene_orientation(context)), _view(context))


def scene_orientation(context: Any) -> str:
    """Give "LOCAL" where the scene says so, otherwise "GLOBAL"."""
    return "LOCAL" if context.scene.transform_orientation_slots[0].type == "LOCAL" else "GLOBAL"


def notes(context: Any) -> list[str]:
    """Settings of the scene that a transform does not follow, for the header."""
    found = []
    if context.scene.tool_settings.transform_pivot_point == "INDIVIDUAL_ORIGINS":
        found.append("individual origins are not supported: about their median")
    chosen = context.scene.transform_orientation_slots[0].type
    if chosen not in {"GLOBAL", "LOCAL"}:
        found.append(f"orientation {chosen.title()} is not supported: global axes")
    return found


def _axes(context: Any, orientation: str) -> Vector:
    if orientation != "LOCAL" or context.active_object is None:
        return np.eye(3)
    return orthonormal(np.array(context.active_object.matrix_world)[:3, :3])


def _view(context: Any) -> View | None:
    region, data = context.region, context.region_data
    if region is None or data is None:
        return None
    return View(np.array(data.perspective_matrix), (max(region.width, 1), max(region.height, 1)))


def _selected_points(context: Any) -> Vector:
    if context.mode == "OBJECT":
        points = [np.array(thing.matrix_world.translation) for thing in context.selected_objects]
    else:
        points = [point for thing in context.objects_in_mode for point in _selected_inside(thing)]
    return np.array(points, dtype=float).reshape(-1, 3)


def _selected_inside(thing: Any) -> list[Vector]:
    """Selected vertices or lattice points of an object in Edit Mode, in world space."""
    if thing.type == "MESH":
        positions = [vertex.co for vertex in bmesh.from_edit_mesh(thing.data).verts if vertex.select]
    else:
        positions = [point.co_deform for point in thing.data.points if point.select]
    return [np.array(thing.matrix_world @ position) for position in positions]


def _active_point(context: Any) -> Vector | None:
    thing = context.active_object
    if thing is None:
        return None
    if context.mode == "OBJECT":
        return np.array(thing.matrix_world.translation)
    if thing.type != "MESH":
        return None
    active = bmesh.from_edit_mesh(thing.data).select_history.active
    vertices = getattr(active, "verts", [active]) if active is not None else []
    positions = [np.array(thing.matrix_world @ vertex.co) for vertex in vertices]
    return np.mean(positions, axis=0) if positions else None
