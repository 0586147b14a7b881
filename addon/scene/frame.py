# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads from the context what a transform refers to: pivot, orientation, view."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import bmesh
import numpy as np

from ..transform.frame import Frame, pivot_of
from ..transform.view import Vector, View
from . import orientations


def read_frame(context: Any) -> Frame:
    """Pivot and axes of the scene's settings, and the view if the context has one."""
    scene = context.scene
    choice = scene.tool_settings.transform_pivot_point
    pivot = pivot_of(
        selected_points(context), choice, cursor=np.array(scene.cursor.location), active=active_point(context)
    )
    first, second = (orientations.axes_of(context, name) for name in orientation_names(context))
    return Frame(pivot, first, _view(context), second, individual=choice == "INDIVIDUAL_ORIGINS")


def orientation_names(context: Any) -> tuple[str, str]:
    """The scene's orientation, and the one that an axis key pressed twice takes."""
    chosen = context.scene.transform_orientation_slots[0].type
    return chosen, "LOCAL" if chosen == "GLOBAL" else "GLOBAL"


def frame_in_new_view(context: Any, frame: Frame) -> Frame:
    """The frame in the view as it is now; the same object if the view has not changed."""
    view = _view(context)
    if view is None or frame.view is None:
        return frame
    same = view.size == frame.view.size and np.array_equal(view.projection, frame.view.projection)
    return frame if same else replace(frame, view=view)


def _view(context: Any) -> View | None:
    region, data = context.region, context.region_data
    if region is None or data is None:
        return None
    return View(np.array(data.perspective_matrix), (max(region.width, 1), max(region.height, 1)))


def selected_points(context: Any) -> Vector:
    """Origins of the selected objects, or the selected vertices or lattice points, (k, 3) in world space."""
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


def active_point(context: Any) -> Vector | None:
    """The origin of the active object, or the middle of the active element in Edit Mode; None where there is none."""
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
