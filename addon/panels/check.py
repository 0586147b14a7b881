# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the current scene: check, repair, overlay."""

from __future__ import annotations

import bpy

from ..operators.check.check import STIV_OT_check
from ..operators.check.measure import STIV_OT_measure
from ..operators.classes import RESHAPING
from ..operators.repair.exclusions import STIV_OT_clear_exclusions, STIV_OT_exclude_intersections, excluded_count
from ..operators.repair.passing import STIV_OT_let_pass, STIV_OT_let_pass_remove
from ..operators.repair.separate import STIV_OT_separate
from .base import SubPanel, draw_lines

ICONS = ("MODIFIER", "FULLSCREEN_EXIT", "FULLSCREEN_ENTER", "RECOVER_LAST")  # of the operators in RESHAPING
BUTTON_TEXTS = {
    "stiv.repair": "Repair",
    "stiv.contract": "Contract",
    "stiv.expand": "Expand",
    "stiv.settle": "Settle",
}


class STIV_PT_check(SubPanel, bpy.types.Panel):
    """Intersections of the current scene."""

    bl_idname = "STIV_PT_check"
    bl_label = "Check"

    def draw(self, context: bpy.types.Context) -> None:
        """The button, and the result of the last check."""
        self.layout.operator(STIV_OT_check.bl_idname, text="Check Scene", icon="VIEWZOOM").select = False
        if context.window_manager.stiv_check.intersects:
            select = self.layout.operator(STIV_OT_check.bl_idname, text="Select Intersecting Faces", icon="FACESEL")
            select.select = True
        draw_lines(self.layout, context.window_manager.stiv_check.summary)


class STIV_PT_repair(SubPanel, bpy.types.Panel):
    """Repair, its single steps, and exclusions."""

    bl_idname = "STIV_PT_repair"
    bl_label = "Repair"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a set)

    def draw(self, context: bpy.types.Context) -> None:
        """A button for each operator; their values are in the redo panel."""
        column = self.layout.column(align=True)
        for operator, icon in zip(RESHAPING, ICONS, strict=True):
            column.operator(operator.bl_idname, text=BUTTON_TEXTS[operator.bl_idname], icon=icon)
        column.operator(STIV_OT_separate.bl_idname, text="Separate", icon="UNLINKED")
        self.layout.operator(STIV_OT_let_pass.bl_idname, text="Let These Pass", icon="HIDE_OFF")
        for index, pair in enumerate(context.scene.stiv.passing_pairs):
            row = self.layout.row(align=True)
            row.prop(pair, "first", text="")
            row.prop(pair, "second", text="")
            row.operator(STIV_OT_let_pass_remove.bl_idname, text="", icon="REMOVE").index = index
        row = self.layout.row(align=True)
        row.operator(STIV_OT_exclude_intersections.bl_idname, icon="GHOST_ENABLED")
        count = excluded_count(context.scene.stiv.excluded)
        if count:
            row.operator(STIV_OT_clear_exclusions.bl_idname, text="", icon="X")
            draw_lines(self.layout, count)


class STIV_PT_overlay(SubPanel, bpy.types.Panel):
    """Switches of the overlay."""

    bl_idname = "STIV_PT_overlay"
    bl_label = "Overlay"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a set)

    def draw_header(self, context: bpy.types.Context) -> None:
        """The switch of the whole overlay."""
        self.layout.prop(context.window_manager.stiv_overlay, "show", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """A switch for each item."""
        switches = context.window_manager.stiv_overlay
        column = self.layout.column()
        column.active = switches.show
        for name in ("contacts", "goal", "intersections", "clearance", "while_dragging", "speed"):
            column.prop(switches, name)
        self.layout.operator(STIV_OT_measure.bl_idname, text="Measure", icon="DRIVER_DISTANCE")
