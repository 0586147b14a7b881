# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard: its switch, and the operators for a scene that it could not correct."""

from __future__ import annotations

import bpy

from ..guard import watcher
from ..guard.problem import Problem
from ..translations import translate
from .base import SubPanel, draw_lines

OPERATORS = ("stiv.guard_revert", "stiv.check", "stiv.repair", "stiv.exclude_intersections")


class STIV_PT_guard(SubPanel, bpy.types.Panel):
    """The live guard, which watches Blender's tools."""

    bl_idname = "STIV_PT_guard"
    bl_label = "Live Guard"

    def draw_header(self, context: bpy.types.Context) -> None:
        """The switch."""
        self.layout.prop(context.scene.stiv, "live_guard", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """The status of the scene."""
        layout = self.layout
        if not context.scene.stiv.live_guard:
            layout.label(text="Off: results are not corrected")
        elif (problem := watcher.problem()) is not None:
            draw_alert(layout, problem)
        else:
            layout.label(text="The scene is clear", icon="CHECKMARK")
        if watcher.uncorrected():
            layout.label(text=translate("Uncorrected results: {}").format(watcher.uncorrected()))


def draw_alert(layout: bpy.types.UILayout, problem: Problem) -> None:
    """The intersections in red, why they were not corrected, and what to do."""
    box = layout.box()
    box.alert = True
    box.label(text="The scene intersects", icon="ERROR")
    draw_lines(box, problem.headline(translate))
    draw_lines(box, "\n".join(problem.pair_lines(translate)))
    if problem.pairs and problem.reason:
        draw_lines(layout, translate("Not corrected: {}").format(problem.reason))
    column = layout.column(align=True)
    for name in OPERATORS:
        column.operator(name)
