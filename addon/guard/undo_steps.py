# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's undo stack: which step is active, and putting the present state into it."""

from __future__ import annotations

import ctypes
import os
import re
import sys
import tempfile

import bpy

from .decision import UndoStep

# The list as Blender prints it, the only way it gives it: "[*#M ]   2 {0x5645b489f9f8} type='Global Undo', name='Move'"
_ACTIVE = re.compile(r"^\[\*[^]]*\]\s*(\d+) \{(\w+)\} type='[^']*', name='(.*)'$", re.MULTILINE)


def active_step() -> UndoStep | None:
    """The active step; None where undo is off or standard output cannot be redirected."""
    windows = bpy.context.window_manager.windows
    if not len(windows):
        return None
    with bpy.context.temp_override(window=windows[0]):
        has_stack = bpy.ops.ed.undo.poll()  # without one, as after loading a file without a window, printing crashes
    return parse(_printed()) if has_stack else None


def parse(text: str) -> UndoStep | None:
    """The active step of a printed list."""
    found = _ACTIVE.search(text)
    return None if found is None else (int(found[1]), found[2], found[3])


def replace_active(window: bpy.types.Window, name: str) -> None:
    """Let the active step, which has this name, hold the present state.

    A grouped operator replaces the step before it where that carries the group's name.
    """
    operator = type(
        "STIV_OT_guard_step",
        (bpy.types.Operator,),
        {
            "__doc__": "Correct the last tool's result",
            "bl_idname": "stiv.guard_step",
            "bl_label": "Live Guard",
            "bl_options": {"UNDO_GROUPED", "INTERNAL"},
            "bl_undo_group": name,
            "execute": lambda self, context: {"FINISHED"},
        },
    )
    bpy.utils.register_class(operator)
    try:
        with bpy.context.temp_override(window=window):
            bpy.ops.stiv.guard_step("EXEC_DEFAULT", True)
    finally:
        bpy.utils.unregister_class(operator)


def push(window: bpy.types.Window, name: str) -> None:
    """Add a step that holds the present state."""
    with bpy.context.temp_override(window=window):
        bpy.ops.ed.undo_push(message=name)


def _printed() -> str:
    sys.stdout.flush()
    try:
        kept = os.dup(1)
    except OSError:
        return ""
    with tempfile.TemporaryFile() as file:
        os.dup2(file.fileno(), 1)
        try:
            bpy.context.window_manager.print_undo_steps()
            _flush()
        finally:
            os.dup2(kept, 1)
            os.close(kept)
        file.seek(0)
        return file.read().decode(errors="replace")


def _flush() -> None:
    """Have the C library write what it holds back; Python's own flush does not reach it."""
    try:
        ctypes.CDLL(None).fflush(None)
    except (OSError, TypeError, AttributeError):  # no such thing as the process's own symbols: Windows
        ctypes.cdll.msvcrt.fflush(None)
