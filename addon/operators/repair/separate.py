# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.separate`: moves the selected objects out of all others by the least distance."""

from __future__ import annotations

import bpy

from ... import stiv_blender
from ...native_module import NeedsNativeModule
from ...scene.edit_settings import edit_settings
from ...translations import translate
from ...units import length_text
from ..reports import report_error
from ..task_operator import TaskOperator, TimeLimitProperty


class STIV_OT_separate(TaskOperator, NeedsNativeModule, bpy.types.Operator):
    """Move the selected objects the least distance that parts them from all others"""

    bl_idname = "stiv.separate"
    bl_label = "Collision Separate"
    bl_options = {"REGISTER", "UNDO", "BLOCKING"}  # noqa: RUF012 (Blender reads a set)

    time_limit: TimeLimitProperty(description="Take the best result within this time; 0 for no limit")

    @classmethod
    def is_available(cls, context: bpy.types.Context) -> bool:
        """In Object Mode."""
        return bool(context.mode == "OBJECT")

    step_seconds = 0.04  # many short steps

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Find the translation in steps, with progress in the header; at once without a window."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        return self.start_task(context, stiv_blender.separate_steps(context, self._settings(context)))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Find the translation, write it, test the result, report the distance."""
        try:
            found = stiv_blender.separate(context, self._settings(context))
        except Exception as error:  # nothing may stay half done, whatever went wrong
            return report_error(self, error)
        return self.finish_task(context, found)

    def finish_task(self, context: bpy.types.Context, found: stiv_blender.SeparationReport) -> set[str]:
        """Report the distance."""
        if not found.others:
            self.report({"INFO"}, translate("The selection intersects no other object"))
            return {"CANCELLED"}
        distance = length_text(found.distance, context.scene.unit_settings)
        text = translate("{}: moved {} away from {}")
        self.report({"INFO"}, stiv_blender.fit_message(text, found.moved[0], distance, found.others[0]))
        if found.out_of_time:
            self.report({"WARNING"}, translate("time limit reached; raise it for a shorter way"))
        return {"FINISHED"}

    def _settings(self, context: bpy.types.Context) -> stiv_blender.EditSettings:
        """The settings of the scene, with the time limit."""
        return edit_settings(context.scene, time_budget=self.time_limit)
