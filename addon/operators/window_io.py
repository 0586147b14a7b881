# SPDX-License-Identifier: GPL-3.0-or-later
"""Between Blender's window and the plain data of a drag: events in, header and status bar out."""

from __future__ import annotations

from collections.abc import Sequence

import bpy

from ..modal.event import Event
from ..modal.header_texts import header_text, status_text
from ..modal.pointer import Pointer
from ..modal.state import State
from ..scene.frame import view_areas
from ..transform.frame import Frame
from ..translations import translate

MODIFIERS = ("shift", "ctrl", "alt", "oskey")


def plain_event(event: bpy.types.Event, region: bpy.types.Region | None) -> Event:
    """An event with the pointer in pixels of the region in which the drag began."""
    corner = (region.x, region.y) if region is not None else (0, 0)
    return Event(
        type=event.type,
        value=event.value,
        mouse=(float(event.mouse_x - corner[0]), float(event.mouse_y - corner[1])),
        modifiers=frozenset(name for name in MODIFIERS if getattr(event, name)),
        text=event.unicode,
    )


def start_timer(context: bpy.types.Context, step: float) -> bpy.types.Timer:
    """Timer events every `step` seconds, until `stop_timer`."""
    return context.window_manager.event_timer_add(step, window=context.window)


def stop_timer(context: bpy.types.Context, timer: bpy.types.Timer) -> None:
    """Stop a timer of `start_timer`."""
    context.window_manager.event_timer_remove(timer)


def centre(frame: Frame) -> tuple[float, float] | None:
    """The pixel of the pivot; the centre of the region if the pivot is behind the viewer; None without a view."""
    if frame.view is None:
        return None
    return frame.view.project(frame.pivot) or (frame.view.size[0] / 2.0, frame.view.size[1] / 2.0)


def pointer_in_new_view(pointer: Pointer, before: Frame, after: Frame) -> Pointer:
    """The pointer with its start and the pivot in another view."""
    if before.view is None or after.view is None:
        return pointer
    start = after.view.project(before.view.at_depth_of(pointer.start, before.pivot))
    return pointer.in_new_view(start or pointer.start, centre(after))


def show(
    context: bpy.types.Context,
    state: State,
    value: str,
    status: str,
    notes: Sequence[str],
    orientations: tuple[str, str],
) -> None:
    """Write header and status bar, and redraw the views."""
    write_header(context, header_text(state, value, status, notes, orientations, translate))
    if context.workspace is not None:
        context.workspace.status_text_set(status_text(state, translate))


def write_header(context: bpy.types.Context, text: str | None) -> None:
    """Write a line into the headers of the 3D views; None restores them."""
    for area in view_areas(context):
        area.header_text_set(text)
        area.tag_redraw()


def clear(context: bpy.types.Context) -> None:
    """Restore header and status bar."""
    write_header(context, None)
    for workspace in bpy.data.workspaces:
        workspace.status_text_set(None)
