# SPDX-License-Identifier: GPL-3.0-or-later
"""Control points of curves and NURBS surfaces: read, selected and written, handles of Bezier curves included."""

from __future__ import annotations

import bpy
import numpy as np

from stiv.blender.scene.arrays import Flags, Indices, Singles, read_collection

HANDLES = ("handle_left", "co", "handle_right")
SELECTED = ("select_left_handle", "select_control_point", "select_right_handle")
CONTROLLED = frozenset({"FREE", "ALIGNED"})  # Blender computes all other handles from the points


def read_curve_points(curve: bpy.types.Curve) -> Singles:
    """Local positions of all points, (m, 3), spline after spline; of Bezier points left handle, point, right handle."""
    found = [np.empty((0, 3), np.float32)]
    for spline in curve.splines:
        if spline.type == "BEZIER":
            rows = [read_collection(spline.bezier_points, name, 3, np.float32) for name in HANDLES]
            found.append(np.stack(rows, axis=1).reshape(-1, 3))
        else:
            found.append(read_collection(spline.points, "co", 4, np.float32)[:, :3])
    return np.concatenate(found)


def spline_starts(curve: bpy.types.Curve) -> Indices:
    """The first point of each spline, and the number of all points, (s + 1,)."""
    sizes = [3 * len(each.bezier_points) if each.type == "BEZIER" else len(each.points) for each in curve.splines]
    return np.cumsum([0, *sizes]).astype(np.int32)


def spline_places(curve: bpy.types.Curve) -> Indices:
    """Number of the spline of each point, and its place along and across it, (m, 3); handles have places too."""
    starts = spline_starts(curve)
    found = [np.empty((0, 3), np.int32)]
    for number, (spline, count) in enumerate(zip(curve.splines, np.diff(starts), strict=True)):
        along = spline.point_count_u if spline.point_count_v > 1 else max(int(count), 1)
        place = np.arange(count, dtype=np.int32)
        found.append(np.stack([np.full_like(place, number), place % along, place // along], axis=1))
    return np.concatenate(found)


def selected_curve_points(curve: bpy.types.Curve) -> Flags:
    """Flags of the selected points, (m,). A selected Bezier point moves its handles too."""
    found = [np.empty(0, np.bool_)]
    for spline in curve.splines:
        if spline.type == "BEZIER":
            left, middle, right = (read_collection(spline.bezier_points, name, 1, np.bool_) for name in SELECTED)
            found.append(np.stack([left | middle, middle, right | middle], axis=1).ravel())
        else:
            found.append(read_collection(spline.points, "select", 1, np.bool_))
    return np.concatenate(found)


def select_curve_points(curve: bpy.types.Curve, chosen: Flags) -> None:
    """Select exactly the points with a flag, (m,)."""
    starts = spline_starts(curve)
    for spline, first, end in zip(curve.splines, starts[:-1], starts[1:], strict=True):
        if spline.type == "BEZIER":
            for place, name in enumerate(SELECTED):
                spline.bezier_points.foreach_set(name, np.ascontiguousarray(chosen[first + place : end : 3]))
        else:
            spline.points.foreach_set("select", chosen[first:end])


def movable_curve_points(curve: bpy.types.Curve) -> Flags:
    """Flags of the points that are not computed from others, (m,)."""
    found = [np.empty(0, np.bool_)]
    for spline in curve.splines:
        if spline.type == "BEZIER":
            found += [
                np.array([each.handle_left_type in CONTROLLED, True, each.handle_right_type in CONTROLLED])
                for each in spline.bezier_points
            ]
        else:
            found.append(np.ones(len(spline.points), np.bool_))
    return np.concatenate(found)


def write_curve_points(curve: bpy.types.Curve, points: Singles, handles: bool = True) -> None:
    """Write local positions of all points, (m, 3). handles: let Blender compute its handles, as after any edit."""
    first = 0
    for spline in curve.splines:
        if spline.type == "BEZIER":
            rows = points[first : first + 3 * len(spline.bezier_points)].reshape(-1, 3, 3)
            for place, name in enumerate(HANDLES):
                spline.bezier_points.foreach_set(name, np.ascontiguousarray(rows[:, place], np.float32).ravel())
            first += 3 * len(rows)
            if handles and len(rows):
                spline.bezier_points[0].co = spline.bezier_points[0].co
        else:
            stored = read_collection(spline.points, "co", 4, np.float32)
            stored[:, :3] = points[first : first + len(stored)]
            spline.points.foreach_set("co", stored.ravel())
            first += len(stored)
    curve.update_tag()
