# SPDX-License-Identifier: GPL-3.0-or-later
"""A newcomer: opens the clothing example from the panel, and dresses the figure with its buttons."""

from __future__ import annotations

import time

import bpy
import scenes
from interface import in_small_window
from playing import click, expect_free
from simulation import Steps, Window

CLICKS, SECONDS = 6, 60.0  # a newcomer needs at most these, after installing
HEAD = 1.9  # height of the hat's start above the floor


def press(window: Window, operator: str, **properties: object) -> None:
    """Press a button of the panel."""
    module, name = operator.split(".")
    with window.override():
        getattr(getattr(bpy.ops, module), name)("INVOKE_DEFAULT", **properties)


def show_tab(window: Window) -> Steps:
    """The extension's tab of the sidebar."""
    yield from window.next_draw()  # the regions of a loaded file exist once they are drawn
    window.area.spaces.active.show_region_ui = True
    yield from window.next_draw()
    yield from window.settle()
    next(region for region in window.area.regions if region.type == "UI").active_panel_category = "STIV"
    window.area.tag_redraw()
    yield from window.settle()


def newcomer_dresses_the_figure(window: Window) -> Steps:
    """Open the example, two steps for the shirt, a drag for the hat."""
    begun = time.perf_counter()
    bpy.ops.stiv.open_example(example="dress_figure")  # no override: loading a file frees its window
    yield from window.until(lambda: "Ogre" in bpy.data.objects, "the example")
    yield from show_tab(window)
    yield from window.next_draw()
    window.picture("getting_started")
    for step in range(2):
        press(window, "stiv.example_step", step=step)
        yield from window.until(lambda: not window.dragging(), "the end of the step")
        yield from window.settle()
    scenes.look_from_corner(window.area)
    yield from window.rest_at((0.0, 0.0, HEAD))
    height = bpy.data.objects["Hat"].location.z
    press(window, "stiv.example_step", step=3)
    yield from window.until(window.dragging, "a running transform")
    yield from window.glide(window.pixel((0.0, 0.0, HEAD - 0.7)))
    yield from click(window)
    window.picture("getting_started_dressed")
    assert time.perf_counter() - begun < SECONDS
    assert bpy.data.objects["Hat"].location.z < height - 0.1
    assert bpy.data.filepath == ""
    expect_free(window)
    window.area.spaces.active.show_region_ui = False
    bpy.ops.wm.read_homefile(use_empty=True)
    yield from window.settle()


_ALL = (newcomer_dresses_the_figure, in_small_window(newcomer_dresses_the_figure))
GETTING_STARTED = {scenario.__name__: scenario for scenario in _ALL}
