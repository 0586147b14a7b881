# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard turned on in an intersecting scene, and turned off."""

from __future__ import annotations

import bpy
import extension
import scenes
from guard_scenarios import at_rest, guarded, with_tool
from playing import FURTHEST, INTO_WALL, NEAR, box_x, expect_near, prepared
from scenes import WALL_FACE
from simulation import Steps, Window


def guard_intersecting(window: Window) -> Steps:
    """Turned on in an intersecting scene: it reports it, writes nothing, and starts once the scene is clear."""
    watcher = extension.module("guard.watcher")
    bpy.context.scene.stiv.live_guard = False
    yield from prepared(window, scenes.add_box, "Box")
    bpy.data.objects["Box"].location.x = WALL_FACE
    bpy.context.scene.stiv.live_guard = True
    yield from at_rest(window)
    assert watcher.problem().names == ["Box", "Wall"], watcher.problem()
    yield from open_tab(window)
    window.picture("guard_intersecting")
    window.area.spaces.active.show_region_ui = False
    yield from with_tool(window, "G", (-1.5, 0.0, 0.0))
    assert watcher.problem() is None, watcher.problem()
    yield from with_tool(window, "G", INTO_WALL)
    expect_near(box_x(), FURTHEST, NEAR, "the box after the guard took over")
    bpy.context.scene.stiv.live_guard = False


def open_tab(window: Window) -> Steps:
    """Show the extension's tab, after the sidebar is drawn."""
    window.area.spaces.active.show_region_ui = True
    yield from window.settle()
    next(region for region in window.area.regions if region.type == "UI").active_panel_category = "STIV"
    window.area.tag_redraw()  # else the picture still has the tab before
    yield from window.settle()


def guard_leaves_nothing(window: Window) -> Steps:
    """After it is turned off, no timer and no message stay, and results are not corrected."""
    watcher = extension.module("guard.watcher")
    yield from guarded(window, scenes.add_box, "Box")
    bpy.context.scene.stiv.live_guard = False
    yield from window.settle()
    assert not bpy.app.timers.is_registered(watcher.observe_and_act)
    window.key("G")
    yield from window.glide(window.pixel((WALL_FACE, 0.0, 0.0)))
    window.key("LEFTMOUSE")
    yield from window.settle()
    assert box_x() > FURTHEST + 0.1, box_x()


GUARD_SWITCH = {scenario.__name__: scenario for scenario in (guard_intersecting, guard_leaves_nothing)}
