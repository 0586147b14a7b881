# SPDX-License-Identifier: GPL-3.0-or-later
"""Disturbances of a drag: deletion, another mode, saving, an exception."""

from __future__ import annotations

import tempfile
from pathlib import Path

import bpy
import scenes
from playing import FURTHEST, INTO_WALL, NEAR, box, click, ended, expect_near, prepared, start
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
    original = BlenderEdit.drag

    def broken(*given: object, **named: object) -> None:
        raise RuntimeError("broken on purpose")

    BlenderEdit.drag = broken
    try:
        window.move(*window.pixel((0.8, 0.0, 0.0)))
        yield from ended(window)
    finally:
        BlenderEdit.drag = original
    assert box().location.length == 0.0
    assert not window.leftovers(), window.leftovers()


_ALL = (
    saved_during_drag,
    mode_changed,
    object_deleted,
    fault_within,
)
DISTURBED_DRAGS = {scenario.__name__: scenario for scenario in _ALL}
