# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapping and pivots in a drag."""

from __future__ import annotations

import math

import bpy
import scenes
from playing import CLOSE, NEAR, box, box_x, click, ended, expect_free, expect_near, prepared, start
from simulation import Steps, Window


def snap_to_steps(window: Window) -> Steps:
    """Ctrl held: snapping to increments; a rotation in increments of five degrees."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((0.83, 0.27, 0.0)), ctrl=True)
    steps = [coordinate * 10.0 for coordinate in box().location]
    assert all(abs(step - round(step)) < 1e-3 for step in steps) and box_x() > 0.5, steps
    window.key("R")
    yield from window.glide(window.pixel((0.3, 0.9, 0.0)), ctrl=True)
    degrees = math.degrees(box().rotation_euler.z) / 5.0
    assert abs(degrees - round(degrees)) < 1e-3 and round(degrees), degrees
    yield from click(window, "ESC")


def snap_to_vertex(window: Window) -> Steps:
    """The closest corner of the box moves to the block's corner, up to the minimum distance."""
    yield from prepared(window, scenes.add_target, "Box")
    tools = bpy.context.scene.tool_settings
    tools.snap_elements, tools.use_snap = {"VERTEX"}, True
    yield from window.rest_at((-0.5, 0.5, 0.0))  # so that this corner is the nearest one
    yield from start(window)
    yield from window.glide(window.pixel((-1.02, 1.02, 0.25)))
    window.picture("snap_to_vertex")
    expect_near(box_x(), -0.5, NEAR, "x of the box with its corner on the block's")
    expect_near(box().location.y, 0.5, NEAR, "y of the box with its corner on the block's")
    yield from click(window)
    expect_free(window)


def snap_to_face(window: Window) -> Steps:
    """The lower side of the box moves onto the block's upper face, and stops before it."""
    yield from prepared(window, scenes.add_target, "Box")
    tools = bpy.context.scene.tool_settings
    tools.snap_elements, tools.use_snap = {"FACE"}, True
    box().location.z = 2.0
    yield from window.settle()
    yield from start(window)
    yield from window.glide(window.pixel((-1.25, 1.25, 0.25)), steps=12)
    expect_near(box().location.z, 0.75, NEAR, "the box on the block")
    yield from click(window)
    assert box().location.z > 0.75
    expect_free(window)


def snap_base(window: Window) -> Steps:
    """B: the corner clicked first moves onto the block's corner, not the corner that is closest to it."""
    yield from prepared(window, scenes.add_target, "Box")
    tools = bpy.context.scene.tool_settings
    tools.snap_elements, tools.use_snap = {"VERTEX"}, False
    yield from start(window)
    window.key("B")
    yield from window.glide(window.pixel((0.45, 0.45, 0.5)))  # on the upper side: the lower corners are hidden
    assert box().location.length == 0.0, "the box moved while its snap base was picked"
    window.picture("snap_base")
    window.key("LEFTMOUSE")
    yield from window.settle()
    assert window.dragging(), "picking the snap base ended the drag"
    yield from window.glide(window.pixel((-1.05, 1.05, 0.25)), steps=12)
    for axis, expected in zip("xyz", (-1.5, 0.5, -0.25), strict=True):
        expect_near(getattr(box().location, axis), expected, NEAR, f"{axis} of the box with that corner on the block's")
    yield from click(window)
    assert not tools.use_snap, "the snap base switched the magnet on"
    expect_free(window)


def axis_by_middle_button(window: Window) -> Steps:
    """The middle button held picks the axis that the pointer follows, with Shift the plane; C frees it."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((0.8, 0.3, 0.0)))
    expect_near(box().location.y, 0.3, CLOSE, "y before an axis is picked")
    window.event("MIDDLEMOUSE", "PRESS")
    yield from window.settle()
    assert box().location.y == 0.0, "the X axis was not picked"
    yield from window.glide(window.pixel((0.3, 0.8, 0.0)))
    assert box_x() == 0.0, "the Y axis was not picked as the pointer followed it"
    window.event("MIDDLEMOUSE", "RELEASE")
    yield from window.glide(window.pixel((0.9, 0.4, 0.0)))
    assert box_x() == 0.0, "the axis was lost with the button"
    expect_near(box().location.y, 0.4, CLOSE, "y along the axis picked")
    window.key("C")
    yield from window.settle()
    expect_near(box_x(), 0.9, CLOSE, "x without the axis")
    window.event("MIDDLEMOUSE", "PRESS", shift=True)
    yield from window.settle()
    assert box_x() == 0.0, "the plane across X was not picked"
    window.event("MIDDLEMOUSE", "RELEASE", shift=True)
    yield from click(window, "ESC")
    assert box().location.length == 0.0, box().location


def pivot_at_cursor(window: Window) -> Steps:
    """The 3D cursor as pivot."""
    yield from prepared(window, scenes.add_box, "Box")
    scene = bpy.context.scene
    scene.tool_settings.transform_pivot_point, scene.cursor.location = "CURSOR", (-1.0, 0.0, 0.0)
    yield from start(window, "R")
    yield from window.type("90")
    window.key("RET")
    yield from ended(window)
    expect_near(box_x(), -1.0, 1e-5, "x after a quarter turn about the cursor")
    expect_near(box().location.y, 1.0, 1e-5, "y after a quarter turn about the cursor")


def individual_origins(window: Window) -> Steps:
    """Each object rotates about its own origin."""
    yield from prepared(window, scenes.add_pair, "Upper")
    bpy.context.scene.tool_settings.transform_pivot_point = "INDIVIDUAL_ORIGINS"
    bpy.data.objects["Lower"].select_set(True)
    yield from start(window, "R")
    yield from window.type("30")
    window.key("RET")
    yield from ended(window)
    for name, y in (("Upper", 1.0), ("Lower", -1.0)):
        obj = bpy.data.objects[name]
        expect_near(obj.location.y, y, 1e-6, f"y of {name}")
        expect_near(obj.rotation_euler.z, math.radians(30.0), 1e-5, f"turn of {name}")


_ALL = (
    snap_to_steps,
    snap_to_vertex,
    snap_to_face,
    snap_base,
    axis_by_middle_button,
    pivot_at_cursor,
    individual_origins,
)
SNAPPING_AND_PIVOTS = {scenario.__name__: scenario for scenario in _ALL}
