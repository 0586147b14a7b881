# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports of results and errors to the user."""

from __future__ import annotations

import traceback
from collections import deque
from collections.abc import Sequence

import bpy

from .. import stiv_blender
from ..intersection_texts import LENGTH, as_message, as_messages, brief, short_name
from ..modal.drag_end import DragEnded, restore_after_error
from ..modal.header_texts import naming, result_text
from ..translations import errors, translate, translate_error
from ..units import length_text

last_messages: deque[str] = deque(maxlen=10)  # for the report that a user copies into an issue


def say(operator: bpy.types.Operator, kind: str, text: str) -> None:
    """Report a message of a kind ("INFO", "WARNING", "ERROR"), and remember it."""
    last_messages.append(f"{type(operator).__name__}: {kind}: {text}")
    operator.report({kind}, text)


def outcome_text(result: stiv_blender.EditResult, edit: stiv_blender.Edit | None = None) -> str:
    """The status of a result, with the names of blocking objects, or why none is named. edit: of the result."""
    if edit is not None and stiv_blender.is_cut_by_topology(result):
        return topology_text(sorted(edit.moving))
    if result.status == "blocked" and edit is not None and edit.keeps_intersections:
        if not result.blocking:
            return translate("blocked: intersecting surfaces may only part; see Let These Pass")
        if len(result.blocking) == 1 and edit.intersects_itself(result.blocking[0]):
            text = translate("blocked by {}, which cuts itself; see Let These Pass")
            return stiv_blender.fit_message(text, result.blocking[0])
    return result_text(result.status, tuple(result.blocking), translate, stiv_blender.fit_message)


def topology_text(names: Sequence[str]) -> str:
    """The message on objects whose topology would change further along."""
    text = translate("blocked: the topology of {} changes here; apply its modifiers")
    return naming(text, translate, stiv_blender.fit_message, names[:1])


def end_text(result: stiv_blender.EditResult, edit: stiv_blender.Edit) -> str:
    """The outcome at the end of an edit: why nothing has moved, or the status."""
    note = edit.standstill_note(result)
    return message_text(note) if note else outcome_text(result, edit)


def message_text(message: object) -> str:
    """The text of an error or a note, in the language of the interface; names are shortened to fit the status bar."""
    return brief(errors.in_language(str(message), translate, stiv_blender.fit_message))


def write_failure(report: stiv_blender.WriteReport | None) -> str:
    """Why the accepted state could not be written; empty if it was, or if nothing was written yet."""
    return "" if report is None or report.passed else message_text(report.message)


def left_out_texts(context: bpy.types.Context, edit: stiv_blender.Edit, *notes: str) -> list[str]:
    """The messages on exceptions from the guarantee: faces at joints and torn seams, and objects that the next frame
    resets; and notes of the start.
    """
    reset_note = "" if context.scene.tool_settings.use_keyframe_insert_auto else edit.reset_note
    return [message_text(note) for note in (*edit.untested_notes, reset_note, *notes) if note]


def report_outcome(operator: bpy.types.Operator, outcome: str, failure: str, left_out: Sequence[str] = ()) -> None:
    """Report the outcome of an edit with what it left out, or the failure to write it."""
    if failure:
        say(operator, "WARNING", failure)
        return
    for message in as_messages(filter(None, (outcome, *left_out))):
        say(operator, "WARNING" if left_out else "INFO", message)


def report_error(operator: bpy.types.Operator, error: Exception, edit: stiv_blender.Edit | None = None) -> set[str]:
    """Report an error after restoring `edit`; unexpected errors print their trace."""
    if edit is not None:
        restore_after_error(edit, error)
    notes = getattr(error, "__notes__", ())
    texts = [error_text(error), *map(translate_error, notes)]
    _report_with_details(operator, "; ".join(texts), _in_short(error, texts[0], notes))
    return {"CANCELLED"}


def _in_short(error: Exception, text: str, notes: Sequence[str]) -> str:
    """The message of an error that fits the status bar. text: the whole text."""
    objects = getattr(error, "objects", ())  # of stiv.blender.ObjectsIntersectError
    if objects:
        return message_text(stiv_blender.intersection_text(*objects[0]))
    return as_message([message_text(error) if _is_explained(error) else brief(text), *map(message_text, notes)])


def _report_with_details(operator: bpy.types.Operator, text: str, short: str = "") -> None:
    """Report an error in short, or as much as fits; the tab shows the whole. Scripts get it as an exception."""
    panel = getattr(bpy.context.window_manager, "stiv_check", None)  # None once the extension is disabled
    if panel is not None and len(text) > LENGTH:
        panel.summary = text
    say(operator, "ERROR", text if bpy.app.background else short or brief(text))


def error_text(error: Exception) -> str:
    """The message of an error that names its cause. Texts of Python and NumPy go to the console with their trace."""
    if _is_explained(error):
        return translate_error(error)
    traceback.print_exception(error)
    return translate("Unexpected error, the edit is undone; the system console has the details")


def _is_explained(error: Exception) -> bool:
    """Does the message of the error name its cause?"""
    return isinstance(error, stiv_blender.InputError | stiv_blender.SceneChangedError | DragEnded)


def report_raised(operator: bpy.types.Operator, error: RuntimeError) -> set[str]:
    """Report the error of a nested operator, which Blender raises as a RuntimeError.

    An operator of STIV has already remembered its own error.
    """
    raised = str(error).strip()
    remembered = last_messages[-1].partition(": ERROR: ")[2] if last_messages else ""
    if remembered and raised.partition(": ")[2] == remembered.strip():  # after "Error", in the user's language
        operator.report({"ERROR"}, remembered)
    else:
        _report_with_details(operator, raised.removeprefix("Error: "))
    return {"CANCELLED"}


def clearance_text(least: stiv_blender.LeastDistance) -> str:
    """The smallest distance between two objects, as a line."""
    distance = length_text(least.distance, bpy.context.scene.unit_settings)
    return translate("{}: clearance {}").format(", ".join(map(short_name, least.bodies)), distance)
