# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages of the guard: in the status bar, over the view and in the sidebar."""

from __future__ import annotations

import bpy

from ..overlay import display
from ..scene.frame import view_areas
from ..translations import translate
from .problem import Problem

DURATION = 6.0  # seconds for which the status bar shows a correction

_alert = ""  # text of the status bar while the scene intersects


def is_busy() -> bool:
    """Whether a tool or an animation runs in any window."""
    return any(
        len(each.modal_operators) > 0 or each.screen.is_animation_playing for each in bpy.context.window_manager.windows
    )


def show(context: bpy.types.Context, correction: str, problem: Problem | None) -> None:
    """Show a correction in the status bar for a while; or a problem in status bar, view and sidebar until resolved.

    Known intersections show only in the header and the sidebar.
    """
    global _alert
    if problem is not None and problem.known:
        problem = None
    for area in view_areas(context):
        area.tag_redraw()
    _show_in_view(context, problem)
    if problem is not None:
        _cancel_clearing()
        _alert = translate("Live guard: {}").format(problem.headline(translate))
        _set_status(draw_alert)
    elif correction:
        _cancel_clearing()
        _alert = ""
        _set_status(translate("Live guard: {}").format(correction))
        bpy.app.timers.register(clear_when_idle, first_interval=DURATION)
    elif _alert:
        clear()


def draw_alert(header: bpy.types.Header, context: bpy.types.Context) -> None:
    """The status bar while the scene intersects: the alert in red with a button, then Blender's own contents."""
    row = header.layout.row(align=True)
    row.alert = True
    row.label(text=_alert, icon="ERROR")
    row.operator("stiv.guard_revert")
    type(header)._draw_orig(header, context)  # where Blender stores the function that this one replaces


def clear_when_idle() -> float | None:
    """Restore the status bar, unless a tool uses it."""
    if is_busy():
        return 1.0
    _set_status(None)
    return None


def clear() -> None:
    """Remove any message at once."""
    global _alert
    if _alert or bpy.app.timers.is_registered(clear_when_idle):
        _alert = ""
        _cancel_clearing()
        _set_status(None)
    display.show_alert(())


def _set_status(content: object) -> None:
    """Set a text, a function that draws, or None for Blender's own contents."""
    for workspace in bpy.data.workspaces:
        workspace.status_text_set(content)


def _show_in_view(context: bpy.types.Context, problem: Problem | None) -> None:
    if problem is None:
        display.show_alert(())
        return
    display.show_pairs(context, problem.pairs)
    display.show_alert((problem.headline(translate), *problem.pair_lines(translate)))


def _cancel_clearing() -> None:
    if bpy.app.timers.is_registered(clear_when_idle):
        bpy.app.timers.unregister(clear_when_idle)
