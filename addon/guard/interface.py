# SPDX-License-Identifier: GPL-3.0-or-later
"""What the guard sees of Blender's window, and what the user sees of the guard."""

from __future__ import annotations

from typing import Any

import bpy

from ..wording import say

SHOWN = 6.0  # seconds for which the status bar keeps a message


def window() -> Any:
    """A window to work in; None where there is none."""
    windows = bpy.context.window_manager.windows
    return windows[0] if len(windows) else None


def is_busy() -> bool:
    """Does a tool or an animation run in any window?"""
    return any(
        len(each.modal_operators) > 0 or each.screen.is_animation_playing for each in bpy.context.window_manager.windows
    )


def tell(wrote: str, problem: str) -> None:
    """Say in the status bar what was corrected, or why that was not possible; have the sidebars drawn again."""
    _redraw_sidebars()
    text = problem or wrote
    if not text:
        return
    for workspace in bpy.data.workspaces:
        workspace.status_text_set(say("Live guard: {}").format(text))
    _forget_clearing()
    bpy.app.timers.register(clear_when_idle, first_interval=SHOWN)


def clear_when_idle() -> float | None:
    """Give the status bar back, unless a tool has it."""
    if is_busy():
        return 1.0
    for workspace in bpy.data.workspaces:
        workspace.status_text_set(None)
    return None


def clear() -> None:
    """Take a message away at once, if there is one."""
    if bpy.app.timers.is_registered(clear_when_idle):
        _forget_clearing()
        clear_when_idle()


def _forget_clearing() -> None:
    if bpy.app.timers.is_registered(clear_when_idle):
        bpy.app.timers.unregister(clear_when_idle)


def _redraw_sidebars() -> None:
    for each in bpy.context.window_manager.windows:
        for area in each.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
