# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard with Blender's own G and S in the window: corrected at their end, undone in one step."""

from __future__ import annotations

import bpy
import extension
import scenes
from playing import FURTHEST, INTO_WALL, NEAR, box_x, expect_free, expect_near, prepared
from simulation import Steps, Window

BEYOND_WALL = (3.8, 0.0, 0.0)


def guarded(window: Window, build: object, active: str, mode: str = "OBJECT") -> Steps:
    """A scene of `scenes` with the guard turned on."""
    bpy.context.scene.stiv.live_guard = False
    yield from prepared(window, build, active, mode)
    bpy.context.scene.stiv.live_guard = True
    with window.override():
        bpy.ops.ed.undo_push(message="guard on")
    yield from at_rest(window)


def at_rest(window: Window) -> Steps:
    """Wait until the guard is at rest."""
    watcher = extension.module("guard.watcher")
    yield from window.settle()
    yield from window.until(lambda: not bpy.app.timers.is_registered(watcher.observe_and_act), "the guard at rest")
    yield from window.settle()


def with_tool(window: Window, key: str, target: tuple[float, float, float], confirm: str = "LEFTMOUSE") -> Steps:
    """One of Blender's own tools by its key, from the middle of the view to a place."""
    yield from window.rest_at((0.0, 0.0, 0.0))
    window.key(key)
    yield from window.until(lambda: len(window.handle.modal_operators) > 0, "Blender's tool")
    yield from window.glide(window.pixel(target))
    window.key(confirm)
    yield from window.until(lambda: len(window.handle.modal_operators) == 0, "the end of Blender's tool")
    yield from at_rest(window)


def steps() -> list[str]:
    """Names of all undo steps, without those that Blender skips."""
    printed = extension.module("guard.undo_steps")._printed()
    names = [line.split("name=")[1] for line in printed.splitlines() if "name=" in line]
    return [name for name in names if not name.startswith("'MemFile Internal")]


def guard_move(window: Window) -> Steps:
    """Blender's G into the wall: uncorrected while it runs, corrected at its end, undone and redone in one step."""
    yield from guarded(window, scenes.add_box, "Box")
    before = steps()
    yield from window.rest_at((0.0, 0.0, 0.0))
    window.key("G")
    yield from window.glide(window.pixel(INTO_WALL))
    assert box_x() > FURTHEST + 0.5, f"the guard fights the tool: {box_x()}"
    window.picture("guard_while_tool_runs")
    window.key("LEFTMOUSE")
    yield from window.until(lambda: len(window.handle.modal_operators) == 0, "the end of Blender's tool")
    yield from at_rest(window)
    window.picture("guard_corrected")
    corrected = box_x()
    expect_near(corrected, FURTHEST, NEAR, "the box after the guard")
    assert steps() == [*before, "'Move'"], steps()
    expect_free(window)
    yield from window.undo()
    yield from at_rest(window)
    assert box_x() == 0.0, box_x()
    yield from window.redo()
    yield from at_rest(window)
    assert box_x() == corrected, box_x()
    expect_free(window)


def guard_through_wall(window: Window) -> Steps:
    """Through the wall and beyond: no path exists, and the box stays in front of it."""
    yield from guarded(window, scenes.add_box, "Box")
    yield from with_tool(window, "G", BEYOND_WALL)
    expect_near(box_x(), FURTHEST, NEAR, "the box in front of the wall")
    yield from with_tool(window, "G", (-1.0, 0.0, 0.0))
    expect_near(box_x(), FURTHEST - 1.0, 0.05, "the box moved away again")
    expect_free(window)


def guard_scale(window: Window) -> Steps:
    """Blender's S beside the wall."""
    yield from guarded(window, scenes.add_box, "Box")
    yield from window.rest_at((0.6, 0.0, 0.0))
    window.key("S")
    yield from window.glide(window.pixel(INTO_WALL))
    window.key("LEFTMOUSE")
    yield from at_rest(window)
    assert bpy.data.objects["Box"].scale.x > 1.5, bpy.data.objects["Box"].scale
    expect_free(window)
    yield from window.undo()
    yield from at_rest(window)
    assert bpy.data.objects["Box"].scale.x == 1.0, bpy.data.objects["Box"].scale


def guard_touching(window: Window) -> Steps:
    """A box that touches the wall is guarded against it: along it, G stays exact; into it, the box only slides."""

    def build() -> None:
        scenes.add_box().location.x = FURTHEST

    yield from guarded(window, build, "Box")
    watcher = extension.module("guard.watcher")
    assert watcher.state(bpy.context) == "guarded", watcher.state(bpy.context)
    before = box_x()
    yield from window.rest_at((0.0, 0.0, 0.0))
    window.key("G")
    yield from window.until(lambda: len(window.handle.modal_operators) > 0, "Blender's tool")
    yield from window.type("y0.5")
    window.key("RET")
    yield from window.until(lambda: len(window.handle.modal_operators) == 0, "the end of Blender's tool")
    yield from at_rest(window)
    assert (box_x(), bpy.data.objects["Box"].location.y) == (before, 0.5), bpy.data.objects["Box"].location
    yield from with_tool(window, "G", (1.5, 0.5, 0.0))
    window.picture("guard_touching")
    expect_near(box_x(), before, 1e-4, "the box at the wall")
    expect_near(bpy.data.objects["Box"].location.y, 1.0, 0.05, "the box that has slid")
    assert watcher.state(bpy.context) == "guarded", watcher.state(bpy.context)
    yield from window.undo()
    yield from at_rest(window)
    assert (box_x(), bpy.data.objects["Box"].location.y) == (before, 0.5), bpy.data.objects["Box"].location


def guard_cancelled_tool(window: Window) -> Steps:
    """A tool that is cancelled leaves nothing to correct, and no step."""
    yield from guarded(window, scenes.add_box, "Box")
    before = steps()
    yield from with_tool(window, "G", INTO_WALL, "ESC")
    assert box_x() == 0.0, box_x()
    assert steps() == before, steps()


def guard_redo_panel(window: Window) -> Steps:
    """The redo panel runs a tool again with other values: corrected again, still one step."""
    yield from guarded(window, scenes.add_box, "Box")
    before = steps()
    yield from with_tool(window, "G", (0.7, 0.0, 0.0))
    with window.override():
        operator = bpy.context.window_manager.operators[-1]
        operator.properties.value = (4.0, 0.0, 0.0)
        bpy.ops.ed.undo_redo("EXEC_DEFAULT", True)  # with undo, as the panel does it
    yield from at_rest(window)
    expect_near(box_x(), FURTHEST, NEAR, "the box after the tool was run again")
    expect_free(window)
    assert len(steps()) == len(before) + 1, steps()


_ALL = (
    guard_touching,
    guard_move,
    guard_through_wall,
    guard_scale,
    guard_cancelled_tool,
    guard_redo_panel,
)
GUARD = {scenario.__name__: scenario for scenario in _ALL}
