# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel for newcomers: examples with their steps, presets, the guide and the report."""

from __future__ import annotations

import bpy

from .. import manual
from ..getting_started import examples, presets, report
from ..translations import translate
from .base import SidebarPanel

PICTURE_SCALE = 4.0  # of an icon
COLUMNS = 3


class STIV_PT_getting_started(SidebarPanel, bpy.types.Panel):
    """Examples, presets, help."""

    bl_idname = "STIV_PT_getting_started"
    bl_label = "Getting Started"

    def draw(self, context: bpy.types.Context) -> None:
        """Steps of the open example, the examples, then buttons."""
        draw_steps(self.layout, context.scene)
        if examples.is_available():
            draw_examples(self.layout)
        column = self.layout.column(align=True)
        column.menu(presets.STIV_MT_presets.bl_idname, icon="PRESET")
        if manual.PAGE.is_file():
            column.operator("wm.url_open", text="User Guide", icon="HELP").url = manual.PAGE.as_uri()
        column.operator(report.STIV_OT_copy_report.bl_idname, icon="COPYDOWN")


def draw_steps(layout: bpy.types.UILayout, scene: bpy.types.Scene) -> None:
    """A button for each step of an example scene."""
    column = layout.column(align=True)
    for number, step in enumerate(examples.steps_of(scene)):
        text = f"{number + 1}. {translate(step.text)}"
        column.operator(examples.STIV_OT_example_step.bl_idname, text=text, translate=False, icon="PLAY").step = number


def draw_examples(layout: bpy.types.UILayout) -> None:
    """The pictures of the examples, each above its button."""
    row = layout.grid_flow(row_major=True, columns=COLUMNS, even_columns=True, align=True)
    for identifier, name, _ in examples.EXAMPLES:
        column = row.column(align=True)
        column.template_icon(examples.picture(identifier), scale=PICTURE_SCALE)
        column.operator(examples.STIV_OT_open_example.bl_idname, text=name).example = identifier
