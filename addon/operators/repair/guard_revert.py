# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.guard_revert`: restores the last clear state if the live guard could not correct a result."""

from __future__ import annotations

import bpy

from ... import stiv_blender
from ...guard import correction, watcher
from ...modal.header_texts import naming
from ...native_module import NeedsNativeModule
from ...translations import translate
from .. import last_edit
from ..reports import report_error


class STIV_OT_guard_revert(NeedsNativeModule, bpy.types.Operator):
    """Restore the last state without intersections, poses and shape keys included"""

    bl_idname = "stiv.guard_revert"
    bl_label = "Restore Before Collision"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    @classmethod
    def is_available(cls, context: bpy.types.Context) -> bool:
        """After a result that the guard could not correct."""
        if not watcher.is_on(context) or watcher.last_clear_state() is None:
            cls.poll_message_set(translate("The live guard has seen no clear state yet"))
            return False
        if watcher.state(context) != "intersecting":
            cls.poll_message_set(translate("No result is uncorrected"))
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write, test, and report any remaining intersections."""
        clear = watcher.last_clear_state()
        if clear is None:
            return {"CANCELLED"}
        state, frame = clear
        try:
            names = correction.revert(context, state, frame)
        except ValueError as error:
            return report_error(self, error)
        if context.mode == "SCULPT":
            correction.evaluate_strokes(context)
        last_edit.note_written(self, context)  # so that the guard accepts it, and starts no edit toward it
        remaining = watcher.uncorrected_of(correction.test(context))
        if remaining is not None:
            headline = remaining.headline(translate)
            self.report({"WARNING"}, translate("{}; use Undo for other changes").format(headline))
            return {"FINISHED"} if names else {"CANCELLED"}
        restored = naming(translate("Restored {}"), translate, stiv_blender.fit_message, names)
        self.report({"INFO"}, restored if names else translate("Restored frame {}").format(frame))
        return {"FINISHED"}
