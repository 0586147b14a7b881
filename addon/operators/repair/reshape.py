# SPDX-License-Identifier: GPL-3.0-or-later
"""Base of repair, contraction, expansion and settling: `execute` solves at once, `modal` in jobs with progress."""

from __future__ import annotations

import json
from typing import Any

import bpy

from ... import stiv_blender
from ...intersection_texts import as_message, counted_faces, details, headline
from ...native_module import NeedsNativeModule
from ...overlay import display
from ...scene.edit_settings import edit_settings
from ...translations import translate
from ..last_edit import numbers
from ..reports import message_text, report_error
from ..start_step import StartStep
from ..task_operator import TaskOperator, TimeLimitProperty

REPORTED_PAIRS = 100  # pairs in the report for scripts
MODES = {"OBJECT", "EDIT_MESH"}
FAILURES = {"refused", "budget", "blocked"}  # if nothing changed


class ReshapeOperator(TaskOperator, NeedsNativeModule):
    """Base of an operator; a subclass has its properties and `begin`."""

    time_limit: TimeLimitProperty(description="Take the best result within this time; 0 for no limit")

    bl_options = {"REGISTER", "UNDO", "BLOCKING"}  # noqa: RUF012 (Blender reads a set)

    @classmethod
    def is_available(cls, context: bpy.types.Context) -> bool:
        """In Object Mode, and in Edit Mode of a mesh."""
        return context.mode in MODES

    def begin(self, context: bpy.types.Context) -> stiv_blender.Reshaping:
        """Read the scene; returns the task to solve."""
        raise NotImplementedError

    def settings(self, context: bpy.types.Context) -> stiv_blender.EditSettings:
        """The settings of the scene, with the time limit."""
        return edit_settings(context.scene, time_budget=self.time_limit)

    def draw(self, context: bpy.types.Context) -> None:
        """The redo panel: the properties that apply, then the time limit."""
        self.layout.use_property_split, self.layout.use_property_decorate = True, False
        for name in (*self.shown_properties(), "time_limit"):
            self.layout.prop(self, name)

    def shown_properties(self) -> tuple[str, ...]:
        """Names of the properties that apply to the present values."""
        return tuple(type(self).__annotations__)

    def note_start(self, context: bpy.types.Context) -> None:
        """Remember what undo has to restore, before the scene is read."""
        self._start = StartStep()
        self._shapes = stiv_blender.EditModeShapes(list(context.view_layer.objects))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Solve at once, with Blender's progress at the pointer."""
        manager = context.window_manager
        self.note_start(context)
        manager.progress_begin(0, 100)
        try:
            report = stiv_blender.run_to_end(
                self.begin(context), progress=lambda phase, fraction: manager.progress_update(100 * fraction)
            )
        except Exception as error:  # nothing may stay half done, whatever went wrong
            return report_error(self, error)
        finally:
            manager.progress_end()
        if report.changed:
            self._start.add(context, self._shapes.shown)
        return self._finish(context, report)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Solve in a job so that the window stays responsive; without a window, solve at once."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        return self.start(context)

    def start(self, context: bpy.types.Context) -> set[str]:
        """Read the scene and start the job."""
        self.note_start(context)
        try:
            self._reshaping = self.begin(context)
        except Exception as error:
            return report_error(self, error)
        return self.start_task(context, self._steps())

    def _steps(self) -> stiv_blender.Steps[Any]:
        """Solve and write until there is a report."""
        while True:
            yield from self._reshaping.solve_steps()
            report = self._reshaping.write()
            if report is not None:
                return report

    def can_finish(self, context: bpy.types.Context) -> bool:
        """Whether undo can return to the start."""
        return not self._task.result.changed or self._start.wait(context, self._shapes.shown)

    def finish_task(self, context: bpy.types.Context, result: Any) -> set[str]:
        """Report."""
        return self._finish(context, result)

    def restore_scene(self) -> None:
        """Restore the start exactly."""
        self._start.cancel()
        self._reshaping.restore()

    def _finish(self, context: bpy.types.Context, report: Any) -> set[str]:
        context.window_manager.stiv_last_edit = describe(report)
        lines = outcome(report)
        context.window_manager.stiv_check.summary = "\n".join(lines)
        display.show_pairs(context, report.pairs)
        if report.status in FAILURES and not report.changed:
            self.report({"ERROR"}, as_message(lines))
            return {"CANCELLED"}
        is_whole = report.status != "budget" and not report.pairs and not report.message
        self.report({"INFO"} if is_whole else {"WARNING"}, as_message(lines))
        return {"FINISHED"} if report.changed else {"CANCELLED"}


_OUTCOME_TEXTS = {
    "already_free": "nothing intersects",
    "refused": "not repaired, nothing changed",
    "budget": "time limit reached, nothing changed",
    "kept": "time limit reached, result so far kept; run it again to continue",  # "budget" with a change
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
        key = "kept" if report.status == "budget" and report.changed else report.status
        text = translate(_OUTCOME_TEXTS.get(key, key))
    message = message_text(report.message) if report.status != "cancelled" else ""
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
