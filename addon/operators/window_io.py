# SPDX-License-Identifier: GPL-3.0-or-later
"""Between Blender's window and the plain data of a drag: events in, header and status bar out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import bpy

from ..modal.event import Event
from ..modal.header_texts import header_text, status_text
from ..modal.pointer import Pointer
from ..modal.state import State
from ..transform.frame import Frame
from ..translations import say

MODIFIERS = ("shift", "ctrl", "alt", "oskey")


def plain_event(event: bpy.types.Event, region: bpy.types.Region | None) -> Event:
    """An event with the pointer in pixels of the region that the drag began in."""
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
    """Stop the timer that `start_timer` made."""
    context.window_manager.event_timer_remove(timer)


def centre(frame: Frame) -> tuple[float, float] | None:
    """Where the pivot is seen; the middle of the region for one behind the viewer."""
    if frame.view is None:
        return None
    return frame.view.project(frame.pivot) or (frame.view.size[0] / 2.0, frame.view.size[1] / 2.0)


def pointer_seen_anew(pointer: Pointer, before: Frame, after: Frame) -> Pointer:
    """The pointer where the start and the pivot are seen in another view."""
    if before.view is None or after.view is None:
        return pointer
    start = after.view.project(before.view.beside(pointer.start, before.pivot))
    return pointer.seen_anew(start or pointer.start, centre(after))


def show(
    context: bpy.types.Context, state: State, value: str, verdict: str, notes: Sequence[str], axes: tuple[str, str]
) -> None:
    """Write header and status bar, and have the views drawn again."""
    text = header_text(state, value, verdict, notes, axes, say)
    for area in _views(context):
        area.header_text_set(text)
        area.tag_redraw()
    if context.workspace is not None:
        context.workspace.status_text_set(status_text(state, say))


def write_header(context: bpy.types.Context, text: str) -> None:
    """Write a line of text into the headers of the views."""
    for area in _views(context):
        area.header_text_set(text)
        area.tag_redraw()


def clear(context: bpy.types.Context) -> None:
    """Give header and status bar back."""
    for area in _views(context):
        area.header_text_set(None)
        area.tag_redraw()
    for workspace in bpy.data.workspaces:
        workspace.status_text_set(None)


def _views(context: bpy.types.Context) -> Iterator[bpy.types.Area]:
    """Every 3D view: the one of the drag may be another object by now, so none is remembered."""
    for window in context.window_manager.windows:
        yield from (area for area in window.screen.areas if area.type == "VIEW_3D")
