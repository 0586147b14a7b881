# SPDX-License-Identifier: GPL-3.0-or-later
"""A morph of several seconds from its dialog: the window stays alive, Esc restores, a script gives the same result."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator
from typing import Any

import bpy
import extension
from guard_scenarios import steps
from morphing_drags import AT_WALL, prepare, value
from playing import ended, expect_free
from simulation import Steps, Window

SEGMENTS = 180  # of the ball: 32,000 triangles
LONG = 180.0  # seconds
LOOK = 1.0  # seconds: the longest that the morph may keep the window
MIDDLE = 40  # pixels left of the mouse, where the dialog has the middle of the first field
TITLE = 40  # pixels above the mouse, where the dialog has no field


def values() -> tuple[float, float]:
    """The values of both keys."""
    return value("Wide"), value("Tall")


def open_dialog(window: Window) -> Steps:
    """The dialog, with the mouse over the field of the first key."""
    yield from window.rest_at((0.0, 0.0, 0.0))
    with window.override():
        bpy.ops.stiv.morph("INVOKE_DEFAULT")
    yield from window.settle(10)


def confirm_dialog(window: Window) -> Steps:
    """The dialog with 1 typed as the value of the first key, and Return for OK."""
    yield from open_dialog(window)
    yield from window.glide((window.mouse[0] - MIDDLE, window.mouse[1]), 4)
    window.event("LEFTMOUSE", "PRESS")
    yield
    window.event("LEFTMOUSE", "RELEASE")
    yield from window.settle()
    yield from window.type("1")
    window.key("RET")
    yield from window.settle()
    window.picture("morph_dialog")
    yield from window.glide((window.mouse[0], window.mouse[1] + TITLE), 4)
    window.key("RET")
    yield from window.until(window.dragging, "a running morph")


def until_ended(window: Window) -> Steps:
    """Until the morph has ended; expects the start in each turn of Blender, and that the morph leaves it time for more.

    Prints the longest time between two turns, with all that Blender draws, and the longest of it in the morph.
    """
    looks = [0.0]
    began = last = time.perf_counter()
    longest, turns = 0.0, 0
    with timed_looks(looks):
        while window.dragging():
            assert values() == (0.0, 0.0), values()
            assert last - began < LONG, "never came: the end of the morph"
            yield 0.005
            now = time.perf_counter()
            longest, turns, last = max(longest, now - last), turns + 1, now
    print(
        f"  {last - began:.1f} s in {turns} turns, longest {longest:.2f} s, in the morph {max(looks):.2f} s", flush=True
    )
    assert turns > 8 and max(looks) < LOOK and longest < (last - began) / 3, (turns, max(looks), longest)


@contextlib.contextmanager
def timed_looks(seconds: list[float]) -> Iterator[None]:
    """Note the seconds of each event that the operator takes."""
    operator = extension.module("operators.task_operator").TaskOperator
    modal = operator.modal

    def noted(self: Any, context: Any, event: Any) -> Any:  # Blender counts the arguments
        began = time.perf_counter()
        try:
            return modal(self, context, event)
        finally:
            seconds.append(time.perf_counter() - began)

    operator.modal = noted
    try:
        yield
    finally:
        operator.modal = modal


def morphed_by_the_dialog(window: Window) -> Steps:
    """Esc in the dialog and later leaves everything; the end is one undo step, which the redo panel repeats."""
    yield from prepare(window, SEGMENTS)
    bpy.data.objects["Ball"].display_type = "BOUNDS"  # not to measure software rendering
    yield from window.settle()
    history = steps()
    yield from open_dialog(window)
    window.key("ESC")
    yield from window.settle()
    assert values() == (0.0, 0.0) and steps() == history
    yield from confirm_dialog(window)
    yield 1.0
    window.picture("morph_in_steps")
    assert window.dragging()
    window.key("ESC")
    yield from ended(window)
    assert values() == (0.0, 0.0) and steps() == history, (values(), history, steps())
    yield 1.0  # the job has seen it by now
    assert values() == (0.0, 0.0)
    yield from confirm_dialog(window)
    yield from until_ended(window)
    yield from window.settle()
    in_steps, messages = values(), extension.module("operators.reports").last_messages
    assert AT_WALL[0] < in_steps[0] < AT_WALL[1] and in_steps[1] == 0.0, in_steps
    assert messages[-1].startswith("STIV_OT_morph: INFO"), messages
    expect_free(window)
    assert len(steps()) == len(history) + 1, (history, steps())
    yield from repeated(window)
    yield from window.undo()
    assert values() == (0.0, 0.0)
    began = time.perf_counter()
    with window.override():
        bpy.ops.stiv.morph("EXEC_DEFAULT", True, keys=[{"name": "Wide", "value": 1.0}])
    print(f"  at once: a standstill of {time.perf_counter() - began:.1f} s", flush=True)
    assert values() == in_steps, (values(), in_steps)


def repeated(window: Window) -> Steps:
    """The redo panel repeats the morph at once, within its limit, in the same undo step."""
    history, operator = steps(), bpy.context.window_manager.operators[-1]
    assert operator.bl_idname == "STIV_OT_morph"
    operator.properties["keys"][0]["value"] = 0.25
    with window.override():
        bpy.ops.ed.undo_redo("EXEC_DEFAULT", True)
    yield from window.settle()
    assert values() == (0.25, 0.0) and steps() == history, (values(), history, steps())


def morphed_beside_the_guard(window: Window) -> Steps:
    """The live guard waits for the morph, and leaves its result as it is."""
    yield from prepare(window, SEGMENTS // 2)
    bpy.context.scene.stiv.live_transforms = True
    yield from window.settle(20)
    history = steps()
    yield from confirm_dialog(window)
    yield from ended(window)
    found = values()
    assert AT_WALL[0] < found[0] < AT_WALL[1], found
    yield from window.settle(20)
    assert values() == found and len(steps()) == len(history) + 1, (values(), found, history, steps())
    expect_free(window)
    bpy.context.scene.stiv.live_transforms = bpy.context.scene.stiv.live_guard = False


MORPHING_IN_STEPS = {each.__name__: each for each in (morphed_by_the_dialog, morphed_beside_the_guard)}
