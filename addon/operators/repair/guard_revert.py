# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.guard_revert`: from a result that the live guard could not correct to the last state without intersections."""

from __future__ import annotations

import bpy

from ...guard import correction, watcher
from ...guard.problem import listed
from ...native_module import NeedsNativeModule
from ...translations import say


class STIV_OT_guard_revert(NeedsNativeModule, bpy.types.Operator):
    """Restore objects, vertices, poses and shape keys to the last state without intersections"""

    bl_idname = "stiv.guard_revert"
    bl_label = "Restore Clear State"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    @classmethod
    def fits(cls, context: bpy.types.Context) -> bool:
        """While the guard watches an intersecting scene that it has seen clear before."""
        if not watcher.is_on(context) or watcher.last_clear_state() is None:
            cls.poll_message_set("The live guard has seen no clear state yet")
            return False
        if watcher.problem() is None:
            cls.poll_message_set("Nothing intersects")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write, test, and say what is left."""
        state, frame = watcher.last_clear_state()
        try:
            names = correction.revert(context, state, frame)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if context.mode == "SCULPT":
            correction.take_strokes(context)
        left = correction.test(context).problem
        if left is not None:
            self.report({"WARNING"}, say("{}; use Undo for other changes").format(left.headline(say)))
            return {"FINISHED"} if names else {"CANCELLED"}
        restored = say("Restored {}").format(listed(names, say)) if names else say("Restored frame {}").format(frame)
        self.report({"INFO"}, restored)
        return {"FINISHED"}
