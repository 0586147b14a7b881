# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers for which 0 means automatic: a button "Auto" in place of the number.

Blender cannot draw text in a number field. Files and scripts store 0, as they always did.
"""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty

LABEL_WIDTH = 0.4  # fraction of a panel that Blender gives to the labels of properties


def AutomaticProperty(of: str, start: float, name: str, description: str) -> object:  # noqa: N802 (as Blender's own)
    """A switch that is on while the number `of` of the same owner is 0; turning it off sets the number to `start`."""

    def get(owner: bpy.types.bpy_struct) -> bool:
        return bool(getattr(owner, of) == 0)

    def turn(owner: bpy.types.bpy_struct, automatic: bool) -> None:
        setattr(owner, of, 0 if automatic else start)

    return BoolProperty(name=name, description=description, get=get, set=turn, options={"SKIP_SAVE", "HIDDEN"})


def draw_automatic(
    layout: bpy.types.UILayout, owner: object, number: str, switch: str, label: str, width: float = LABEL_WIDTH
) -> None:
    """The number, or the button "Auto" in its place."""
    split = layout.split(factor=width)
    text = split.row()
    text.alignment = "RIGHT"
    text.label(text=label)
    row = split.row(align=True)
    row.use_property_split = False
    if getattr(owner, switch):
        row.prop(owner, switch, text="Auto", toggle=True)
    else:
        row.prop(owner, number, text="")
        row.prop(owner, switch, text="", icon="X")
