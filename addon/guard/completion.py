# SPDX-License-Identifier: GPL-3.0-or-later
"""Completes the undo step of an edit mode after objects were copied there for an evaluation, once nothing runs."""

from __future__ import annotations

import sys

import bpy
from bpy.app.handlers import persistent

from .. import native_module, stiv_blender
from . import alerts, undo_steps, watcher

INTERVAL = 0.02  # seconds between two looks while something runs

_is_due = False


def copied() -> None:
    """Called when objects are copied: complete the step when nothing runs, for the undo of the next tool."""
    global _is_due
    _is_due = True
    _start_timer()


def completed() -> None:
    """Called when the step was completed after all copies."""
    global _is_due
    _is_due = False


def register() -> None:
    """Follow the copies, once the native module is loaded."""
    native_module.when_loaded(lambda: stiv_blender.on_copies(copied))
    for handlers in (bpy.app.handlers.undo_post, bpy.app.handlers.redo_post):
        handlers.append(_on_history)


def unregister() -> None:
    """Follow them no more."""
    for handlers in (bpy.app.handlers.undo_post, bpy.app.handlers.redo_post):
        handlers.remove(_on_history)
    package = sys.modules.get("stiv.blender")
    if package is not None:
        package.on_copies(None)
    if bpy.app.timers.is_registered(_complete):
        bpy.app.timers.unregister(_complete)


@persistent
def _on_history(*_unused: object) -> None:
    """The last step can be completed, which others before it could not."""
    if _is_due:
        _start_timer()


def _start_timer() -> None:
    if not bpy.app.background and not bpy.app.timers.is_registered(_complete):
        bpy.app.timers.register(_complete, first_interval=0.0)


def _complete() -> float | None:
    """Timer: returns seconds until the next call, None for no further call."""
    if not _is_due:
        return None
    if alerts.is_busy() or watcher.is_working():
        return INTERVAL
    for window in bpy.context.window_manager.windows:
        with bpy.context.temp_override(window=window):
            if bpy.context.mode.startswith("EDIT"):
                _complete_in(window)
                return None
    completed()
    return None


def _complete_in(window: bpy.types.Window) -> None:
    before = undo_steps.active_step()
    if undo_steps.complete_last(window):
        completed()
    watcher.step_replaced(before)
