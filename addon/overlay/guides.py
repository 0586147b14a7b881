# SPDX-License-Identifier: GPL-3.0-or-later
"""The lines of Blender's own transforms: axes of a constraint, circle of proportional editing, line to the pointer."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from dataclasses import dataclass, replace

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from ..modal.state import State
from ..scene.frame import view_areas
from ..scene.orientations import view_axes
from ..transform.frame import Frame
from ..transform.view import Pixel
from .content import Floats

SEGMENTS = 64  # of the circle
WIDE, NARROW = 3.0, 1.0  # pixels: a dark line below a light one, visible over every colour
DASH = 8.0  # pixels of a dash and its gap, of equal length, at pixel size 1
MOST_DASHES = 4000  # a pivot beside the viewer is projected far outside the region
DARKER, LIGHTER = -20 / 255, 50 / 255  # than the grid, as Blender's circle


@dataclass(frozen=True)
class Guides:
    """Lines through the pivot.

    Attributes:
        pivot: (3,) position in world space.
        axes: by the index of an axis, its direction (3,).
        radius: of the circle of proportional editing; None without one.
        pointer_line: from the pivot to the pointer, in pixels of the region; None without one.
    """

    pivot: tuple[float, ...]
    axes: tuple[tuple[int, tuple[float, ...]], ...] = ()
    radius: float | None = None
    pointer_line: tuple[Pixel, Pixel] | None = None


_guides: Guides | None = None
_region = 0  # address of the drag's region; Blender may replace the region
_handles: list[object] = []


def guides_of(state: State, frame: Frame) -> Guides | None:
    """The guides of a drag; None if it has none."""
    directions = frame.axes_of(state.axis_lock)
    chosen = state.axis_lock.axes if state.axis_lock.axis is not None else ()
    axes = tuple((axis, tuple(directions[:, axis].tolist())) for axis in chosen)
    radius = state.proportional.size if state.proportional.active else None
    line = pointer_line(state)
    return Guides(tuple(frame.pivot.tolist()), axes, radius, line) if axes or radius or line else None


def pointer_line(state: State) -> tuple[Pixel, Pixel] | None:
    """The line from the pivot to the pointer while it rotates about the pivot, or scales by the distance to it."""
    if state.request.kind == "move" or state.trackball or state.pointer.centre is None:
        return None
    return state.pointer.centre, state.pointer.last


def shown() -> Guides | None:
    """The guides that are drawn."""
    return _guides


def show(guides: Guides | None, region: bpy.types.Region | None = None) -> None:
    """Draw guides in all 3D views from now on, the line to the pointer only in a region; None removes them."""
    global _guides, _region
    if guides == _guides:
        return
    before, _guides = _guides, guides
    _region = region.as_pointer() if region is not None else 0
    if guides is None:
        _remove_handlers()
    elif not _handles and not bpy.app.background:
        for draw, when in ((_draw_guides, "POST_VIEW"), (_draw_pointer_line, "POST_PIXEL")):
            _handles.append(bpy.types.SpaceView3D.draw_handler_add(_draw, (draw,), "WINDOW", when))
    if region is not None and _differ_in_pointer_line(before, guides):
        region.tag_redraw()
        return
    for area in view_areas(bpy.context):
        area.tag_redraw()


def _remove_handlers() -> None:
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")


def _differ_in_pointer_line(before: Guides | None, after: Guides | None) -> bool:
    """Is the line to the pointer the only difference?"""
    return before is not None and after is not None and replace(before, pointer_line=after.pointer_line) == after


def axis_line(pivot: Floats, direction: Floats, length: float) -> Floats:
    """Both ends, (2, 3), of a line through the pivot."""
    return np.asarray(pivot) + length * np.array([[-1.0], [1.0]]) * np.asarray(direction)


def circle(pivot: Floats, radius: float, view: Floats) -> Floats:
    """Points, (n, 3), of a closed circle that faces the viewer. view: (3, 3) unit columns, as `view_axes`."""
    angles = np.linspace(0.0, 2.0 * np.pi, SEGMENTS + 1)
    return np.asarray(pivot) + radius * np.column_stack([np.cos(angles), np.sin(angles)]) @ view[:, :2].T


def dashes(start: Pixel, end: Pixel, period: float) -> Floats:
    """Both ends of each dash of a line, (2 n, 2). period: pixels of a dash and its gap."""
    first, along = np.array(start), np.subtract(end, start)
    length = float(np.linalg.norm(along))
    if length == 0.0:
        return np.empty((0, 2))
    period = max(period, length / MOST_DASHES)
    begins = np.arange(0.0, length, period)
    distances = np.column_stack([begins, np.minimum(begins + period / 2, length)]).ravel()
    return np.asarray(first + distances[:, None] * (along / length))


def _draw(draw: Callable[[bpy.types.Context, Guides], None]) -> None:
    global _guides
    try:
        if _guides is not None:
            draw(bpy.context, _guides)
    except Exception:  # printed once, not at every redraw
        traceback.print_exc()
        _guides = None
    finally:
        gpu.state.line_width_set(NARROW)


def _draw_guides(context: bpy.types.Context, guides: Guides) -> None:
    theme = context.preferences.themes[0]
    pivot = np.array(guides.pivot)
    axes = theme.user_interface.axis_x, theme.user_interface.axis_y, theme.user_interface.axis_z
    for axis, direction in guides.axes:
        _draw_line(axis_line(pivot, np.array(direction), context.space_data.clip_end), NARROW, np.array(axes[axis]))
    if guides.radius is not None:
        points, grid = circle(pivot, guides.radius, view_axes(context)), np.array(theme.view_3d.grid[:3])
        _draw_line(points, WIDE, grid + DARKER)
        _draw_line(points, NARROW, grid + LIGHTER)


def _draw_pointer_line(context: bpy.types.Context, guides: Guides) -> None:
    if guides.pointer_line is None or context.region.as_pointer() != _region:
        return
    points = dashes(*guides.pointer_line, DASH * context.preferences.system.pixel_size)
    colour = np.array(context.preferences.themes[0].view_3d.view_overlay)
    _draw_line(np.pad(points, ((0, 0), (0, 1))), NARROW, colour, kind="LINES")


def _draw_line(points: Floats, width: float, colour: Floats, kind: str = "LINE_STRIP") -> None:
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    batch = batch_for_shader(shader, kind, {"pos": points.astype("float32")})
    shader.bind()
    shader.uniform_float("color", (*np.clip(colour, 0.0, 1.0).tolist(), 1.0))
    gpu.state.line_width_set(width)
    batch.draw(shader)
