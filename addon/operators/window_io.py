# SPDX-License-Identifier: GPL-3.0-or-later
"""Between Blender's window and the plain data of a drag: events in, header and status bar out."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import blf
import bpy

from ..modal.event import AXIS_BUTTON, WHEEL, Event
from ..modal.header_texts import fitted, header_parts, progress_text
from ..modal.key_hints import KeyHint, hints_that_fit, key_hints, stop_hints
from ..modal.pointer import Pointer
from ..modal.state import State
from ..scene.frame import view_areas
from ..transform.frame import Frame
from ..translations import translate

MODIFIERS = ("shift", "ctrl", "alt", "oskey")
ICON, GAP, MARGIN = 20, 20, 20  # pixels of an icon, after a hint, and beside a header's text, at scale 1
WIDE = frozenset({"EVENT_ESC", "EVENT_CTRL", "EVENT_BACKSPACE"})  # icons that reach over their right edge
NAVIGATION = WHEEL | {AXIS_BUTTON, "TRACKPADPAN"}


def plain_event(event: bpy.types.Event, region: bpy.types.Region | None) -> Event:
    """An event with the pointer in pixels of the region in which the drag began."""
    corner = (region.x, region.y) if region is not None else (0, 0)
    modifiers = frozenset(name for name in MODIFIERS if getattr(event, name))
    if event.type in NAVIGATION and not _navigates_with_alt():
        modifiers ^= {"alt"}
    return Event(
        type=event.type,
        value=event.value,
        mouse=(float(event.mouse_x - corner[0]), float(event.mouse_y - corner[1])),
        modifiers=modifiers,
        text=event.unicode,
        pan=float(event.mouse_y - event.mouse_prev_y) if event.type == "TRACKPADPAN" else 0.0,
    )


def press_position(event: bpy.types.Event, region: bpy.types.Region) -> tuple[float, float]:
    """The pixel of the region where a button was last pressed, before it was dragged."""
    return float(event.mouse_prev_press_x - region.x), float(event.mouse_prev_press_y - region.y)


def _navigates_with_alt() -> bool:
    """Blender's keymap preference: during a transform, the middle button and the wheel navigate with Alt only."""
    configuration = bpy.context.window_manager.keyconfigs.active
    return bool(getattr(getattr(configuration, "preferences", None), "use_alt_navigation", True))


def navigate(event: bpy.types.Event) -> None:
    """Turn, shift or zoom the view as the event would without Alt."""
    if event.type in WHEEL:
        bpy.ops.view3d.zoom(delta=1 if event.type in ("WHEELUPMOUSE", "WHEELINMOUSE") else -1)
    elif event.shift:
        bpy.ops.view3d.move("INVOKE_DEFAULT")
    elif event.ctrl:
        bpy.ops.view3d.zoom("INVOKE_DEFAULT")
    else:
        bpy.ops.view3d.rotate("INVOKE_DEFAULT")


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
    write_header(context, header_parts(state, value, status, notes, orientations, translate))
    write_keys(context, key_hints(state, translate))
    for area in view_areas(context):
        area.tag_redraw()


def show_progress(context: bpy.types.Context, fraction: float, label: str = "") -> None:
    """Write how far a solve is, from 0 to 1, and the key that stops it. Draws no scene. label: what is solved."""
    write_header(context, [*([label] if label else []), progress_text(fraction, translate)])
    write_keys(context, stop_hints(translate))


def write_header(context: bpy.types.Context, parts: Sequence[str]) -> None:
    """Write as many parts of a line as fit into the headers of the 3D views."""
    for area in view_areas(context):
        area.header_text_set(fitted(parts, functools.partial(_fits, area.width - 2 * MARGIN * _scale())))


def write_keys(context: bpy.types.Context, hints: Sequence[KeyHint]) -> None:
    """Draw key hints in the status bar, in place of Blender's own, as many as fit."""

    def draw(header: bpy.types.Header, context: bpy.types.Context) -> None:
        width = context.area.width if context.area is not None else context.window.width
        _draw_keys(header.layout, hints_that_fit(hints, width, lambda hint: _hint_width(hint)))

    if context.workspace is not None:
        context.workspace.status_text_set(draw)


def _draw_keys(layout: bpy.types.UILayout, hints: Sequence[KeyHint]) -> None:
    for hint in hints:
        row = layout.row(align=True)
        for icon in hint.icons:
            row.label(text="", icon=icon)
            if icon in WIDE:
                row.separator(factor=1.0)
        row.label(text=hint.label, translate=False)


def _hint_width(hint: KeyHint) -> float:
    """Pixels of a hint in the status bar, with the space after it."""
    wide = len(WIDE.intersection(hint.icons))
    return (len(hint.icons) * ICON + wide * ICON / 2 + GAP) * _scale() + _text_width(hint.label)


def _fits(width: float, text: str) -> bool:
    return _text_width(text) <= width


def _text_width(text: str) -> float:
    """Pixels of a text in the font of the interface."""
    blf.size(0, bpy.context.preferences.ui_styles[0].widget.points * _scale())
    return float(blf.dimensions(0, text)[0])


def _scale() -> float:
    return float(bpy.context.preferences.system.ui_scale)


def show_wait_cursor(context: bpy.types.Context, on: bool) -> None:
    """Show Blender's wait cursor in the window, or the former one."""
    if context.window is not None:
        context.window.cursor_modal_set("WAIT") if on else context.window.cursor_modal_restore()


def clear(context: bpy.types.Context) -> None:
    """Restore header and status bar."""
    for area in view_areas(context):
        area.header_text_set(None)
        area.tag_redraw()
    for workspace in bpy.data.workspaces:
        workspace.status_text_set(None)
