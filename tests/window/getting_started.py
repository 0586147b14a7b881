# SPDX-License-Identifier: GPL-3.0-or-later
"""A newcomer: opens examples from the panel, and dresses, poses and morphs figures with their buttons."""

from __future__ import annotations

import math
import time

import bpy
import mathutils
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


def newcomer_poses_and_morphs(window: Window) -> Steps:
    """The arm of an example stops at its body, and the shirt of another one makes room for its body."""
    bpy.ops.stiv.open_example(example="pose_arm")
    yield from window.until(lambda: "Rig" in bpy.data.objects, "the example")
    yield from show_tab(window)
    scenes.look_from_above(window.area)
    view = window.area.spaces.active.region_3d
    view.view_rotation = mathutils.Euler((math.radians(90.0), 0.0, 0.0)).to_quaternion()
    view.update()
    yield from window.rest_at((1.5, 0.0, 1.35))
    press(window, "stiv.example_step", step=0)
    yield from window.until(window.dragging, "a running rotation")
    yield from window.glide(window.pixel((1.2, 0.0, 0.4)), 12)
    yield from window.glide(window.pixel((0.3, 0.0, -0.2)), 12)
    yield from window.settle(20)
    window.picture("example_pose_arm")
    yield from click(window)
    bone = bpy.data.objects["Rig"].pose.bones["Arm.L"]
    assert bpy.context.mode == "POSE" and 60 < math.degrees(bone.rotation_quaternion.angle) < 105
    bpy.ops.stiv.open_example(example="morph_body")
    yield from window.until(lambda: "Shirt" in bpy.data.objects, "the example")
    yield from show_tab(window)
    yield from window.rest_at((0.0, 0.0, 0.0))
    press(window, "stiv.example_step", step=0)
    yield from window.until(window.dragging, "a running drag")
    yield from window.glide((window.mouse[0] + 180, window.mouse[1]), 15)
    yield from window.settle(20)
    window.picture("example_morph_body")
    yield from click(window)
    key = bpy.data.objects["Body"].data.shape_keys.key_blocks["Heavier"]
    assert key.value > 0.8, key.value
    expect_free(window)
    window.area.spaces.active.show_region_ui = False
    bpy.ops.wm.read_homefile(use_empty=True)
    yield from window.settle()


_ALL = (newcomer_dresses_the_figure, in_small_window(newcomer_dresses_the_figure), newcomer_poses_and_morphs)
GETTING_STARTED = {scenario.__name__: scenario for scenario in _ALL}
