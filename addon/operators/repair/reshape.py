# SPDX-License-Identifier: GPL-3.0-or-later
"""Base of repair, contraction, expansion and settling: `execute` solves at once, `modal` in a thread with progress."""

from __future__ import annotations

import json
import threading
from typing import Any

import bpy

from ... import stiv_blender
from ...intersection_texts import as_message, counted_faces, details, headline
from ...native_module import NeedsNativeModule
from ...overlay import display
from ...scene.edit_settings import edit_settings
from ...translations import translate
from .. import running, window_io
from ..last_edit import numbers
from ..reports import report_error

TICK = 0.05  # seconds between two looks at the worker
REPORTED_PAIRS = 100  # pairs in the report for scripts
MODES = {"OBJECT", "EDIT_MESH"}


class Worker(threading.Thread):
    """Solves beside Blender's main thread, without access to Blender's data. `error` is the exception that ended it."""

    def __init__(self, task: stiv_blender.Reshaping) -> None:
        """Start at once."""
        super().__init__(daemon=True)
        self.token = stiv_blender.CancelToken()
        self.progress = ("", 0.0)
        self.error: Exception | None = None
        self._task = task
        self.start()

    def run(self) -> None:
        """Solve; the main thread reports an error."""
        try:
            self._task.solve(cancel=self.token, progress=self._note)
        except Exception as error:
            self.error = error

    def _note(self, phase: str, fraction: float) -> None:
        self.progress = (phase, fraction)


class ReshapeOperator(NeedsNativeModule):
    """Base of an operator; a subclass has its properties and `begin`."""

    bl_options = {"REGISTER", "UNDO", "BLOCKING"}  # noqa: RUF012 (Blender reads a set)

    @classmethod
    def is_available(cls, context: bpy.types.Context) -> bool:
        """In Object Mode, and in Edit Mode of a mesh."""
        return context.mode in MODES

    def begin(self, context: bpy.types.Context) -> stiv_blender.Reshaping:
        """Read the scene; returns the task to solve."""
        raise NotImplementedError

    def settings(self, context: bpy.types.Context) -> stiv_blender.EditSettings:
        """The settings of the scene."""
        return edit_settings(context.scene)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Solve at once, with Blender's progress at the pointer."""
        manager = context.window_manager
        manager.progress_begin(0, 100)
        try:
            report = stiv_blender.run_to_end(
                self.begin(context), progress=lambda phase, fraction: manager.progress_update(100 * fraction)
            )
        except Exception as error:  # nothing may stay half done, whatever went wrong
            return report_error(self, error)
        finally:
            manager.progress_end()
        return self._finish(context, report)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Solve in a thread so that the window stays responsive; without a window, solve at once."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        return self.start(context)

    def start(self, context: bpy.types.Context) -> set[str]:
        """Read the scene and start the worker."""
        if obstacle := running.obstacle():
            self.report({"ERROR"}, obstacle)
            return {"CANCELLED"}
        try:
            self._task = self.begin(context)
        except Exception as error:
            return report_error(self, error)
        self._worker = Worker(self._task)
        self._timer = window_io.start_timer(context, TICK)
        context.window_manager.modal_handler_add(self)
        running.begin(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the progress; Esc cancels; write when the worker is done.

        The worker writes nothing, so Esc does not wait for it: it ends by itself when it next checks its token.
        """
        if event.type == "ESC" and event.value == "PRESS":
            self._worker.token.cancel()
            self._leave(context)
            self._restore()
            self.report({"INFO"}, translate("cancelled, nothing changed"))
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        if self._worker.is_alive():
            window_io.show_progress(context, self._worker.progress[1], translate(self.bl_label))
            return {"RUNNING_MODAL"}
        return self._write(context)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator: a file is loaded, the window closes."""
        self._worker.token.cancel()
        self._worker.join()
        self._leave(context)
        self._restore()

    def _write(self, context: bpy.types.Context) -> set[str]:
        try:
            if self._worker.error is not None:
                raise self._worker.error
            report = self._task.write()
        except Exception as error:
            self._leave(context)
            self._restore(error)
            return report_error(self, error)
        if report is None:
            self._worker = Worker(self._task)
            return {"RUNNING_MODAL"}
        self._leave(context)
        return self._finish(context, report)

    def _leave(self, context: bpy.types.Context) -> None:
        running.end()
        window_io.stop_timer(context, self._timer)
        window_io.clear(context)

    def _restore(self, error: Exception | None = None) -> None:
        try:
            self._task.restore()
        except Exception as second:  # an object is gone: the others keep their state
            if error is not None:
                error.add_note(str(second))

    def _finish(self, context: bpy.types.Context, report: Any) -> set[str]:
        context.window_manager.stiv_last_edit = describe(report)
        lines = outcome(report)
        context.window_manager.stiv_check.summary = "\n".join(lines)
        display.show_pairs(context, report.pairs)
        if report.status in ("refused", "budget") or (report.status == "blocked" and not report.changed):
            self.report({"ERROR"}, as_message(lines))
            return {"CANCELLED"}
        self.report({"WARNING"} if report.pairs or report.message else {"INFO"}, as_message(lines))
        return {"FINISHED"} if report.changed else {"CANCELLED"}


_OUTCOME_TEXTS = {
    "already_free": "nothing intersects",
    "refused": "not repaired, nothing changed",
    "budget": "time limit reached, nothing changed",
    "cancelled": "cancelled, nothing changed",
    "contracted": "contracted",
    "reached": "shape reached",
    "corrected": "as close as contact allows",
    "blocked": "blocked",
    "unchanged": "nothing left to do",
}


def outcome(report: stiv_blender.ReshapeReport) -> list[str]:
    """Lines: the outcome, the reason, and what still intersects."""
    if report.status == "repaired":
        faces = counted_faces(report.faces_before, translate)
        text = translate("Resolved {}, mean deviation {}").format(faces, f"{report.deviation:.2%}")
    else:
        text = translate(_OUTCOME_TEXTS.get(report.status, report.status))
    message = report.message if report.status != "cancelled" else ""
    pairs = report.pairs
    first = (message, text) if report.status == "refused" else (text, message)
    return [line for line in (*first, headline(pairs, translate), *details(pairs, translate)) if line]


def describe(report: stiv_blender.ReshapeReport) -> str:
    """JSON of a report, with the first pairs."""
    solved = {} if report.result is None else numbers(report.result)
    pairs = [[[each.object, each.kind, each.number] for each in (pair.first, pair.second)] for pair in report.pairs]
    return json.dumps(
        {
            "status": report.status,
            "changed": report.changed,
            "message": report.message,
            "pairs_before": report.pairs_before,
            "pairs_left": len(pairs),
            "pairs": pairs[:REPORTED_PAIRS],
            "deviation": report.deviation,
            "contracted": report.contracted,
            "rounds": 0,
            **solved,
        }
    )
