# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.measure`: finds the closest pair of objects, and shows it in the view."""

from __future__ import annotations

import bpy

from ... import stiv_blender
from ...native_module import NeedsNativeModule
from ...overlay import display
from ...scene.edit_settings import edit_settings
from ...translations import translate
from ..reports import clearance_text, report_error


class STIV_OT_measure(NeedsNativeModule, bpy.types.Operator):
    """Find the two closest visible objects, and show their distance in the 3D view"""

    bl_idname = "stiv.measure"
    bl_label = "Collision Clearance"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender reads a set)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Measure, show, report."""
        try:
            found = stiv_blender.nearest_pair(context, edit_settings(context.scene))
        except ValueError as error:
            return report_error(self, error)
        if found is None:
            self.report({"WARNING"}, translate("No two visible objects to measure"))
            return {"CANCELLED"}
        display.show_clearance(found)
        self.report({"INFO"}, clearance_text(found))
        return {"FINISHED"}
