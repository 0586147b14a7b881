# SPDX-License-Identifier: GPL-3.0-or-later
"""The tools of the toolbar with their gizmo, and the switch that lets Blender's own transforms collide."""

from __future__ import annotations

import math

import bpy
import numpy as np
import scenes
from playing import FURTHEST, INTO_WALL, NEAR, box, box_x, click, expect_free, expect_near, prepared
from simulation import Steps, Window

HANDLE = 0.8  # of the length of an arrow: on its line
AROUND = 120  # pixels
SAME_PIXELS = 0.995  # move and rotate share 0.92 of them
FLAGS = ("show_gizmo_tool", "show_gizmo_object_translate", "show_gizmo_object_rotate", "show_gizmo_object_scale")


def with_tool(window: Window, name: str) -> Steps:
    """Choose a tool as its button does."""
    with window.override():
        bpy.ops.wm.tool_set_by_id(name=name)
    yield from window.settle(8)


def with_switch(window: Window, on: bool) -> Steps:
    """Turn the switch on or off."""
    bpy.context.scene.stiv.live_transforms = on
    yield from window.settle(8)


def handle_pixel(window: Window, direction: tuple[float, float], length: float = HANDLE) -> tuple[int, int]:
    """The pixel of a handle of the gizmo at the box, in a parallel view from above."""
    x, y = window.pixel(tuple(box().location))
    size = bpy.context.preferences.view.gizmo_size * bpy.context.preferences.system.ui_scale * length
    return x + round(direction[0] * size), y + round(direction[1] * size)


def drag_with_button(window: Window, start: tuple[int, int], end: tuple[int, int]) -> Steps:
    """Press the left button, drag, look at the picture, and release."""
    for offset in (3, 1, 0):
        window.move(start[0] + offset, start[1])
        yield from window.settle(3)
    window.event("LEFTMOUSE", "PRESS")
    yield
    yield from window.glide(end, 12)
    yield from window.settle()
    window.picture("tool_dragging")
    window.event("LEFTMOUSE", "RELEASE")
    yield from window.until(lambda: not window.handle.modal_operators, "the end of the drag")
    yield from window.settle()


def expect_at_wall(window: Window, *, y: float = 0.0) -> None:
    """Expect the box in front of the wall, moved along x alone unless `y` is given."""
    expect_near(box_x(), FURTHEST, NEAR, "the box at the wall")
    expect_near(box().location.y, y, 0.05, "the box across")
    expect_free(window)


def tool_gizmo(window: Window) -> Steps:
    """An arrow of the tool's gizmo, dragged into the wall askew: the box stays on the axis and stops, one undo step."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from with_tool(window, "stiv.collision_move")
    window.picture("tool_move_above")
    yield from drag_with_button(window, handle_pixel(window, (1.0, 0.0)), window.pixel((3.2, 0.9, 0.0)))
    assert box().location.y == 0.0 and box().location.z == 0.0, box().location
    expect_at_wall(window)
    yield from window.undo()
    assert box_x() == 0.0, box_x()
    yield from window.redo()
    yield from drag_with_button(window, handle_pixel(window, (0.0, 1.0)), window.pixel((3.0, 1.0, 0.0)))
    expect_near(box_x(), FURTHEST, NEAR, "x, which the arrow of y does not move")
    assert box().location.y > 0.1, box().location
    yield from with_tool(window, "builtin.select_box")


def tool_anywhere(window: Window) -> Steps:
    """With the tool, a drag beside the gizmo moves freely, and a click selects."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from with_tool(window, "stiv.collision_move")
    yield from drag_with_button(window, window.pixel((-1.5, -1.0, 0.0)), window.pixel((2.5, -0.6, 0.0)))
    expect_at_wall(window, y=0.4)
    window.move(*window.pixel((1.98, 1.4, 0.0)))
    yield from window.settle()
    window.key("LEFTMOUSE")
    yield from window.settle(8)
    assert [obj.name for obj in bpy.context.selected_objects] == ["Wall"], bpy.context.selected_objects
    yield from with_tool(window, "builtin.select_box")


