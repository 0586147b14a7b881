# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard: its switch, its state, and the operators for what intersects."""

from __future__ import annotations

from collections.abc import Mapping

import bpy

from ..guard import watcher
from ..guard.problem import Problem
from ..intersection_texts import details
from ..translations import translate
from .base import SubPanel, draw_lines

OPERATORS = {
    "stiv.check": "VIEWZOOM",
    "stiv.repair": "MODIFIER",
    "stiv.separate": "FULLSCREEN_ENTER",
    "stiv.let_pass": "GHOST_DISABLED",
    "stiv.exclude_intersections": "GHOST_ENABLED",
}
REVERT = {"stiv.guard_revert": "LOOP_BACK"}


class STIV_PT_guard(SubPanel, bpy.types.Panel):
    """The live guard, which watches Blender's tools."""

    bl_idname = "STIV_PT_guard"
    bl_label = "Live Guard"

    def draw_header(self, context: bpy.types.Context) -> None:
        """The switch."""
        self.layout.prop(context.scene.stiv, "live_guard", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """The state of the scene."""
        draw_state(self.layout, context)


class STIV_PT_guard_state(bpy.types.Panel):
    """The popover of the icon in the header."""

    bl_idname = "STIV_PT_guard_state"
    bl_label = "Live Guard"
    bl_description = "State of the live guard, and what to do about intersections"
    bl_space_type = "VIEW_3D"
    bl_region_type = "HEADER"
    bl_ui_units_x = 15

    def draw(self, context: bpy.types.Context) -> None:
        """The switch and the state."""
        self.layout.prop(context.scene.stiv, "live_guard")
        draw_state(self.layout, context)


def draw_state(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """The state of the guard, and what to do."""
    if not context.scene.stiv.live_guard:
        layout.label(text="Off: results are not corrected")
    elif (problem := watcher.problem()) is None:
        layout.label(text="The scene is clear", icon="CHECKMARK")
    elif problem.known:
        draw_known(layout, problem)
    else:
        draw_alert(layout, problem)
    if watcher.uncorrected():
        layout.label(text=translate("Uncorrected results: {}").format(watcher.uncorrected()))


def draw_known(layout: bpy.types.UILayout, problem: Problem) -> None:
    """The intersections that the guard leaves alone."""
    layout.label(text="All but these are guarded", icon="INFO")
    draw_lines(layout, "\n".join([problem.headline(translate), *details(problem.pairs, translate)]))
    _draw_operators(layout, OPERATORS)


def draw_alert(layout: bpy.types.UILayout, problem: Problem) -> None:
    """The intersections in red, why they were not corrected, and what to do."""
    box = layout.box()
    box.alert = True
    box.label(text="The scene intersects", icon="ERROR")
    draw_lines(box, problem.headline(translate))
    draw_lines(box, "\n".join(problem.pair_lines(translate)))
    if problem.pairs and problem.reason:
        draw_lines(layout, translate("Not corrected: {}").format(problem.reason))
    layout.label(text="All else is guarded")
    _draw_operators(layout, REVERT | OPERATORS)


def _draw_operators(layout: bpy.types.UILayout, icons: Mapping[str, str]) -> None:
    """A button for each operator, by the names of their icons."""
    column = layout.column(align=True)
    for name, icon in icons.items():
        column.operator(name, icon=icon)
