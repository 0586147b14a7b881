# SPDX-License-Identifier: GPL-3.0-or-later
"""The redo panel after a drag: recomputed unchanged, and with a typed value."""

from __future__ import annotations

import bpy
import extension
import scenes
from guard_scenarios import steps
from playing import FURTHEST, NEAR, box, box_x, click, expect_free, expect_near, prepared, start
from simulation import CHARACTER_KEYS, Steps, Window

FIRST_NUMBER = (222, -51)  # pixels from the mouse to where the panel has it


def redo_panel(window: Window) -> Steps:
    """The redo panel reproduces the drag to the last bit, also around the end of the wall."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    for place in ((0.0, 2.8, 0.0), (2.9, 2.8, 0.0), (2.9, 0.4, 0.0)):
        yield from window.glide(window.pixel(place))
    yield from click(window)
    dragged = tuple(box().location)
    assert dragged[0] > 2.5 and dragged[1] < 1.0, dragged
    operator = bpy.context.window_manager.operators[-1]
    assert operator.bl_idname == "STIV_OT_move" and operator.outcome > 0
    with window.override():
        bpy.ops.ed.undo_redo("EXEC_DEFAULT", True)  # what a change in the panel does
    yield from window.settle()
    assert tuple(box().location) == dragged, (tuple(box().location), dragged)
    expect_free(window)
    yield from window.undo()
    assert box().location.length == 0.0


def redo_panel_is_limited(window: Window) -> Steps:
    """A solve that takes too long stops with a message; without the limit, the same one reaches the wall."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((0.3, 0.0, 0.0)))
    yield from click(window)
    limit, messages = extension.module("operators.transform.redo_limit"), extension.module("operators.reports")
    kept, limit.LIMIT = limit.LIMIT, -1
    try:
        yield from redone_with(window, 5.0)
        assert box_x() < FURTHEST - NEAR, box_x()
        assert "stopped after -1 seconds" in "".join(messages.last_messages), messages.last_messages
    finally:
        limit.LIMIT = kept
    expect_free(window)
    yield from redone_with(window, 5.0)
    expect_near(box_x(), FURTHEST, NEAR, "the box at the wall")


def redone_with(window: Window, value: float) -> Steps:
    """Repeat the last operator with another value, as the panel does."""
    bpy.context.window_manager.operators[-1].properties.value = (value, 0.0, 0.0)
    with window.override():
        bpy.ops.ed.undo_redo("EXEC_DEFAULT", True)
    yield from window.settle()


def redo_panel_by_mouse(window: Window) -> Steps:
    """F9, a click into the first number, another one typed: solved again from the start, still one undo step."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((0.7, 0.0, 0.0)))
    yield from click(window)
    yield from window.rest_at((0.0, 0.0, 0.0))
    history = steps()
    window.key("F9")
    yield from window.settle(10)
    window.picture("redo_panel_open")
    yield from click_into_first_number(window)
    for character in "32":
        window.key(CHARACTER_KEYS[character], character)
        yield
    window.picture("redo_panel_typing")
    window.key("RET")
    yield from window.until(lambda: box_x() > 1.0, "the drag with another value")
    yield from window.settle()
    window.picture("redo_panel_done")
    expect_near(box_x(), FURTHEST, NEAR, "the box at the wall")
    expect_free(window)
    assert steps() == history, (steps(), history)
    window.key("ESC")  # closes the panel; Blender 5.2's stays open when the mouse leaves it
    yield from window.settle()
    yield from window.undo()
    assert box_x() == 0.0, box_x()


def click_into_first_number(window: Window) -> Steps:
    """The panel opens with its title under the mouse; Blender tells nobody where its fields are."""
    x, y = window.mouse
    for offset in (0, 1):
        window.move(x + FIRST_NUMBER[0] + offset, y + FIRST_NUMBER[1])
        yield
    yield from window.settle()
    window.event("LEFTMOUSE", "PRESS")
    yield
    window.event("LEFTMOUSE", "RELEASE")
    yield from window.settle()


_ALL = (redo_panel, redo_panel_is_limited, redo_panel_by_mouse)
REDO_PANEL = {scenario.__name__: scenario for scenario in _ALL}
