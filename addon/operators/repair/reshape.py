# SPDX-License-Identifier: GPL-3.0-or-later
"""What contraction, expansion, settling and repair share: values through `execute`; progress, Esc through `modal`."""

from __future__ import annotations

import json
import threading
import traceback
from collections.abc import Sequence
from typing import Any

import bpy

from ...native_module import NeedsNativeModule
from ...overlay import display
from ...scene.edit_settings import edit_settings
from ...translations import say
from .. import window_io
from ..last_edit import numbers

TICK = 0.05  # seconds between two looks at the worker
LISTED = 100  # pairs of a report for scripts
TOLD = 3  # pairs of a message
MODES = {"OBJECT", "EDIT_MESH"}


class Worker(threading.Thread):
    """Solves beside Blender's main thread. It touches nothing of Blender's; `error` is what it ended with."""

    def __init__(self, task: Any) -> None:
        """Begin at once."""
        from stiv import CancelToken

        super().__init__(daemon=True)
        self.token = CancelToken()
        self.progress = ("", 0.0)
        self.error: BaseException | None = None
        self._task = task
        self.start()

    def run(self) -> None:
        """Solve; whatever goes wrong is told in the main thread."""
        try:
            self._task.solve(cancel=self.token, progress=self._note)
        except BaseException as error:
            self.error = error

    def _note(self, phase: str, fraction: float) -> None:
        self.progress = (phase, fraction)


class ReshapeOperator(NeedsNativeModule):
    """Base of an operator; a subclass has `begin`, which reads the scene and gives a task of stiv.blender."""

    bl_options = {"REGISTER", "UNDO", "BLOCKING"}  # noqa: RUF012 (Blender reads a set)

    @classmethod
    def fits(cls, context: bpy.types.Context) -> bool:
        """In Object Mode, and in Edit Mode of a mesh."""
        return context.mode in MODES

    def settings(self, context: bpy.types.Context) -> Any:
        """Separation, roles and what else the scene says."""
        return edit_settings(context.scene)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do all of it, with Blender's progress at the pointer."""
        from stiv.blender.repair.repair import carry_out  # the add-on registers without the native module

        manager = context.window_manager
        manager.progress_begin(0, 100)
        try:
            report = carry_out(
                self.begin(context), progress=lambda phase, fraction: manager.progress_update(100 * fraction)
            )
        except Exception as error:  # nothing may be left half done, whatever went wrong
            return self._refuse(error)
        finally:
            manager.progress_end()
        return self._tell(context, report)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Work in a thread while the window goes on; without a window as a script would."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        return self.start(context)

    def start(self, context: bpy.types.Context) -> set[str]:
        """Read the scene and begin to solve."""
        try:
            self._task = self.begin(context)
        except Exception as error:
            return self._refuse(error)
        self._worker = Worker(self._task)
        self._timer = context.window_manager.event_timer_add(TICK, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show how far it is; Esc cancels; write when the worker is done.

        Nothing is written while the worker solves, so Esc need not wait for it: it ends by itself, at its next look.
        """
        if event.type == "ESC" and event.value == "PRESS":
            self._worker.token.cancel()
            self._leave(context)
            self._put_back()
            self.report({"INFO"}, say("cancelled, nothing changed"))
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        if self._worker.is_alive():
            phase, fraction = self._worker.progress
            told = f"{say(self.bl_label)}: {phase} {fraction:.0%}    {say('Esc: cancel')}"
            window_io.write_header(context, told)
            return {"RUNNING_MODAL"}
        return self._write(context)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator: a file is loaded, the window closes."""
        self._worker.token.cancel()
        self._worker.join()
        self._leave(context)
        self._put_back()

    def _write(self, context: bpy.types.Context) -> set[str]:
        try:
            if self._worker.error is not None:
                raise self._worker.error
            report = self._task.write()
        except Exception as error:
            self._leave(context)
            self._put_back(error)
            return self._refuse(error)
        if report is None:
            self._worker = Worker(self._task)
            return {"RUNNING_MODAL"}
        self._leave(context)
        return self._tell(context, report)

    def _leave(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        window_io.clear(context)

    def _put_back(self, error: Exception | None = None) -> None:
        try:
            self._task.restore()
        except Exception as second:  # an object is gone: the rest stays as it is
            if error is not None:
                error.add_note(str(second))

    def _tell(self, context: bpy.types.Context, report: Any) -> set[str]:
        context.window_manager.stiv_last_edit = describe(report)
        context.window_manager.stiv_check.summary = outcome(report)
        display.show_pairs(context, report.pairs)
        if report.status in ("refused", "budget") or (report.status == "blocked" and not report.changed):
            self.report({"ERROR"}, outcome(report))
            return {"CANCELLED"}
        self.report({"WARNING"} if report.pairs or report.message else {"INFO"}, outcome(report))
        return {"FINISHED"} if report.changed else {"CANCELLED"}

    def _refuse(self, error: Exception) -> set[str]:
        """Report an error with nothing changed. The trace of what nobody expected is printed."""
        from stiv.blender import SceneChangedError

        if not isinstance(error, ValueError | SceneChangedError):
            traceback.print_exception(error)
        self.report({"ERROR"}, "; ".join([str(error) or type(error).__name__, *getattr(error, "__notes__", ())]))
        return {"CANCELLED"}


_OUTCOME_WORDS = {
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


def outcome(report: Any) -> str:
    """What became of it, what is left, and where the first of it is: one line."""
    text = say(_OUTCOME_WORDS.get(report.status, report.status))
    if report.status == "repaired":
        text = _repaired(report.pairs_before, f"{report.deviation:.2%}")
    parts = [text, report.message] if report.message and report.status != "cancelled" else [text]
    if report.pairs:
        named = _named(report.pairs[:TOLD]) + " ..." * (len(report.pairs) > TOLD)
        parts.append(_intersecting(len(report.pairs), named))
    return "; ".join(parts)


def _intersecting(count: int, named: str) -> str:
    return (
        say("1 pair intersects: {}").format(named) if count == 1 else say("{} pairs intersect: {}").format(count, named)
    )


def _repaired(count: int, deviation: str) -> str:
    if count == 1:
        return say("Resolved 1 intersection, mean deviation {}").format(deviation)
    return say("Resolved {} intersections, mean deviation {}").format(count, deviation)


def describe(report: Any) -> str:
    """JSON of a stiv.blender.ReshapeReport, with the first pairs."""
    solved = {} if report.result is None else numbers(report.result)
    pairs = [[[each.object, each.kind, each.number] for each in (pair.first, pair.second)] for pair in report.pairs]
    return json.dumps(
        {
            "status": report.status,
            "changed": report.changed,
            "message": report.message,
            "pairs_before": report.pairs_before,
            "pairs_left": len(pairs),
            "pairs": pairs[:LISTED],
            "deviation": report.deviation,
            "contracted": report.contracted,
            "rounds": 0,
            **solved,
        }
    )


def _named(pairs: Sequence[Any]) -> str:
    return ", ".join(
        f'"{pair.first.object}" {pair.first.kind} {pair.first.number} and '
        f'"{pair.second.object}" {pair.second.kind} {pair.second.number}'
        for pair in pairs
    )
