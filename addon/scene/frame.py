# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the frame of a transform from the context: pivot, orientation, view."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import chain

import bmesh
import bpy
import numpy as np

from .. import stiv_blender
from ..transform.frame import Frame, pivot_of
from ..transform.view import Vector, View
from .orientations import axes_of

NO_POINTS = np.empty((0, 3))
LENS_TOLERANCE = 1e-3  # of a view's matrix, which Blender stores in single precision


def read_frame(context: bpy.types.Context, selection: Sequence[Vector] | None = None) -> Frame:
    """Pivot and axes by the settings of the scene, and the view if the context has one.

    selection: of `read_selection`, if it has been read.
    """
    scene = context.scene
    choice = scene.tool_settings.transform_pivot_point
    points = np.concatenate([NO_POINTS, *(read_selection(context) if selection is None else selection)])
    pivot = pivot_of(points, choice, cursor=np.array(scene.cursor.location), active=active_point(context))
    first, second = (axes_of(context, name) for name in orientation_names(context))
    return Frame(pivot, first, _view(context), second, individual=choice == "INDIVIDUAL_ORIGINS")


def orientation_names(context: bpy.types.Context) -> tuple[str, str]:
    """The orientation of the scene, and that of an axis key pressed twice."""
    chosen = context.scene.transform_orientation_slots[0].type
    return chosen, "LOCAL" if chosen == "GLOBAL" else "GLOBAL"


def frame_in_new_view(context: bpy.types.Context, frame: Frame) -> Frame:
    """The frame with the current view; the same object if nobody has changed the view."""
    view = _view(context)
    if view is None or frame.view is None:
        return frame
    same = view.size == frame.view.size and np.array_equal(view.projection, frame.view.projection)
    return frame if same or _only_camera_moved(context, frame.view) else replace(frame, view=view)


def _only_camera_moved(context: bpy.types.Context, before: View) -> bool:
    """Has the view's camera moved, with the same lens? It may follow the selection, which must not chase it.

    Navigation zooms, which changes the lens, or leaves the camera, unless that is locked to the view.
    """
    data = context.region_data
    if data.view_perspective != "CAMERA" or context.space_data.lock_camera:
        return False
    placed = np.linalg.inv(np.array(data.window_matrix)) @ before.projection  # rigid, if the lens is the same
    rigid = np.allclose(placed[:3, :3] @ placed[:3, :3].T, np.eye(3), atol=LENS_TOLERANCE)
    return bool(rigid and np.allclose(placed[3], (0.0, 0.0, 0.0, 1.0), atol=LENS_TOLERANCE))


def _view(context: bpy.types.Context) -> View | None:
    region, data = context.region, context.region_data
    if region is None or data is None:
        return None
    return View(np.array(data.perspective_matrix), (max(region.width, 1), max(region.height, 1)))


def view_areas(context: bpy.types.Context) -> Iterator[bpy.types.Area]:
    """The areas of all 3D views. No reference to an area is stored, since Blender may replace it."""
    for window in context.window_manager.windows:
        yield from (area for area in window.screen.areas if area.type == "VIEW_3D")


def read_selection(context: bpy.types.Context) -> list[Vector]:
    """Of each object, its origin or its selected vertices or points, (k, 3) in world space."""
    if context.mode == "OBJECT":
        return [np.array([obj.matrix_world.translation], float) for obj in moved_objects(context)]
    return [_selected_elements(obj) for obj in context.objects_in_mode]


def moved_objects(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected objects, without those that follow a selected parent."""

    def follows(parent: bpy.types.Object | None) -> bool:
        return parent is not None and (parent.select_get() or follows(parent.parent))

    return [obj for obj in context.selected_objects if not follows(obj.parent)]


def _selected_elements(obj: bpy.types.Object) -> Vector:
    """Selected vertices or points of an object in Edit Mode or Pose Mode, (k, 3) in world space."""
    positions: Iterable[Iterable[float]]
    if obj.type == "ARMATURE":
        positions = (bone.head for bone in stiv_blender.moved_bones(obj))
    elif obj.type == "MESH":
        positions = (vertex.co for vertex in bmesh.from_edit_mesh(obj.data).verts if vertex.select)
    elif obj.type in {"CURVE", "SURFACE"}:
        positions = (position for spline in obj.data.splines for position in _selected_on(spline))
    else:
        positions = stiv_blender.read_selected_lattice_points(obj.data).tolist()
    matrix = np.array(obj.matrix_world)
    local = np.fromiter(chain.from_iterable(positions), float).reshape(-1, 3)
    return np.asarray(np.einsum("ij,kj->ik", local, matrix[:3, :3]) + matrix[:3, 3])


def _selected_on(spline: bpy.types.Spline) -> Iterator[tuple[float, ...]]:
    """Positions of the selected points of a curve; of Bezier points, or of their handles that are selected alone."""
    yield from (point.co[:3] for point in spline.points if point.select)
    for point in spline.bezier_points:
        if point.select_control_point:
            yield point.co[:]
            continue
        if point.select_left_handle:
            yield point.handle_left[:]
        if point.select_right_handle:
            yield point.handle_right[:]


def active_point(context: bpy.types.Context) -> Vector | None:
    """The origin of the active object, or the centre of the active element in Edit Mode; None without one."""
    obj = context.active_object
    if obj is None:
        return None
    if context.mode == "OBJECT":
        return np.array(obj.matrix_world.translation)
    if context.mode == "POSE":
        bone = context.active_pose_bone
        return None if bone is None else np.array(obj.matrix_world @ bone.head)
    if obj.type != "MESH":
        return None
    active = bmesh.from_edit_mesh(obj.data).select_history.active
    vertices = getattr(active, "verts", [active]) if active is not None else []
    positions = [np.array(obj.matrix_world @ vertex.co) for vertex in vertices]
    return np.asarray(np.mean(positions, axis=0)) if positions else None


def selected_active_point(context: bpy.types.Context) -> Vector | None:
    """The active point if it is selected; None otherwise."""
    obj = context.active_object
    return active_point(context) if obj is not None and (context.mode != "OBJECT" or obj.select_get()) else None