def tool_rotate_and_scale(window: Window) -> Steps:
    """The dial of z turns about z; the box of y scales along y alone."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from with_tool(window, "stiv.collision_rotate")
    yield from drag_with_button(window, handle_pixel(window, (0.0, 1.0), 1.0), handle_pixel(window, (-1.0, 0.0), 1.0))
    turned = box().rotation_euler
    assert abs(turned.z) > math.radians(40.0) and turned.x == turned.y == 0.0, turned
    bpy.data.objects["Box"].rotation_euler = (0.0, 0.0, 0.0)
    yield from with_tool(window, "stiv.collision_scale")
    yield from drag_with_button(window, handle_pixel(window, (0.0, 1.0)), handle_pixel(window, (0.0, 2.0), 1.0))
    scale = box().scale
    assert scale.y > 1.5 and scale.x == scale.z == 1.0, scale
    yield from with_tool(window, "builtin.select_box")


def tool_in_edit_mode(window: Window) -> Steps:
    """The right half of a cage, dragged with the arrow of x: it stops at the wall."""
    yield from prepared(window, scenes.add_cage, "Cage", "EDIT")
    yield from with_tool(window, "stiv.collision_move")
    centre = window.pixel((0.35, 0.0, 0.0))
    size = bpy.context.preferences.view.gizmo_size * bpy.context.preferences.system.ui_scale
    window.picture("tool_edit_mode")
    yield from drag_with_button(window, (centre[0] + round(HANDLE * size), centre[1]), window.pixel((4.0, 0.4, 0.0)))
    extent = scenes.evaluated_extent("Cage")
    assert 1.7 < extent < 1.9, extent
    yield from with_tool(window, "builtin.select_box")


def switch_keys(window: Window) -> Steps:
    """With the switch, G stops at the wall and R starts a drag; without it, G passes through."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from with_switch(window, on=True)
    window.picture("switch_on")
    window.key("G")
    yield from window.until(window.dragging, "a drag that collides")
    yield from window.glide(window.pixel(INTO_WALL))
    yield from click(window)
    expect_at_wall(window)
    yield from window.rest_at((0.0, 0.0, 0.0))
    window.key("R")
    yield from window.until(window.dragging, "a rotation that collides")
    yield from click(window, "ESC")
    yield from with_switch(window, on=False)
    window.key("G")
    yield from window.settle()
    assert not window.dragging()
    yield from window.glide(window.pixel(INTO_WALL))
    window.key("LEFTMOUSE")
    yield from window.settle()
    assert box_x() > FURTHEST + 0.1, box_x()


def switch_gizmo(window: Window) -> Steps:
    """With the switch, the gizmo of Blender's Move tool stops at the wall; its flags are Blender's again afterwards."""
    yield from prepared(window, scenes.add_box, "Box")
    space = window.area.spaces.active
    space.show_gizmo_object_rotate = True
    before = [getattr(space, name) for name in FLAGS]
    yield from with_tool(window, "builtin.move")
    window.picture("blender_gizmo")
    yield from with_switch(window, on=True)
    window.picture("switch_gizmo")
    assert not any(getattr(window.area.spaces.active, name) for name in FLAGS)
    yield from drag_with_button(window, handle_pixel(window, (1.0, 0.0)), window.pixel((3.2, 0.9, 0.0)))
    assert box().location.y == 0.0, box().location
    expect_at_wall(window)
    yield from with_tool(window, "builtin.select_box")
    window.picture("switch_object_gizmo")
    yield from with_switch(window, on=False)
    assert [getattr(window.area.spaces.active, name) for name in FLAGS] == before
    window.area.spaces.active.show_gizmo_object_rotate = False


def switch_spares_lights(window: Window) -> Steps:
    """With the switch, Blender's own transform moves what has no surface, with keys and with the gizmo."""
    yield from prepared(window, scenes.add_box, "Box")
    lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT"))
    lamp.location = (0.0, 1.2, 0.0)
    bpy.context.collection.objects.link(lamp)
    scenes.select_only(lamp)
    yield from with_switch(window, on=True)
    yield from window.rest_at((0.0, 1.2, 0.0))
    window.key("G")
    yield from window.settle()
    assert [each.bl_idname for each in window.handle.modal_operators] == ["TRANSFORM_OT_translate"]
    yield from window.glide(window.pixel((3.0, 1.2, 0.0)))
    window.key("LEFTMOUSE")
    yield from window.settle()
    expect_near(bpy.data.objects["Lamp"].location.x, 3.0, 0.05, "the lamp behind the wall")
    yield from with_switch(window, on=False)


def equal_pixels(window: Window, first: str, second: str) -> float:
    """The fraction of equal pixels in a square around the gizmo of two pictures."""
    pictures = [bpy.data.images.load(str(window.output / f"{name}.png")) for name in (first, second)]
    x, y = window.pixel((0.0, 0.0, 0.0))
    crops = []
    for picture in pictures:
        width, height = picture.size
        pixels = np.array(picture.pixels[:]).reshape(height, width, -1)
        crops.append(pixels[y - AROUND : y + AROUND, x - AROUND : x + AROUND, :3])
        bpy.data.images.remove(picture)
    return float((np.abs(crops[0] - crops[1]).max(axis=2) < 0.1).mean())


def gizmos_beside_blenders(window: Window) -> Steps:
    """Each gizmo beside Blender's own, seen from a corner: the pictures are nearly equal."""
    yield from prepared(window, scenes.add_box, "Box")
    scenes.look_from_corner(window.area)
    window.move(30, 200)
    for kind in ("move", "rotate", "scale", "transform"):
        yield from with_tool(window, f"builtin.{kind}")
        window.picture(f"gizmo_{kind}_blender")
        yield from with_switch(window, on=True)
        window.picture(f"gizmo_{kind}")
        same = equal_pixels(window, f"gizmo_{kind}", f"gizmo_{kind}_blender")
        assert same > SAME_PIXELS, f"{kind}: {same:.4f} of the pixels around the gizmo are equal"
        yield from with_switch(window, on=False)
    yield from with_tool(window, "stiv.collision_rotate")
    window.picture("tool_header")
    yield from with_tool(window, "builtin.select_box")


_ALL = (
    tool_gizmo,
    tool_anywhere,
    tool_rotate_and_scale,
    tool_in_edit_mode,
    switch_keys,
    switch_gizmo,
    switch_spares_lights,
    gizmos_beside_blenders,
)
TOOLS = {scenario.__name__: scenario for scenario in _ALL}
