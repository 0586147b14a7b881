# SPDX-License-Identifier: GPL-3.0-or-later
"""The header of the 3D view: a switch beside Snap, and the state of the live guard.

Blender draws orientation, pivot, Snap and proportional editing in one function, which this extends; menus and panels
could only be added at the ends of the header.
"""

from __future__ import annotations

from collections.abc import Callable

import bpy

from . import native_module
from .guard import icons, watcher
from .operators.transform.transform_operator import MODES

Draw = Callable[[bpy.types.UILayout, bpy.types.Context], None]

_blender_draw: list[Draw] = []  # Blender's function, while it is extended


def draw_beside_snap(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw Blender's buttons, then the switch and the guard in the modes that have the switch."""
    for draw_buttons in _blender_draw:
        draw_buttons(layout, context)
    if context.mode in MODES and not native_module.problem():
        row = layout.row(align=True)
        draw_switch(row, context)
        draw_guard(row, context)


def draw_at_end(header: bpy.types.Header, context: bpy.types.Context) -> None:
    """Draw the guard in other modes."""
    if context.mode not in MODES and not native_module.problem():
        draw_guard(header.layout, context)


def draw_switch(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """The switch that lets Blender's own transforms collide."""
    layout.prop(context.scene.stiv, "live_transforms", text="", icon="MOD_PHYSICS")


def draw_guard(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """The state of the live guard as an icon that opens its panel; nothing while it is off."""
    state = watcher.state(context)
    if state != "off":
        layout.popover(panel="STIV_PT_guard_state", text="", icon_value=icons.icon(state))


def register() -> None:
    """Extend Blender's function, and add to the header."""
    header = bpy.types.VIEW3D_HT_header
    header.append(draw_at_end)
    _blender_draw.append(header.draw_xform_template)
    header.draw_xform_template = staticmethod(draw_beside_snap)


def unregister() -> None:
    """Restore Blender's function, and remove from the header."""
    header = bpy.types.VIEW3D_HT_header
    header.draw_xform_template = staticmethod(_blender_draw.pop())
    header.remove(draw_at_end)
    icons.remove()
