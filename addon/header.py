# SPDX-License-Identifier: GPL-3.0-or-later
"""What the extension adds to the header of the 3D view."""

from __future__ import annotations

import bpy

from . import native_module
from .guard import icons, watcher


def draw(header: bpy.types.Header, context: bpy.types.Context) -> None:
    """Draw everything at the end of the header."""
    if not native_module.problem():
        draw_guard(header.layout, context)


def draw_guard(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """The state of the live guard as an icon that opens its panel; nothing while it is off."""
    state = watcher.state(context)
    if state != "off":
        layout.popover(panel="STIV_PT_guard_state", text="", icon_value=icons.icon(state))


def register() -> None:
    """Add to the header."""
    bpy.types.VIEW3D_HT_header.append(draw)


def unregister() -> None:
    """Remove from the header."""
    bpy.types.VIEW3D_HT_header.remove(draw)
    icons.remove()
