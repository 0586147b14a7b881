# SPDX-License-Identifier: GPL-3.0-or-later
"""Drags that cannot start: the popups and their buttons. And starts that touch, or intersect themselves."""

from __future__ import annotations

import math

import bmesh
import bpy
import scenes
from mathutils import Matrix, Vector
from playing import FURTHEST, INTO_WALL, NEAR, box, box_x, click, ended, expect_free, expect_near, prepared, start
from scenes import HALF, WALL_FACE
from simulation import Steps, Window

INSIDE = WALL_FACE - 0.3  # of the box's center: the box reaches through the wall's face


def in_the_wall(window: Window) -> Steps:
    """A box that cuts the wall, and the key that moves it: a popup instead of a drag."""
    yield from prepared(window, scenes.add_box, "Box")
    bpy.data.objects["Box"].location.x = INSIDE
    with window.override():
        bpy.ops.ed.undo_push(message="box in the wall")
    yield from window.settle()
    yield from window.rest_at((-1.0, 0.0, 0.0))
    window.key("M", shift=True, alt=True)
    yield from popup_opened(window)
    expect_near(box_x(), INSIDE, 1e-6, "the box that has not moved")


def popup_opened(window: Window) -> Steps:
    """Wait for the popup, which opens when the mouse rests."""
    yield from window.settle()
    yield from window.until(lambda: not window.dragging(), "a popup")
    yield from window.settle()


def start_popup_of_moving_mouse(window: Window) -> Steps:
    """The popup waits while the mouse moves, takes no key from Blender, and its title stays in the status bar."""
    yield from in_the_wall(window)
    window.key("ESC")
    yield from window.settle()
    window.key("M", shift=True, alt=True)
    yield from window.glide(window.pixel((-2.0, 1.0, 0.0)), steps=12)
    window.picture("start_popup_moved")
    yield from popup_opened(window)
    window.key("L")
    yield from window.settle()
    assert len(bpy.context.scene.stiv.passing_pairs) == 1
    bpy.context.scene.stiv.passing_pairs.clear()
    window.key("M", shift=True, alt=True)
    window.move(*window.pixel((-1.5, 0.0, 0.0)))
    window.key("X")  # would open Blender's menu to delete
    yield from popup_opened(window)
    window.key("L")
    yield from window.settle()
    assert len(bpy.context.scene.stiv.passing_pairs) == 1 and "Box" in bpy.data.objects
    bpy.context.scene.stiv.passing_pairs.clear()


def start_popup_separate(window: Window) -> Steps:
    """The popup names the objects; its button Separate parts them in one undo step, and the drag works."""
    yield from in_the_wall(window)
    window.picture("start_popup")
    window.key("S")  # the letter that the menu underlines
    yield from window.until(lambda: box_x() < INSIDE - 1e-3 and not window.dragging(), "the separation", 60.0)
    yield from window.settle()
    expect_near(box_x(), FURTHEST, 0.01, "the box beside the wall")
    expect_free(window)
    yield from start(window)
    yield from window.glide(window.pixel((-2.0, 0.0, 0.0)))
    yield from click(window)
    assert box_x() < FURTHEST - 0.5, box_x()


def start_popup_let_pass(window: Window) -> Steps:
    """Let These Pass: the box then moves through the wall, and the panel lists the pair."""
    yield from in_the_wall(window)
    window.key("L")
    yield from window.settle()
    assert len(bpy.context.scene.stiv.passing_pairs) == 1
    window.area.spaces.active.show_region_ui = True
    yield from start(window)
    yield from window.glide(window.pixel((0.5, 1.0, 0.0)))
    yield from click(window)
    window.picture("start_let_pass")
    assert abs(box_x() - INSIDE) > 0.3, box_x()
    bpy.context.scene.stiv.passing_pairs.clear()
    window.area.spaces.active.show_region_ui = False


def start_suzanne(window: Window) -> Steps:
    """Suzanne, whose eyes cut her face, is deformed by a drag against the wall."""

    def monkey() -> None:
        bpy.ops.mesh.primitive_monkey_add(size=1.0)
        bpy.context.scene.stiv.object_response = "deform"

    yield from prepared(window, monkey, "Suzanne")
    yield from start(window)
    yield from window.glide(window.pixel((1.6, 0.0, 0.0)))
    window.picture("start_suzanne")
    yield from click(window)
    assert "itself" in bpy.context.window_manager.stiv_check.summary
    vertices = bpy.data.objects["Suzanne"].data.vertices
    assert max(vertex.co.x for vertex in vertices) > 0.9


def start_touching(window: Window) -> Steps:
    """A box that touches the wall slides along it without a question, and leaves it."""

    def build() -> None:
        scenes.add_box().location.x = FURTHEST

    yield from prepared(window, build, "Box")
    before = box_x()
    yield from start(window)
    yield from window.glide(window.pixel((1.0, 1.0, 0.0)))
    expect_near(box_x(), before, 1e-4, "the box beside the wall")
    expect_near(box().location.y, 1.0, 0.05, "the box that slides")
    window.picture("start_touching")
    yield from window.glide(window.pixel((-1.0, 1.0, 0.0)))
    assert box_x() < before - 0.8, box_x()
    window.key("ESC")
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    assert box_x() == before, (box_x(), before)
    yield from window.rest_at((0.0, 0.0, 0.0))
    yield from start(window)
    yield from window.glide(window.pixel((1.0, 1.0, 0.0)))
    yield from click(window)
    expect_near(box().location.y, 1.0, 0.05, "the box that has slid")
    expect_free(window)
    yield from window.undo()
    assert box_x() == before, (box_x(), before)


