# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard where it cannot correct: a projected mesh moved into the wall, named in red, taken back by a click."""

from __future__ import annotations

import bmesh
import bpy
import extension
import scenes
from guard_scenarios import at_rest, guarded, steps, with_tool
from guard_switch import open_tab
from playing import expect_free
from scenes import WALL_FACE
from simulation import Steps, Window

BUTTON = "Restore Before Collision"


def add_projected_box() -> object:
    """A box with a projection onto another object, which edits refuse, of a thousandth of a vertex."""
    box = scenes.add_box()
    box.vertex_groups.new(name="Wrapped").add([0], 0.001, "REPLACE")
    mould = scenes.add_mesh("Mould", lambda content: bmesh.ops.create_cube(content, size=0.2), (-2.0, 0.0, 0.0))
    projection = box.modifiers.new("Shrinkwrap", "SHRINKWRAP")
    projection.target, projection.vertex_group = mould, "Wrapped"
    return box


def guard_uncorrected(window: Window) -> Steps:
    """Moved in Edit Mode: the result stays, everything says so, and a click in the status bar takes it back."""
    watcher = extension.module("guard.watcher")
    yield from guarded(window, add_projected_box, "Box", "EDIT")
    with window.override():
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.ed.undo_push(message="selected")
    yield from at_rest(window)
    before, named = xs(), steps()
    yield from open_tab(window)
    yield from with_tool(window, "G", (WALL_FACE, 0.0, 0.0))
    assert watcher.problem().names == ["Box", "Wall"], watcher.problem()
    assert watcher.uncorrected() == 1, watcher.uncorrected()
    assert xs() != before, "the result of the tool is gone"
    window.picture("guard_uncorrected")
    yield from click_in_status_bar(window, lambda: watcher.problem() is None)
    assert xs() == before, xs()
    assert steps() == [*named, "'Move'", f"'{BUTTON}'"], (named, steps())
    expect_free(window)
    window.picture("guard_uncorrected_taken_back")
    yield from window.undo()
    yield from at_rest(window)
    assert watcher.problem().names == ["Box", "Wall"], watcher.problem()
    window.area.spaces.active.show_region_ui = False
    bpy.context.scene.stiv.live_guard = False
    yield from window.settle()
    assert not extension.module("overlay.display").content().alert


def click_in_status_bar(window: Window, is_done: object) -> Steps:
    """Click along the lowest row of the window, where the guard draws its button after the text, until it is done."""
    for x in range(300, window.handle.width, 40):
        window.move(x - 1, 10)
        yield
        window.move(x, 10)
        yield
        window.key("LEFTMOUSE")
        yield from at_rest(window)
        if is_done():
            return
    raise AssertionError("the status bar has no button")


def xs() -> list[float]:
    """The x of each vertex of the box."""
    box = bpy.data.objects["Box"]
    box.update_from_editmode()
    return [vertex.co.x for vertex in box.data.vertices]


GUARD_UNCORRECTED = {"guard_uncorrected": guard_uncorrected}
