# SPDX-License-Identifier: GPL-3.0-or-later
"""Base of operators whose work is a task in a window: jobs beside Blender, progress in the header, Esc."""

from __future__ import annotations

import time
from collections.abc import Collection
from typing import Any

import bpy
from bpy.props import FloatProperty

from .. import stiv_blender
from ..native_module import Mixin
from ..translations import translate
from . import running, window_io
from .reports import report_error

TICK = 0.05  # seconds between two looks at the task


def TimeLimitProperty(description: str, options: Collection[str] = ("ANIMATABLE",)) -> object:  # noqa: N802 (as Blender's own)
    """The time limit of an operator, in seconds."""
    return FloatProperty(
        name="Time Limit",
        description=description,
        subtype="TIME_ABSOLUTE",
        unit="TIME_ABSOLUTE",
        default=120.0,
        min=0.0,
        options=set(options),
    )


class TaskOperator(Mixin):
    """`start_task` runs steps; `finish_task` takes their result."""

    step_seconds = 0.0  # of each look, for the steps between jobs

    def start_task(self, context: bpy.types.Context, steps: stiv_blender.Steps[Any]) -> set[str]:
        """Begin the steps, and return to Blender."""
        if obstacle := running.obstacle():
            self.report({"ERROR"}, obstacle)
            return {"CANCELLED"}
        self._task = stiv_blender.Task(steps)
        self._timer = window_io.start_timer(context, TICK)
        context.window_manager.modal_handler_add(self)
        running.begin(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the progress; Esc stops; finish when the task is done."""
        if event.type == "ESC" and event.value == "PRESS":
            return self.stop_task(context)
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        try:
            done = self._advance()
            fraction = self._task.progress.fraction  # may make a call that the job waits for
            self.write_between_looks()
        except Exception as error:
            self._leave(context)
            self._restore(error)
            return report_error(self, error)
        if not done or not self.can_finish(context):
            window_io.show_progress(context, fraction, translate(self.bl_label))
            return {"RUNNING_MODAL"}
        self._leave(context)
        return self.finish_task(context, self._task.result)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator: a file is loaded, the window closes."""
        self._abandon(context)

    def stop_task(self, context: bpy.types.Context) -> set[str]:
        """Esc: end with nothing changed. Does not wait for the job."""
        self._abandon(context)
        self.report({"INFO"}, translate("cancelled, nothing changed"))
        return {"CANCELLED"}

    def can_finish(self, context: bpy.types.Context) -> bool:
        """Whether `finish_task` can be called; asked at each look once the task is done."""
        return True

    def finish_task(self, context: bpy.types.Context, result: Any) -> set[str]:
        """Report the result of the steps; returns the result of the operator."""
        raise NotImplementedError

    def restore_scene(self) -> None:
        """Restore the start exactly. Does nothing if nothing was written."""

    def write_between_looks(self) -> None:
        """Write what Blender may draw before the next look, if the calls of a job write something else."""

    def _advance(self) -> bool:
        end = time.perf_counter() + self.step_seconds
        while not self._task.advance(max(0.0, end - time.perf_counter())):
            if time.perf_counter() >= end:
                return False
        return True

    def _abandon(self, context: bpy.types.Context) -> None:
        self._task.abandon()
        self._leave(context)
        self._restore()

    def _leave(self, context: bpy.types.Context) -> None:
        running.end()
        window_io.stop_timer(context, self._timer)
        window_io.clear(context)

    def _restore(self, error: Exception | None = None) -> None:
        try:
            self.restore_scene()
        except Exception as second:  # an object is gone: the others keep their state
            if error is not None:
                error.add_note(str(second))
