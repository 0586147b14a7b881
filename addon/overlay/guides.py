# SPDX-License-Identifier: GPL-3.0-or-later
"""The lines of Blender's own transforms: the axes of a constraint, and the circle of proportional editing."""

from __future__ import annotations

import traceback
from dataclasses import dataclass

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from ..modal.state import State
from ..scene.frame import view_areas
from ..scene.orientations import view_axes
from ..transform.frame import Frame
from .content import Floats

SEGMENTS = 64  # of the circle
WIDE, NARROW = 3.0, 1.0  # pixels: a dark line below a light one, visible over every colour
DARKER, LIGHTER = -20 / 255, 50 / 255  # than the grid, as Blender's circle


@dataclass(frozen=True)
class Guides:
    """Lines through the pivot, in world space.

    Attributes:
        pivot: (3,) position.
        axes: by the index of an axis, its direction (3,).
        radius: of the circle of proportional editing; None without one.
    """

    pivot: tuple[float, ...]
    axes: tuple[tuple[int, tuple[float, ...]], ...] = ()
    radius: float | None = None


_guides: Guides | None = None
_handle: object | None = None


def guides_of(state: State, frame: Frame) -> Guides | None:
    """The guides of a drag; None without a constraint and proportional editing."""
    directions = frame.axes_of(state.axis_lock)
    chosen = state.axis_lock.axes if state.axis_lock.axis is not None else ()
    axes = tuple((axis, tuple(directions[:, axis].tolist())) for axis in chosen)
    radius = state.proportional.size if state.proportional.active else None
    return Guides(tuple(frame.pivot.tolist()), axes, radius) if axes or radius else None


def shown() -> Guides | None:
    """The guides that are drawn."""
    return _guides


def show(guides: Guides | None) -> None:
    """Draw guides in all 3D views from now on; None removes them."""
    global _guides, _handle
    if guides == _guides:
        return
    _guides = guides
    if guides is not None and _handle is None and not bpy.app.background:
        _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW")
    elif guides is None and _handle is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
        _handle = None
    for area in view_areas(bpy.context):
        area.tag_redraw()


def axis_line(pivot: Floats, direction: Floats, length: float) -> Floats:
    """Both ends, (2, 3), of a line through the pivot."""
    return np.asarray(pivot) + length * np.array([[-1.0], [1.0]]) * np.asarray(direction)


def circle(pivot: Floats, radius: float, view: Floats) -> Floats:
    """Points, (n, 3), of a closed circle that faces the viewer. view: (3, 3) unit columns, as `view_axes`."""
    angles = np.linspace(0.0, 2.0 * np.pi, SEGMENTS + 1)
    return np.asarray(pivot) + radius * np.column_stack([np.cos(angles), np.sin(angles)]) @ view[:, :2].T


def _draw() -> None:
    global _guides
    try:
        if _guides is not None:
            _draw_guides(bpy.context, _guides)
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


def _draw_line(points: Floats, width: float, colour: Floats) -> None:
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    batch = batch_for_shader(shader, "LINE_STRIP", {"pos": points.astype("float32")})
    shader.bind()
    shader.uniform_float("color", (*np.clip(colour, 0.0, 1.0).tolist(), 1.0))
    gpu.state.line_width_set(width)
    batch.draw(shader)
