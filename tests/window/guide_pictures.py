# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of the user guide, taken while the extension is used: panel, and drags seen from a corner."""

from __future__ import annotations

import bpy
import scenes
from playing import click, expect_free, prepared, start
from simulation import Steps, Window


def guide_panel(window: Window) -> Steps:
    """The tab in the sidebar, after a check."""
    yield from prepared(window, scenes.add_box, "Box")
    scenes.look_from_corner(window.area)
    window.area.spaces.active.show_region_ui = True
    yield from window.settle()
    sidebar = next(region for region in window.area.regions if region.type == "UI")
    sidebar.active_panel_category = "STIV"
    expect_free(window)
    window.area.tag_redraw()
    yield from window.settle()
    window.picture("guide_panel")
    window.area.spaces.active.show_region_ui = False
    yield from window.settle()


def guide_drag(window: Window) -> Steps:
    """A smooth ball in a lattice pressed against the wall."""
    yield from prepared(window, scenes.add_ball_in_lattice, "Lattice")
    bpy.context.scene.stiv.object_response = "deform"
    scenes.look_from_corner(window.area)
    yield from window.settle()
    yield from window.rest_at((0.0, 0.0, 0.0))
    yield from start(window)
    window.key("X")
    yield from window.glide(window.pixel((1.9, 0.0, 0.0)))
    bpy.context.preferences.system.viewport_aa = "8"
    yield from window.next_draw()
    window.picture("guide_drag")
    bpy.context.preferences.system.viewport_aa = "OFF"
    yield from click(window)
    expect_free(window)


PICTURES = {"guide_panel": guide_panel, "guide_drag": guide_drag}
