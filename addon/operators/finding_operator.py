# SPDX-License-Identifier: GPL-3.0-or-later
"""Base of operators that first evaluate the scene, which may copy objects, and then change settings or selection."""

from __future__ import annotations

from typing import Any

import bpy

from ..guard import undo_steps
from ..native_module import NeedsNativeModule
from . import running, window_io
from .reports import report_error
from .start_step import StartStep

TICK = 0.01  # seconds between two looks at the undo step


class FindingOperator(NeedsNativeModule):
    """`find` evaluates the scene, and `take` takes what it has found.

    sets: whether `take` changes settings. An operator that sets nothing adds no step when a script calls it.
    """

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)
    sets = True

    def find(self, context: bpy.types.Context) -> Any:
        """Changes nothing; None if there is nothing to take, with a report. Raises ValueError."""
        raise NotImplementedError

    def take(self, context: bpy.types.Context, found: Any) -> None:
        """Change the scene, and report."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Find and take at once."""
        start = StartStep(self.sets)
        try:
            found = self.find(context)
        except ValueError as error:
            return report_error(self, error)
        if found is None:
            return {"CANCELLED"}
        if self.sets:
            start.add(context)
        return self._finish(context, found)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Find, and wait for the undo step of the start if objects were copied in an edit mode."""
        if bpy.app.background or context.window is None or running.obstacle():
            return self.execute(context)
        self._start = StartStep(self.sets)
        try:
            self._found = self.find(context)
        except ValueError as error:
            return report_error(self, error)
        if self._found is None:
            return {"CANCELLED"}
        if self._start.wait(context):
            return self._finish(context, self._found)
        self._timer = window_io.start_timer(context, TICK)
        context.window_manager.modal_handler_add(self)
        running.begin(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Take the result once the step is stored."""
        if not self._start.wait(context):
            return {"RUNNING_MODAL"}
        self.cancel(context)
        return self._finish(context, self._found)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator: a file is loaded, the window closes."""
        self._start.cancel()
        running.end()
        window_io.stop_timer(context, self._timer)

    def _finish(self, context: bpy.types.Context, found: Any) -> set[str]:
        self.take(context, found)
        if self.sets and context.mode.startswith("EDIT"):
            undo_steps.store_file_next()  # the operator's own step has to hold the settings
        return {"FINISHED"}
