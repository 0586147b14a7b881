# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard with a stroke of Blender's sculpt mode."""

from __future__ import annotations

import bpy
import scenes
from guard_scenarios import at_rest, guarded, steps
from playing import INTO_WALL, expect_free
from scenes import WALL_FACE
from simulation import Steps, Window

RADIUS = 60  # pixels of the brush


def sculpting(window: Window) -> None:
    """Sculpt Mode with the grab brush."""
    with window.override():
        bpy.ops.object.mode_set(mode="SCULPT")
        grab_with_own_brush()
        paint = bpy.context.tool_settings.sculpt
        for axis in "xyz":
            setattr(bpy.context.object.data, f"use_mirror_{axis}", False)
        settings = getattr(paint, "unified_paint_settings", None) or bpy.context.tool_settings.unified_paint_settings
        settings.size = RADIUS
        bpy.ops.ed.undo_push(message="sculpting")


def grab_with_own_brush() -> None:
    """Debian's Blender has no brushes."""
    brush = bpy.data.brushes.get("Grab") or bpy.data.brushes.new("Grab", mode="SCULPT")
    setattr(brush, "sculpt_tool" if hasattr(brush, "sculpt_tool") else "sculpt_brush_type", "GRAB")
    brush.asset_mark()
    bpy.ops.brush.asset_activate(asset_library_type="LOCAL", relative_asset_identifier="Brush/Grab")


def stroke(window: Window, target: tuple[float, float, float]) -> Steps:
    """With the button held, from the right side of the ball to a place."""
    yield from window.rest_at((0.35, 0.0, 0.0))
    window.event("LEFTMOUSE", "PRESS")
    yield from window.glide(window.pixel(target), steps=12)
    window.event("LEFTMOUSE", "RELEASE")
    yield from window.until(lambda: len(window.handle.modal_operators) == 0, "the end of the stroke")


def guard_sculpt_stroke(window: Window) -> Steps:
    """A grab from the ball into the wall: uncorrected during the stroke, corrected after it, one undo step."""
    yield from guarded(window, scenes.add_ball, "Ball")
    before = scenes.evaluated_extent("Ball")
    sculpting(window)
    yield from at_rest(window)
    history = steps()
    yield from stroke(window, INTO_WALL)
    yield from at_rest(window)
    assert len(steps()) == len(history) + 1, (history, steps())
    window.picture("guard_sculpt_stroke")
    assert before + 0.5 < scenes.evaluated_extent("Ball") < WALL_FACE, scenes.evaluated_extent("Ball")
    expect_free(window)
    yield from window.undo()
    yield from at_rest(window)
    assert abs(scenes.evaluated_extent("Ball") - before) < 1e-6, scenes.evaluated_extent("Ball")
    yield from window.redo()
    yield from at_rest(window)
    assert scenes.evaluated_extent("Ball") < WALL_FACE, scenes.evaluated_extent("Ball")
    expect_free(window)
    bpy.context.scene.stiv.live_guard = False


GUARD_SCULPTING = {"guard_sculpt_stroke": guard_sculpt_stroke}
