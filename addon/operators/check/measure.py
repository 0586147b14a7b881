# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.measure`: find the nearest pair of objects, and show it over the view."""

from __future__ import annotations

import bpy

from ...native_module import NeedsNativeModule
from ...overlay import display
from ...scene.edit_settings import edit_settings
from .check import clearance_text


class STIV_OT_measure(NeedsNativeModule, bpy.types.Operator):
    """Find the two closest visible objects, and show their distance in the 3D view"""

    bl_idname = "stiv.measure"
    bl_label = "Measure Clearance"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender reads a set)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Measure, show, say."""
        from stiv.blender.verify.nearest_pair import nearest_pair  # the add-on registers without the native module

        try:
            found = nearest_pair(context, edit_settings(context.scene))
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if found is None:
            self.report({"WARNING"}, "No two visible objects to measure")
            return {"CANCELLED"}
        display.show_clearance(found)
        self.report({"INFO"}, clearance_text(found))
        return {"FINISHED"}
