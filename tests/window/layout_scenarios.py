# SPDX-License-Identifier: GPL-3.0-or-later
"""The layout operators as an artist calls them: progress in the header, one undo step, Esc, and the redo panel."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from functools import partial

import bmesh
import bpy
import scenes
from playing import expect_free, prepared
from simulation import Steps, Window


def add_bricks(count: int = 3, levels: int = 0) -> None:
    """Tilted bricks above a floor, the lowest first; with a Subdivision Surface of this level."""
    scenes.add_mesh("Floor", lambda content: bmesh.ops.create_grid(content, x_segments=8, y_segments=8, size=4.0))
    for number in range(count):
        place = (-0.4 + 0.3 * number, 0.2, 1.5 + 2 * number)
        brick = scenes.add_mesh(f"Brick {number}", partial(bmesh.ops.create_cube, size=1.0), place)
        brick.scale, brick.rotation_euler = (1.0, 0.6, 0.4), (0.4 * number, 0.3, number)
        if levels:
            brick.modifiers.new("Subdivision", "SUBSURF").levels = levels


def add_stone() -> None:
    """A stone beside waves."""
    add_bricks(0)
    floor = bpy.data.objects["Floor"]
    for vertex in floor.data.vertices:
        vertex.co.z = 0.3 * math.sin(2 * vertex.co.x) * math.cos(vertex.co.y)
    scenes.add_mesh("Stone", partial(bmesh.ops.create_icosphere, subdivisions=2, radius=0.25), (0.0, 0.0, 3.0))


def add_crate() -> None:
    """An open crate and balls beside it."""
    crate = scenes.add_mesh("Crate", partial(bmesh.ops.create_cube, size=2.0), (-1.0, 0.0, 1.0))
    content = bmesh.new()
    content.from_mesh(crate.data)
    bmesh.ops.delete(content, geom=[max(content.faces, key=lambda face: face.calc_center_median().z)], context="FACES")
    content.to_mesh(crate.data)
    content.free()
    for number in range(6):
        ball = partial(bmesh.ops.create_icosphere, subdivisions=2, radius=0.3 + 0.03 * number)
        scenes.add_mesh(f"Ball {number}", ball, (1.0 + 0.8 * (number % 3), 1.0 + 0.8 * (number // 3), 0.6))


def played(
    window: Window, build: Callable[[], None], active: str, operator: str, chosen: str = "", **values: object
) -> Steps:
    """Run an operator on the objects whose names begin with `chosen`; see it end free, undone and redone."""
    yield from prepared(window, build, active)
    bpy.data.objects.remove(bpy.data.objects["Wall"])
    scenes.look_from_corner(window.area)
    for ob in bpy.data.objects:
        ob.select_set(ob.name.startswith(chosen or active) or ob.name == active)
    bpy.context.view_layer.objects.active = bpy.data.objects[active]
    yield from window.settle(10)
    window.picture(f"{operator}_before")
    before = places()
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        getattr(bpy.ops.stiv, operator)("INVOKE_DEFAULT", True, **values)
    yield from window.until(lambda: not window.dragging() and places() != before, "the end of the layout", 120.0)
    yield from window.settle(10)
    window.picture(f"{operator}_after")
    expect_free(window)
    after = places()
    yield from window.undo()
    assert places() == before, (places(), before)
    yield from window.redo()
    assert places() == after


def changed() -> int:
    """The number of objects that the last layout changed."""
    return len(json.loads(bpy.context.window_manager.stiv_last_edit)["changed"])


def places() -> dict[str, tuple[float, ...]]:
    """The world matrix of each object."""
    return {ob.name: tuple(value for row in ob.matrix_world for value in row) for ob in bpy.data.objects}


def layout_drop(window: Window) -> Steps:
    """Three bricks fall, turn and come to rest on the floor and on each other."""
    yield from played(window, add_bricks, "Brick 0", "drop", "Brick")


def layout_settle_contact(window: Window) -> Steps:
    """A tilted brick settles on the floor, the nearest surface."""
    yield from played(window, partial(add_bricks, 1), "Brick 0", "settle_contact", max_distance=4.0)


def layout_place(window: Window) -> Steps:
    """Stones on waves; the name of the surface comes from the pointer."""
    yield from played(window, add_stone, "Stone", "place", count=20, scale_variation=0.4)
    assert changed() == 20


def layout_push_apart(window: Window) -> Steps:
    """Bricks that intersect come apart."""

    def build() -> None:
        add_bricks()
        for number in range(3):
            bpy.data.objects[f"Brick {number}"].location = (0.3 * number, 0.1 * number, 1.0)

    yield from played(window, build, "Brick 0", "push_apart", "Brick")


def layout_fit_into(window: Window) -> Steps:
    """Balls fall into a crate."""
    yield from played(window, add_crate, "Crate", "fit_into", "Ball")
    assert changed() == 6


def layout_escape(window: Window) -> Steps:
    """Esc during a drop leaves the scene unchanged; the header showed the progress."""
    yield from prepared(window, partial(add_bricks, 2, 6), "Brick 0")
    before = places()
    with window.override():
        bpy.ops.stiv.drop("INVOKE_DEFAULT", True)
    assert window.dragging()
    yield from window.settle(3)
    window.picture("layout_progress")
    window.key("ESC")
    yield from window.until(lambda: not window.dragging(), "the end after Esc", 2.0)
    assert places() == before


def layout_panel(window: Window) -> Steps:
    """The panel with its buttons, and the redo panel of Place."""
    yield from prepared(window, add_stone, "Stone")
    window.area.spaces.active.show_region_ui = True
    yield from window.settle()
    next(region for region in window.area.regions if region.type == "UI").active_panel_category = "STIV"
    bpy.data.objects["Floor"].select_set(True)
    yield from window.settle()
    with window.override():
        bpy.ops.stiv.place("INVOKE_DEFAULT", True, count=5)
    yield from window.until(lambda: len(bpy.data.objects) > 5 and not window.dragging(), "copies", 60.0)
    yield from window.settle()
    window.key("F9")
    yield from window.settle(10)
    window.picture("layout_panel")
    window.key("ESC")
    window.area.spaces.active.show_region_ui = False
    yield from window.settle()


LAYOUT = {
    scenario.__name__: scenario
    for scenario in (
        layout_drop,
        layout_settle_contact,
        layout_place,
        layout_push_apart,
        layout_fit_into,
        layout_escape,
        layout_panel,
    )
}
