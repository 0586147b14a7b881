# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard with Shift+D, extrusions and a scene that intersects already, and its icon in the header."""

from __future__ import annotations

import bmesh
import bpy
import extension
import scenes
from guard_scenarios import at_rest, guarded, steps, with_tool
from playing import CLOSE, FURTHEST, INTO_WALL, NEAR, box_x, expect_free, expect_near
from scenes import WALL_FACE
from simulation import Steps, Window


def guard_duplicate(window: Window) -> Steps:
    """Shift+D into the wall: the copy stops on the side of its original, in one undo step."""
    yield from guarded(window, scenes.add_box, "Box")
    before = steps()
    yield from window.rest_at((0.0, 0.0, 0.0))
    window.key("D", shift=True)
    yield from window.until(lambda: len(window.handle.modal_operators) > 0, "Blender's tool")
    yield from window.glide(window.pixel((1.9, 0.0, 0.0)))
    window.key("LEFTMOUSE")
    yield from at_rest(window)
    copy = bpy.data.objects["Box.001"]
    expect_near(copy.location.x, FURTHEST, NEAR, "the copy at the wall")
    assert box_x() == 0.0, box_x()
    assert steps() == [*before, "'Duplicate Objects'"], steps()
    assert state() == "guarded", state()
    expect_free(window)
    window.picture("guard_duplicate")
    yield from window.undo()
    yield from at_rest(window)
    assert "Box.001" not in bpy.data.objects
    yield from window.redo()
    yield from at_rest(window)
    expect_near(bpy.data.objects["Box.001"].location.x, FURTHEST, NEAR, "the copy after redo")


def guard_duplicate_in_edit_mode(window: Window) -> Steps:
    """Shift+D of all vertices into the wall, in Edit Mode: the copy stops at it whole, in one undo step."""
    yield from guarded(window, scenes.add_box, "Box", "EDIT")
    with window.override():
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.ed.undo_push(message="selected")
    yield from at_rest(window)
    before, width = steps(), 2 * scenes.HALF
    yield from window.rest_at((0.0, 0.0, 0.0))
    window.key("D", shift=True)
    yield from window.until(lambda: len(window.handle.modal_operators) > 0, "Blender's tool")
    yield from window.glide(window.pixel((1.9, 0.0, 0.0)))
    window.key("LEFTMOUSE")
    yield from at_rest(window)
    expect_near(scenes.evaluated_extent("Box"), WALL_FACE, NEAR, "the copy at the wall")
    places = [vertex.co.x for vertex in bmesh.from_edit_mesh(bpy.context.object.data).verts]
    assert len(places) == 16, len(places)
    expect_near(max(places[8:]) - min(places[8:]), width, 1e-4, "the width of the copy")
    assert len(steps()) == len(before) + 1, steps()
    assert state() == "guarded", state()
    expect_free(window)
    window.picture("guard_duplicate_in_edit_mode")
    yield from window.undo()
    yield from at_rest(window)
    assert len(bmesh.from_edit_mesh(bpy.context.object.data).verts) == 8


def guard_extrude(window: Window) -> Steps:
    """E through the wall in Edit Mode: the extrusion stops at it, in one undo step."""
    yield from guarded(window, scenes.add_box, "Box", "EDIT")
    with window.override():
        content = bmesh.from_edit_mesh(bpy.context.object.data)
        bpy.ops.mesh.select_all(action="DESELECT")
        for face in content.faces:
            if face.calc_center_median().x > 0.4:
                face.select_set(True)
        bmesh.update_edit_mesh(bpy.context.object.data)
        bpy.ops.ed.undo_push(message="selected")
    yield from at_rest(window)
    before = steps()
    yield from with_tool(window, "E", (3.0, 0.0, 0.0))
    assert WALL_FACE - NEAR < scenes.evaluated_extent("Box") < WALL_FACE, scenes.evaluated_extent("Box")
    assert len(bmesh.from_edit_mesh(bpy.context.object.data).verts) == 12
    assert len(steps()) == len(before) + 1, steps()
    expect_free(window)
    assert state() == "guarded", state()
    window.picture("guard_extrude")
    yield from window.undo()
    yield from at_rest(window)
    assert len(bmesh.from_edit_mesh(bpy.context.object.data).verts) == 8
    yield from window.redo()
    yield from at_rest(window)
    assert WALL_FACE - NEAR < scenes.evaluated_extent("Box") < WALL_FACE, scenes.evaluated_extent("Box")
    expect_free(window)


