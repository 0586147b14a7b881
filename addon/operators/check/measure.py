# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.measure`: find the nearest pair of objects, and show it over the view."""

from __future__ import annotations

import bpy

from ...native_module import NeedsNativeModule
from ...overlay import display
from ...scene.edit_settings import edit_settings


class STIV_OT_measure(NeedsNativeModule, bpy.types.Operator):
    """Find the two visible objects that are nearest to each other, and show their distance over the view."""

    bl_idname = "stiv.measure"
    bl_label = "Measure Clearance"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender reads a set)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Measure, show, say."""
        from stiv.blender.measuring import nearest_pair  # the add-on registers without the native module

        try:
            found = nearest_pair(context, edit_settings(context.scene))
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if found is None:
            self.report({"WARNING"}, "There are no two objects to be measured")
            return {"CANCELLED"}
        display.show_clearance(found)
        self.report({"INFO"}, f"Least distance {found.distance:.6g} between {' and '.join(found.bodies)}")
        return {"FINISHED"}
