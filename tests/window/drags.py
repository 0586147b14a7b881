# SPDX-License-Identifier: GPL-3.0-or-later
"""Drags in Object Mode: up to the wall and back, cancelled, by typed values, along axes; default keys."""

from __future__ import annotations

import math

import bpy
import extension
import scenes
from playing import FURTHEST, INTO_WALL, NEAR, box_x, click, expect_free, expect_near, prepared, start
from simulation import Steps, Window


def rigid_drag(window: Window) -> Steps:
    """A box against a wall: stops there, one undo step, redo reproduces the bits."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    expect_near(box_x(), FURTHEST, NEAR, "the box at the wall while dragging")
    window.picture("rigid_drag")
    yield from click(window)
    confirmed = box_x()
    expect_near(confirmed, FURTHEST, NEAR, "the box at the wall")
    expect_free(window)
    yield from window.undo()
    assert box_x() == 0.0, box_x()
    yield from window.redo()
    assert box_x() == confirmed, box_x()


def rigid_return(window: Window) -> Steps:
    """The mouse returns, and so does the box."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    yield from window.glide(window.pixel((0.5, 0.0, 0.0)))
    expect_near(box_x(), 0.5, 0.02, "the box under the mouse")
    yield from click(window)
    expect_free(window)


def cancelled_by(button: str) -> object:
    """A scenario: the button restores exactly, and leaves no undo step."""

    def scenario(window: Window) -> Steps:
        yield from prepared(window, scenes.add_box, "Box")
        before = [tuple(row) for row in bpy.data.objects["Box"].matrix_world]
        yield from start(window)
        yield from window.glide(window.pixel(INTO_WALL))
        assert box_x() > 1.0, box_x()
        yield from click(window, button)
        assert [tuple(row) for row in bpy.data.objects["Box"].matrix_world] == before
        assert bpy.data.objects["Box"].location.length == 0.0

    scenario.__name__ = f"cancelled_by_{button.lower()}"
    return scenario


def typed_value(window: Window) -> Steps:
    """Digits, a decimal point, backspace and minus, then Enter."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.type("0.79")
    window.key("BACK_SPACE")
    yield
    window.key("RET")
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    expect_near(box_x(), 0.7, 1e-6, "the typed value")
    yield from start(window)
    yield from window.type("1-")
    window.key("RET")
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    expect_near(box_x(), -0.3, 1e-6, "the typed negative value")
    yield from window.undo()
    expect_near(box_x(), 0.7, 1e-6, "after undo")


def typed_into_wall(window: Window) -> Steps:
    """A typed value through the wall ends in front of it."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.type("5")
    window.key("RET")
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    expect_near(box_x(), FURTHEST, NEAR, "the box at the wall")
    expect_free(window)


def axis_lock(window: Window) -> Steps:
    """X locks the box to the axis, Shift+X to the plane, and a third press unlocks it."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    window.key("X")
    yield from window.glide(window.pixel((0.8, 0.6, 0.0)))
    x, y, z = bpy.data.objects["Box"].location
    expect_near(x, 0.8, 0.02, "x along the axis")
    assert y == 0.0 and z == 0.0, (y, z)
    window.key("X", shift=True)
    yield from window.settle()
    x, y, z = bpy.data.objects["Box"].location
    expect_near(y, 0.6, 0.02, "y in the plane")
    expect_near(x, 0.0, 1e-5, "x across the plane")
    window.key("X", shift=True)
    yield from window.settle()
    window.key("X", shift=True)
    yield from window.settle()
    expect_near(box_x(), 0.8, 0.02, "x when free")
    yield from click(window)


def rotate_at_wall(window: Window) -> Steps:
    """A bar turned toward the wall."""
    yield from prepared(window, scenes.add_box, "Box")
    bpy.data.objects["Box"].scale.y = 4.0
    yield from window.settle()
    yield from start(window, "R")
    yield from window.type("30")
    window.key("RET")
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    expect_near(bpy.data.objects["Box"].rotation_euler.z, math.radians(30.0), 1e-5, "the angle")
    expect_free(window)


def line_to_pointer(window: Window) -> Steps:
    """A rotation and a scaling show a line from the pivot to the pointer; a move does not."""
    guides = extension.module("overlay.guides")
    for key in ("R", "E"):
        yield from prepared(window, scenes.add_box, "Box")
        yield from window.rest_at((0.8, 0.2, 0.0))
        yield from start(window, key)
        yield from window.glide(window.pixel((0.5, 1.0, 0.0)))
        (x, y), end = guides.shown().pointer_line
        pivot = window.pixel((0.0, 0.0, 0.0))
        expect_near(x + window.region.x, pivot[0], 1.0, "x of the pivot")
        expect_near(y + window.region.y, pivot[1], 1.0, "y of the pivot")
        assert (end[0] + window.region.x, end[1] + window.region.y) == window.mouse, (end, window.mouse)
        window.picture(f"line_to_pointer_{key}")
        window.key("G")
        yield from window.settle()
        assert guides.shown() is None, guides.shown()
        yield from click(window, "ESC")
        assert guides.shown() is None, guides.shown()


def scale_at_wall(window: Window) -> Steps:
    """A box scaled up until it would go through the wall."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window, "E")
    yield from window.type("6")
    window.key("RET")
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    assert bpy.data.objects["Box"].scale.x > 1.5, bpy.data.objects["Box"].scale
    expect_free(window)


def keys_are_free(window: Window) -> Steps:
    """Blender's default keymap of these modes and their windows uses no key of the extension outside its tools."""
    configurations = bpy.context.window_manager.keyconfigs
    around = {"Window", "Screen", "Screen Editing", "Frames", "3D View", "3D View Generic", "Object Non-modal"}
    clashes, count = [], 0
    for keymap in configurations.addon.keymaps:
        if keymap.name.startswith("3D View Tool: "):
            continue
        ours = [item for item in keymap.keymap_items if "stiv" in item.idname]
        taken = {
            (item.type, item.shift, item.ctrl, item.alt)
            for other in configurations.default.keymaps
            if not other.is_modal and other.name in {keymap.name, *around}
            for item in other.keymap_items
        }
        count += len(ours)
        clashes += [
            (keymap.name, item.idname) for item in ours if (item.type, item.shift, item.ctrl, item.alt) in taken
        ]
    assert count == 19, count
    assert not clashes, clashes
    yield


_ALL = (
    keys_are_free,
    rigid_drag,
    rigid_return,
    cancelled_by("ESC"),
    cancelled_by("RIGHTMOUSE"),
    typed_value,
    typed_into_wall,
    axis_lock,
    rotate_at_wall,
    line_to_pointer,
    scale_at_wall,
)
DRAGS = {scenario.__name__: scenario for scenario in _ALL}
