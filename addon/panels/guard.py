# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard: its switch, and what to do where it cannot act."""

from __future__ import annotations

import bpy

from ..guard import watcher
from ..guard.problem import Problem
from ..translations import say
from .base import SubPanel, draw_lines

WAYS_OUT = ("stiv.guard_revert", "stiv.check", "stiv.repair", "stiv.exclude_intersections")


class STIV_PT_guard(SubPanel, bpy.types.Panel):
    """Watches over every tool of Blender."""

    bl_idname = "STIV_PT_guard"
    bl_label = "Live Guard"

    def draw_header(self, context: bpy.types.Context) -> None:
        """The switch."""
        self.layout.prop(context.scene.stiv, "live_guard", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """What it does, or why it cannot."""
        layout = self.layout
        if not context.scene.stiv.live_guard:
            layout.label(text="Off: results are not corrected")
        elif (problem := watcher.problem()) is not None:
            draw_alert(layout, problem)
        else:
            layout.label(text="The scene is clear", icon="CHECKMARK")
        if watcher.uncorrected():
            layout.label(text=say("Uncorrected results: {}").format(watcher.uncorrected()))


def draw_alert(layout: bpy.types.UILayout, problem: Problem) -> None:
    """What intersects, in red, why that was not corrected, and the ways out."""
    box = layout.box()
    box.alert = True
    box.label(text="The scene intersects", icon="ERROR")
    draw_lines(box, problem.headline(say))
    draw_lines(box, "\n".join(problem.pair_lines(say)))
    if problem.pairs and problem.reason:
        draw_lines(layout, say("Not corrected: {}").format(problem.reason))
    column = layout.column(align=True)
    for name in WAYS_OUT:
        column.operator(name)
