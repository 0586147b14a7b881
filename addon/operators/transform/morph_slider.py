# SPDX-License-Identifier: GPL-3.0-or-later
"""The slider of the active shape key in the panel: while it is dragged, the value stops where surfaces touch."""

from __future__ import annotations

import time
from dataclasses import dataclass

import bpy

from ... import stiv_blender
from ...scene.edit_settings import edit_settings
from ...translations import translate_error
from ..reports import error_text

BUDGET = 0.1  # seconds of a solve: the field waits for it
KEPT = 2.0  # seconds without a change after which the next one reads the scene again


@dataclass
class _Dragged:
    """The edit of the slider that was moved last, with the values that it wrote."""

    owner: str
    key: str
    edit: stiv_blender.MorphEdit
    used: float


_dragged: _Dragged | None = None


def get_value(self: bpy.types.PropertyGroup) -> float:
    """The value of the object's active shape key."""
    key = self.id_data.active_shape_key
    return 0.0 if key is None else float(key.value)


def set_value(self: bpy.types.PropertyGroup, value: float) -> None:
    """Move the value of the active shape key toward another one. The panel shows an error."""
    global _dragged
    ob, context = self.id_data, bpy.context
    if ob.active_shape_key is None:
        return
    goal = {ob.name: {ob.active_shape_key.name: value}}
    try:
        edit = _kept_edit(ob) or stiv_blender.MorphEdit.begin(context, goal, edit_settings(context.scene))
        edit.advance(edit.goals(goal), BUDGET)
        edit.show()
    except Exception as error:  # a property cannot raise: Blender would only print it
        _dragged = None
        context.window_manager.stiv_check.summary = error_text(error)
        return
    edit.insert_keyframes(context)
    if note := edit.torn_seam_note:
        context.window_manager.stiv_check.summary = translate_error(note)
    _dragged = _Dragged(ob.name, ob.active_shape_key.name, edit, time.monotonic())


def forget() -> None:
    """Delete the edit of the last drag."""
    global _dragged
    _dragged = None


def _kept_edit(ob: bpy.types.Object) -> stiv_blender.MorphEdit | None:
    """The edit of the last change, if it is recent and nothing else has written the value since."""
    last = _dragged
    if last is None or (last.owner, last.key) != (ob.name, ob.active_shape_key.name):
        return None
    is_recent = time.monotonic() - last.used < KEPT
    return last.edit if is_recent and last.edit.is_shown() else None
