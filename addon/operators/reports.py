# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports of results and errors to the user."""

from __future__ import annotations

import traceback
from collections import deque

import bpy

from .. import stiv_blender
from ..intersection_texts import LENGTH, brief, short_name
from ..modal.drag_loop import DragEnded, restore_after_error
from ..modal.header_texts import result_text
from ..translations import translate, translate_error
from ..units import length_text

last_messages: deque[str] = deque(maxlen=10)  # for the report that a user copies into an issue


def say(operator: bpy.types.Operator, kind: str, text: str) -> None:
    """Report a message of a kind ("INFO", "WARNING", "ERROR"), and remember it."""
    last_messages.append(f"{type(operator).__name__}: {kind}: {text}")
    operator.report({kind}, text)


def outcome_text(result: stiv_blender.EditResult, edit: stiv_blender.Edit | None = None) -> str:
    """The status of a result, with the names of blocking objects, or why none is named. edit: of the result."""
    if stiv_blender.is_cut_by_topology(result):
        return translate("blocked: the topology changes here")
    if result.status == "blocked" and not result.blocking and edit is not None and edit.keeps_intersections:
        return translate("blocked: intersecting surfaces may only part")
    return result_text(result.status, tuple(result.blocking), translate)


def write_failure(report: stiv_blender.WriteReport | None) -> str:
    """Why the accepted state could not be written; empty if it was, or if nothing was written yet."""
    return "" if report is None or report.passed else translate_error(report.message)


def left_out_text(context: bpy.types.Context, edit: stiv_blender.Edit, *notes: str) -> str:
    """The message on exceptions from the guarantee: faces at joints and torn seams, and objects that the next frame
    resets; and notes of the start.
    """
    reset_note = "" if context.scene.tool_settings.use_keyframe_insert_auto else edit.reset_note
    found = (edit.fold_note, edit.torn_seam_note, reset_note, *notes)
    return "; ".join(map(translate_error, filter(None, found)))


def report_outcome(operator: bpy.types.Operator, outcome: str, failure: str, left_out: str = "") -> None:
    """Report the outcome of an edit with what it left out, or the failure to write it."""
    if failure:
        say(operator, "WARNING", failure)
    elif left_out:
        say(operator, "WARNING", "; ".join(filter(None, (outcome, left_out))))
    elif outcome:
        say(operator, "INFO", outcome)


def report_error(operator: bpy.types.Operator, error: Exception, edit: stiv_blender.Edit | None = None) -> set[str]:
    """Report an error after restoring `edit`; unexpected errors print their trace."""
    if edit is not None:
        restore_after_error(edit, error)
    text = "; ".join([error_text(error), *map(translate_error, getattr(error, "__notes__", ()))])
    objects = getattr(error, "objects", ())  # of stiv.blender.ObjectsIntersectError
    short = translate_error(stiv_blender.intersection_text(*objects[0])) if objects else ""
    _report_with_details(operator, text, short)
    return {"CANCELLED"}


def _report_with_details(operator: bpy.types.Operator, text: str, short: str = "") -> None:
    """Report an error in short, or as much as fits; the tab shows the whole. Scripts get it as an exception."""
    panel = getattr(bpy.context.window_manager, "stiv_check", None)  # None once the extension is disabled
    if panel is not None and len(text) > LENGTH:
        panel.summary = text
    say(operator, "ERROR", text if bpy.app.background else short or brief(text))


def error_text(error: Exception) -> str:
    """The message of an error that names its cause. Texts of Python and NumPy go to the console with their trace."""
    if isinstance(error, stiv_blender.InputError | stiv_blender.SceneChangedError | DragEnded):
        return translate_error(error)
    traceback.print_exception(error)
    return translate("Unexpected error, the edit is undone; the system console has the details")


def report_raised(operator: bpy.types.Operator, error: RuntimeError) -> set[str]:
    """Report the error of a nested operator, which Blender raises as a RuntimeError."""
    _report_with_details(operator, str(error).removeprefix("Error: ").strip())
    return {"CANCELLED"}


def clearance_text(least: stiv_blender.LeastDistance) -> str:
    """The smallest distance between two objects, as a line."""
    distance = length_text(least.distance, bpy.context.scene.unit_settings)
    return translate("{}: clearance {}").format(", ".join(map(short_name, least.bodies)), distance)
