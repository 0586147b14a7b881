# SPDX-License-Identifier: GPL-3.0-or-later
"""What the guard sees of Blender's window, and what the user sees of the guard."""

from __future__ import annotations

from typing import Any

import bpy

from ..overlay import display
from ..translations import say
from .problem import Problem

SHOWN = 6.0  # seconds for which the status bar keeps what was corrected

_alert = ""  # what the status bar says of an intersecting scene, until that is solved


def window() -> Any:
    """A window to work in; None where there is none."""
    windows = bpy.context.window_manager.windows
    return windows[0] if len(windows) else None


def is_busy() -> bool:
    """Does a tool or an animation run in any window?"""
    return any(
        len(each.modal_operators) > 0 or each.screen.is_animation_playing for each in bpy.context.window_manager.windows
    )


def tell(context: Any, wrote: str, problem: Problem | None) -> None:
    """Say what was corrected, for a while in the status bar; or, until it is solved, what intersects.

    That stands in the status bar and over the view in red, and in the sidebar.
    """
    global _alert
    _redraw_sidebars()
    _show_in_view(context, problem)
    if problem is not None:
        _forget_clearing()
        _alert = say("Live guard: {}").format(problem.headline(say))
        _set_status(draw_alert)
    elif wrote:
        _forget_clearing()
        _alert = ""
        _set_status(say("Live guard: {}").format(wrote))
        bpy.app.timers.register(clear_when_idle, first_interval=SHOWN)
    elif _alert:
        clear()


def draw_alert(header: Any, context: Any) -> None:
    """The status bar while something intersects: that in red with the way back, then what else Blender shows there."""
    row = header.layout.row(align=True)
    row.alert = True
    row.label(text=_alert, icon="ERROR")
    row.operator("stiv.guard_revert")
    type(header)._draw_orig(header, context)  # kept by Blender when a function takes its place


def clear_when_idle() -> float | None:
    """Give the status bar back, unless a tool has it."""
    if is_busy():
        return 1.0
    _set_status(None)
    return None


def clear() -> None:
    """Take a message away at once, if there is one."""
    global _alert
    if _alert or bpy.app.timers.is_registered(clear_when_idle):
        _alert = ""
        _forget_clearing()
        _set_status(None)
    display.show_alert(())


def _set_status(content: Any) -> None:
    """A text, a function that draws, or None for what Blender shows."""
    for workspace in bpy.data.workspaces:
        workspace.status_text_set(content)


def _show_in_view(context: Any, problem: Problem | None) -> None:
    if problem is None:
        display.show_alert(())
        return
    display.show_pairs(context, problem.pairs)
    display.show_alert((problem.headline(say), *problem.pair_lines(say)))


def _forget_clearing() -> None:
    if bpy.app.timers.is_registered(clear_when_idle):
        bpy.app.timers.unregister(clear_when_idle)


def _redraw_sidebars() -> None:
    for each in bpy.context.window_manager.windows:
        for area in each.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
