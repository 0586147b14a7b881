# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's undo stack: the active step, and storing the current state in it."""

from __future__ import annotations

import ctypes
import os
import re
import sys
import tempfile

import bpy

from .decision import UndoStep

# A line of the list as Blender prints it, the only access to it:
# "[*#M ]   2 {0x5645b489f9f8} type='Global Undo', name='Move'"
_ACTIVE = re.compile(r"^\[\*[^]]*\]\s*(\d+) \{(\w+)\} type='([^']*)', name='(.*)'\r?$", re.MULTILINE)
_LATER = re.compile(r"^\[\*.*^\[[^S\]]*\]", re.MULTILINE | re.DOTALL)  # a step after the active one that can be redone
# Before the active step, one that Blender skips: the whole file at the same time.
_COMPLETE = re.compile(r"^\[[^*\]]*S\][^\n]*type='Global Undo'[^\n]*\n\[\*", re.MULTILINE)


def active_step() -> UndoStep | None:
    """The active step; None if undo is off or standard output cannot be redirected."""
    return parse(_stack())


def complete_active(window: bpy.types.Window) -> None:
    """Store the whole file in the active step, if that is a step of an edit mode, which holds the edited data alone.

    Data-blocks that come or go, as copies for an evaluation do, let Blender store the whole file with its next step. To
    undo that one then loads the file of an older step, without what has changed since, such as a modifier's settings.
    """
    _complete(window, _stack())


def complete_last(window: bpy.types.Window) -> bool:
    """`complete_active`, unless the step is complete.

    False if steps could be redone: Blender would drop them.
    """
    text = _stack()
    if _COMPLETE.search(text):
        return True
    if _LATER.search(text):
        return False
    _complete(window, text)
    return True


def add_start() -> None:
    """Add a step like the active one if that is not complete: an operator with a step of its own cannot replace it."""
    text = _stack()
    found = _incomplete(text)
    if found is not None and not _COMPLETE.search(text):
        store_file_next()
        push(bpy.context.window or bpy.context.window_manager.windows[0], found[4])


def store_file_next() -> None:
    """Let Blender store the whole file before its next step of an edit mode."""
    bpy.data.texts.remove(bpy.data.texts.new("STIV"))


def parse(text: str) -> UndoStep | None:
    """The active step of a printed list."""
    found = _ACTIVE.search(text)
    return None if found is None else (int(found[1]), found[2], found[4])


def replace_active(window: bpy.types.Window, name: str) -> None:
    """Store the current state in the active step, which has this name.

    A grouped operator replaces the previous step if that has the name of the group.
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
    """Add a step with the current state."""
    with bpy.context.temp_override(window=window):
        bpy.ops.ed.undo_push(message=name)


def _complete(window: bpy.types.Window, text: str) -> None:
    found = _incomplete(text)
    if found is not None:
        store_file_next()
        replace_active(window, found[4])


def _incomplete(text: str) -> re.Match[str] | None:
    """The active step, if that is a step of an edit mode."""
    found = _ACTIVE.search(text)
    return None if found is None or found[3] == "Global Undo" else found


def _stack() -> str:
    """All steps as Blender prints them; "" if undo is off."""
    windows = bpy.context.window_manager.windows
    if not len(windows):
        return ""
    with bpy.context.temp_override(window=windows[0]):
        has_stack = bpy.ops.ed.undo.poll()  # without a stack, as in background mode, printing it crashes
    return _printed() if has_stack else ""


def _printed() -> str:
    sys.stdout.flush()
    try:
        saved = os.dup(1)
    except OSError:
        return ""
    with tempfile.TemporaryFile() as file:
        os.dup2(file.fileno(), 1)
        try:
            bpy.context.window_manager.print_undo_steps()
            _flush()
        finally:
            os.dup2(saved, 1)
            os.close(saved)
        file.seek(0)
        return file.read().decode(errors="replace")


def _flush() -> None:
    """Flush the C library's buffer, which Python's own flush does not reach."""
    # Blender and Python use the universal C runtime. The older msvcrt has buffers of its own.
    ctypes.CDLL("ucrtbase" if sys.platform == "win32" else None).fflush(None)
