# SPDX-License-Identifier: GPL-3.0-or-later
"""Disturbances of a drag: deletion, another mode, saving, an exception."""

from __future__ import annotations

import tempfile
from pathlib import Path

import bpy
import extension
import scenes
from playing import CLOSE, FURTHEST, INTO_WALL, NEAR, box, click, ended, expect_near, prepared, start
from simulation import Steps, Window


def object_deleted(window: Window) -> Steps:
    """The dragged object disappears: the drag ends by itself."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((0.5, 0.0, 0.0)))
    bpy.data.objects.remove(bpy.data.objects["Box"])
    window.move(*window.pixel((0.8, 0.0, 0.0)))
    yield from window.until(lambda: not window.dragging(), "the end of the transform")


def mode_changed(window: Window) -> Steps:
    """Edit Mode is left during the drag: it ends and the cage is unchanged."""
    yield from prepared(window, scenes.add_cage, "Cage", "EDIT")
    before = scenes.evaluated_extent("Cage")
    yield from start(window)
    yield from window.glide(window.pixel((0.5, 0.0, 0.0)))
    with window.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    window.move(*window.pixel((0.8, 0.0, 0.0)))
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    yield from window.settle()
    assert scenes.evaluated_extent("Cage") == before


def saved_during_drag(window: Window) -> Steps:
    """A file saved during a drag holds the last accepted state."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    path = str(Path(tempfile.mkdtemp()) / "during drag.blend")
    with window.override():
        bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    yield from click(window, "ESC")
    with bpy.data.libraries.load(path) as (_, wanted):
        wanted.objects = ["Box"]
    expect_near(wanted.objects[0].location.x, FURTHEST, NEAR, "the box in the file")
    bpy.data.objects.remove(wanted.objects[0])


def fault_within(window: Window) -> Steps:
    """An exception in the middle of a drag: everything is restored, nothing stays behind."""
    from stiv.blender import BlenderEdit

    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((0.5, 0.0, 0.0)))
    original = BlenderEdit.drag_steps

    def broken(*given: object, **named: object) -> None:
        raise RuntimeError("broken on purpose")

    BlenderEdit.drag_steps = broken
    try:
        window.move(*window.pixel((0.8, 0.0, 0.0)))
        yield from ended(window)
    finally:
        BlenderEdit.drag_steps = original
    assert box().location.length == 0.0
    assert not window.leftovers(), window.leftovers()


def disabled_during_drag(window: Window) -> Steps:
    """The extension is disabled during a drag: the start is restored, and nothing stays behind."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    expect_near(box().location.x, FURTHEST, NEAR, "the box before")
    window.picture("disabled_during_drag_before")
    with window.override():
        bpy.ops.preferences.addon_disable(module=extension.NAME)
    try:
        assert box().location.length == 0.0, box().location
        window.move(*window.pixel((0.8, 0.0, 0.0)))  # Blender frees the operator at the next event
        yield from window.settle()
        assert not window.handle.modal_operators and not window.leftovers(), window.leftovers()
        assert box().location.length == 0.0, box().location
        window.picture("disabled_during_drag_after")
    finally:
        with window.override():
            bpy.ops.preferences.addon_enable(module=extension.NAME)
    yield from window.settle()


def two_windows(window: Window) -> Steps:
    """A drag in a second window is refused until the first one ends, so that Esc undoes nothing of the other."""
    yield from prepared(window, scenes.add_box, "Box")
    with window.override():
        bpy.ops.wm.window_new()
    second = bpy.context.window_manager.windows[1]
    try:
        yield from window.settle()
        yield from start(window)
        yield from window.glide(window.pixel((0.5, 0.0, 0.0)))
        assert refused(second)
        yield from click(window)
        confirmed = box().location.x
        expect_near(confirmed, 0.5, CLOSE, "the box after the first drag")
        assert not refused(second)
        yield from window.until(lambda: len(second.modal_operators) == 1, "a drag in the second window")
        second.event_simulate(type="ESC", value="PRESS", x=10, y=10)
        yield from window.until(lambda: not second.modal_operators, "its end")
        assert box().location.x == confirmed, box().location
    finally:
        with bpy.context.temp_override(window=second):
            bpy.ops.wm.window_close()
    yield from window.settle()


def refused(window: bpy.types.Window) -> bool:
    """Whether a window cannot begin a drag."""
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        if not bpy.ops.stiv.move.poll():
            return True
        bpy.ops.stiv.move("INVOKE_DEFAULT")
    return not window.modal_operators


_ALL = (
    disabled_during_drag,
    two_windows,
    saved_during_drag,
    mode_changed,
    object_deleted,
    fault_within,
)
DISTURBED_DRAGS = {scenario.__name__: scenario for scenario in _ALL}
