# SPDX-License-Identifier: GPL-3.0-or-later
"""The grammar of a drag, gesture by gesture: kinds, numbers, axes, precision, views, repetition, yielding sides."""

from __future__ import annotations

import math

import bpy
import scenes
from playing import (
    CLOSE,
    FURTHEST,
    NEAR,
    box,
    box_x,
    click,
    ended,
    expect_free,
    expect_near,
    prepared,
    start,
)
from simulation import Steps, Window


def kinds_switch(window: Window) -> Steps:
    """G, R and S within one drag restart it; one undo reverts it, under the name of the last kind."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((0.3, 0.8, 0.0)))
    expect_near(box().location.y, 0.8, CLOSE, "moved")
    window.key("R")
    yield from window.settle()
    assert box().location.length < 1e-6, box().location
    yield from window.glide(window.pixel((-0.8, 0.3, 0.0)))
    turned = box().rotation_euler.z
    assert abs(turned) > 0.3, turned
    window.picture("kinds_switch")
    window.key("S")
    yield from window.settle()
    assert box().rotation_euler.z == 0.0 and box().scale.x > 1.0, (box().rotation_euler, box().scale)
    window.key("R")
    yield from window.settle()
    yield from click(window)
    expect_near(box().rotation_euler.z, turned, 1e-4, "turned as before")
    assert bpy.context.window_manager.operators[-1].bl_idname == "STIV_OT_rotate"
    expect_free(window)
    yield from window.undo()
    assert box().rotation_euler.z == 0.0 and box().location.length == 0.0
    yield from window.redo()
    expect_near(box().rotation_euler.z, turned, 1e-4, "after redo")


def typed_components(window: Window) -> Steps:
    """Numbers in all components, Tab between them."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.type("0.5\t0.25-\t2")
    window.key("RET")
    yield from ended(window)
    found = tuple(round(coordinate, 6) for coordinate in box().location)
    assert found == (0.5, -0.25, 2.0), found


def typed_expression(window: Window) -> Steps:
    """An expression with units; an invalid number cannot be confirmed."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.type("=50cm + 2*")
    window.key("RET")
    yield from window.settle()
    assert window.dragging(), "an unfinished expression was confirmed"
    yield from window.type("0.1m")
    window.key("RET")
    yield from ended(window)
    expect_near(box_x(), 0.7, 1e-6, "the value of the expression")


def local_axes(window: Window) -> Steps:
    """The same axis key again switches to the object's own axes."""
    yield from prepared(window, scenes.add_box, "Box")
    box().rotation_euler.z = math.radians(30.0)
    yield from window.settle()
    yield from start(window)
    for _ in range(2):
        window.key("Y")
        yield
    yield from window.type("1")
    window.key("RET")
    yield from ended(window)
    expect_near(box().location.x, -0.5, 1e-5, "x along the local axis")
    expect_near(box().location.y, math.sqrt(0.75), 1e-5, "y along the local axis")


def precision(window: Window) -> Steps:
    """Shift held: a tenth of the mouse's motion."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((1.0, 0.0, 0.0)), shift=True)
    expect_near(box_x(), 0.1, 0.01, "a tenth of the way")
    yield from click(window)


def view_navigation(window: Window) -> Steps:
    """The wheel zooms and the middle button turns the view during a drag, which continues with the mouse."""
    yield from prepared(window, scenes.add_box, "Box")
    view = window.area.spaces.active.region_3d
    yield from start(window)
    yield from window.glide(window.pixel((0.5, 0.5, 0.0)))
    distance = view.view_distance
    for _ in range(3):
        window.key("WHEELUPMOUSE")
        yield
    yield from window.settle()
    assert view.view_distance < distance, "the wheel did not zoom"
    yield from window.glide(window.pixel((0.6, 0.4, 0.0)))
    expect_near(box_x(), 0.6, CLOSE, "the box under the mouse in the zoomed view")
    window.event("MIDDLEMOUSE", "PRESS", alt=True)
    yield
    before = view.view_rotation.copy()
    yield from window.glide((window.mouse[0] + 60, window.mouse[1] + 30), 4)
    window.event("MIDDLEMOUSE", "RELEASE")
    yield from window.settle()
    assert view.view_rotation != before, "the middle button did not turn the view"
    assert window.dragging()
    yield from window.glide((window.mouse[0] + 40, window.mouse[1]), 4)
    window.picture("view_navigation")
    yield from click(window)
    assert box().location.length > 0.1
    expect_free(window)


def repeat_last(window: Window) -> Steps:
    """Shift+R applies the same value again, from where objects are now."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.type("0.5")
    window.key("RET")
    yield from ended(window)
    window.key("R", shift=True)
    yield from window.settle()
    expect_near(box_x(), 1.0, 1e-5, "moved twice")
    window.key("R", shift=True)
    yield from window.settle()
    expect_near(box_x(), FURTHEST, NEAR, "at the wall")
    expect_free(window)


def interference_switched(window: Window) -> Steps:
    """I lets the box pass through the wall; I again restores its last clear position."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((1.0, 0.0, 0.0)))
    window.key("I")
    yield from window.glide(window.pixel((1.8, 0.0, 0.0)))
    expect_near(box_x(), 1.8, CLOSE, "the box within the wall")
    window.key("I")
    yield from window.settle()
    assert box_x() < FURTHEST, box_x()
    yield from click(window)
    expect_free(window)


def others_yield(window: Window) -> Steps:
    """W: the wall, which may move, yields instead of the box."""
    yield from prepared(window, scenes.add_box, "Box")
    bpy.data.objects["Wall"].stiv.role = "rigid"
    yield from start(window)
    window.key("W")
    yield from window.glide(window.pixel((1.8, 0.0, 0.0)), steps=16)
    expect_near(box_x(), 1.8, CLOSE, "the box where it was put")
    assert bpy.data.objects["Wall"].location.x > 2.2, bpy.data.objects["Wall"].location
    yield from click(window)
    expect_free(window)


_ALL = (
    kinds_switch,
    typed_components,
    typed_expression,
    local_axes,
    precision,
    view_navigation,
    repeat_last,
    interference_switched,
    others_yield,
)
GRAMMAR = {scenario.__name__: scenario for scenario in _ALL}