def add_box_and_stuck_pair() -> object:
    """The box, and two others that intersect."""
    for name, place in (("Stuck", (-1.5, 1.5, 0.0)), ("Other", (-1.2, 1.8, 0.0))):
        scenes.add_mesh(name, lambda content: bmesh.ops.create_cube(content, size=0.8), place)
    return scenes.add_box()


def guard_one_bad_pair(window: Window) -> Steps:
    """Two objects intersect when the guard is turned on: they alone are left alone, in amber; apart, all is green."""
    yield from guarded(window, add_box_and_stuck_pair, "Box")
    assert state() == "partial", state()
    yield from open_popover(window)
    window.picture("guard_icon_amber")
    yield from close_popover(window)
    yield from with_tool(window, "G", INTO_WALL)
    expect_near(box_x(), FURTHEST, NEAR, "the box beside the intersecting pair")
    assert state() == "partial", state()
    scenes.select_only(bpy.data.objects["Stuck"])
    with window.override():
        bpy.ops.ed.undo_push(message="selected")
    yield from with_tool(window, "G", (-1.0, -1.4, 0.0))
    expect_near(bpy.data.objects["Stuck"].location.y, 0.1, CLOSE, "the parted object, moved freely")
    assert state() == "guarded", state()
    expect_free(window)
    yield from open_popover(window)
    window.picture("guard_icon_green")
    yield from close_popover(window)


def guard_red_icon(window: Window) -> Steps:
    """A copy left in the place of its original is marked in red; moved away, all is green again."""
    yield from guarded(window, scenes.add_box, "Box")
    yield from with_tool(window, "G", (-1.0, 0.0, 0.0))
    window.key("D", shift=True)
    yield from window.until(lambda: len(window.handle.modal_operators) > 0, "Blender's tool")
    window.key("ESC")
    yield from window.until(lambda: len(window.handle.modal_operators) == 0, "its end")
    yield from at_rest(window)
    assert state() == "intersecting", state()
    yield from open_popover(window)
    window.picture("guard_icon_red")
    yield from close_popover(window)
    yield from with_tool(window, "G", (1.2, 0.0, 0.0))
    assert state() == "guarded", state()
    expect_near(bpy.data.objects["Box.001"].location.x, 0.2, CLOSE, "the copy")


def guard_added(window: Window) -> Steps:
    """A primitive, a collection instance and a text added into the wall go to the nearest free place."""
    yield from guarded(window, scenes.add_box, "Box")
    for add, name in ((add_sphere, "Sphere"), (add_instance, "Asset"), (add_text, "Text")):
        with window.override():
            add()
            bpy.ops.ed.undo_push(message=f"Add {name}")
        yield from at_rest(window)
        assert state() == "guarded", (name, state(), extension.module("guard.watcher").problem())
        expect_free(window)
    window.picture("guard_added")


def add_sphere() -> None:
    """A sphere in the wall."""
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.4, location=(1.9, -1.0, 0.0))


def add_instance() -> None:
    """An instance of a collection in the wall, as from the asset browser."""
    cube = scenes.add_mesh("Inner", lambda content: bmesh.ops.create_cube(content, size=0.6))
    collection = bpy.data.collections.new("Asset")
    collection.objects.link(cube)
    bpy.context.collection.objects.unlink(cube)
    bpy.ops.object.collection_instance_add(name="Asset", location=(2.0, 1.0, 0.0))


def add_text() -> None:
    """A text with depth across the wall."""
    bpy.ops.object.text_add(location=(1.5, 0.0, 1.0))
    bpy.context.object.data.extrude = 0.05


def state() -> str:
    """The state that the icon shows."""
    return str(extension.module("guard.watcher").state(bpy.context))


def open_popover(window: Window) -> Steps:
    """Open the panel of the icon; its place in the header depends on the release and its language."""
    with window.override():
        bpy.ops.wm.call_panel(name="STIV_PT_guard_state", keep_open=True)
    yield from window.settle()
    assert extension.module("guard.icons").icon(state()) > 0


def close_popover(window: Window) -> Steps:
    """Close it."""
    window.key("ESC")
    yield from window.settle()


_ALL = (
    guard_duplicate,
    guard_duplicate_in_edit_mode,
    guard_extrude,
    guard_one_bad_pair,
    guard_red_icon,
    guard_added,
)
GUARD_NEW_GEOMETRY = {scenario.__name__: scenario for scenario in _ALL}