def turned_with_the_box(window: Window, other: bpy.types.Object, picture: str) -> Steps:
    """Turn the box and another object by a typed angle, which both reach."""
    other.select_set(True)
    with window.override():
        bpy.ops.ed.undo_push(message="both")
    yield from window.settle()
    yield from start(window, "R")
    yield from window.type("40")
    yield from window.settle()
    window.picture(picture)
    window.key("RET")
    yield from ended(window)
    for obj in (box(), other):
        expect_near(math.degrees(obj.rotation_euler.z), 40.0, 1e-3, f"the angle of {obj.name}")


def start_touching_each_other(window: Window) -> Steps:
    """Two boxes, one on the other, both selected: they turn by a typed angle at once, and the wall stops both."""

    def build() -> None:
        scenes.add_box()
        scenes.add_mesh("Upper", lambda content: bmesh.ops.create_cube(content, size=2 * HALF), (0.1, 2 * HALF, 0.0))

    yield from prepared(window, build, "Box")
    upper = bpy.data.objects["Upper"]
    yield from turned_with_the_box(window, upper, "start_touching_each_other")
    across = Vector(upper.location) - Vector(box().location)
    expect_near(across.angle(Vector((0.1, 2 * HALF, 0.0))), math.radians(40.0), 1e-4, "the turn of both")
    yield from window.undo()
    yield from window.rest_at((0.0, 0.0, 0.0))
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    yield from click(window)
    expect_near(box_x(), FURTHEST - 0.1, NEAR + 0.1, "the lower box at the wall")
    expect_near(bpy.data.objects["Upper"].location.x, FURTHEST, NEAR, "the upper box at the wall")


def start_cutting_each_other(window: Window) -> Steps:
    """A box and its tip, which cuts it: they turn as one, and the wall stops both."""

    def build() -> None:
        scenes.add_box()
        scenes.add_mesh("Tip", lambda content: bmesh.ops.create_cube(content, size=HALF), (-HALF, 0.1, 0.05))

    yield from prepared(window, build, "Box")
    tip = bpy.data.objects["Tip"]
    before = Vector(tip.location) - Vector(box().location)
    yield from turned_with_the_box(window, tip, "start_cutting_each_other")
    yield from window.undo()
    yield from window.rest_at((0.0, 0.0, 0.0))
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    yield from click(window)
    expect_near(box_x(), FURTHEST, NEAR, "the box at the wall")
    after = Vector(bpy.data.objects["Tip"].location) - Vector(box().location)
    expect_near((after - before).length, 0.0, 1e-5, "the way of the tip against the box")


def start_touching_in_edit_mode(window: Window) -> Steps:
    """A box that touches the wall in Edit Mode is dragged along it without a question, and not into it."""

    def build() -> None:
        scenes.add_box().location.x = FURTHEST

    yield from prepared(window, build, "Box", "EDIT")
    yield from start(window)
    yield from window.glide(window.pixel((FURTHEST + 1.0, 0.6, 0.0)))
    window.picture("start_touching_in_edit_mode")
    yield from click(window)
    content = bmesh.from_edit_mesh(bpy.context.object.data)
    expect_near(max(vertex.co.x for vertex in content.verts), HALF, 1e-4, "the side at the wall")
    assert max(vertex.co.y for vertex in content.verts) > HALF + 0.3, "it has not slid"


def start_touching_parts(window: Window) -> Steps:
    """A block of a mesh that touches another one slides along it, and does not pass into it."""

    def build() -> None:
        def blocks(content: bmesh.types.BMesh) -> None:
            for x, size in ((-1.0, 1.0), (-0.25, 0.5)):
                bmesh.ops.create_cube(content, size=size, matrix=Matrix.Translation((x, 0.0, 0.0)))

        scenes.add_mesh("Blocks", blocks)

    yield from prepared(window, build, "Blocks", "EDIT")
    content = bmesh.from_edit_mesh(bpy.context.object.data)
    for vertex in content.verts:
        vertex.select_set(vertex.index >= 8)
    content.select_flush_mode()
    bmesh.update_edit_mesh(bpy.context.object.data)
    yield from window.settle()
    yield from start(window)
    yield from window.glide(window.pixel((-0.4, 0.2, 0.0)))
    window.picture("start_touching_parts")
    yield from click(window)
    content = bmesh.from_edit_mesh(bpy.context.object.data)
    moved = [Vector(vertex.co) for vertex in content.verts if vertex.index >= 8]
    expect_near(min(each.x for each in moved), -0.5, 1e-4, "the block beside the other one")
    assert max(each.y for each in moved) > 0.4, "it has not slid"


def start_refused_modifier(window: Window) -> Steps:
    """A box whose Triangulate modifier flips quads below a subdivision: the popup fixes them, and the drag works."""

    def build() -> None:
        box = scenes.add_box()
        box.modifiers.new("Triangulate", "TRIANGULATE")
        box.modifiers.new("Subdivision", "SUBSURF")
        bpy.context.scene.stiv.object_response = "deform"

    yield from prepared(window, build, "Box")
    window.key("M", shift=True, alt=True)
    yield from popup_opened(window)
    window.picture("start_refused_modifier")
    window.key("F")
    yield from window.settle()
    assert bpy.data.objects["Box"].modifiers["Triangulate"].quad_method == "FIXED"
    yield from start(window)
    yield from window.glide(window.pixel((-0.5, 0.0, 0.0)))
    yield from click(window)
    assert min(vertex.co.x for vertex in bpy.data.objects["Box"].data.vertices) < -0.7


INTERSECTING_STARTS = {
    scenario.__name__: scenario
    for scenario in (
        start_popup_separate,
        start_popup_of_moving_mouse,
        start_popup_let_pass,
        start_suzanne,
        start_touching,
        start_touching_each_other,
        start_cutting_each_other,
        start_touching_in_edit_mode,
        start_touching_parts,
        start_refused_modifier,
    )
}
