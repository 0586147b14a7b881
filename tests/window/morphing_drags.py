# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of shape keys dragged in a window: by the extension's drag, and in Blender's own way under Live Collisions."""

from __future__ import annotations

import bmesh
import bpy
import scenes
from playing import click, expect_free
from simulation import Steps, Window

AT_WALL = (0.78, 0.93)  # of the value that touches the wall


def prepare(window: Window, segments: int = 32) -> Steps:
    """A ball of radius 1, whose key Wide doubles it along x; the wall is at 1.9."""
    with window.override():
        scenes.clear()
        ball = scenes.add_mesh(
            "Ball",
            lambda mesh: bmesh.ops.create_uvsphere(mesh, u_segments=segments, v_segments=segments // 2, radius=1),
        )
        ball.shape_key_add(name="Basis")
        for name, factor, axis in (("Wide", 2.0, 0), ("Tall", 0.5, 1)):
            key = ball.shape_key_add(name=name)
            key.value, key.slider_min = 0.0, -1.0 if name == "Tall" else 0.0
            for point in key.data:
                point.co[axis] *= factor
        ball.active_shape_key_index = 1
        scenes.add_wall()
        scenes.select_only(ball)
        bpy.context.scene.stiv.separation = 0.01
        scenes.look_from_above(window.area)
        bpy.ops.ed.undo_push(message="start")
    yield from window.settle()
    yield from window.rest_at((0.0, 0.0, 0.0))


def value(key: str = "Wide") -> float:
    """The value of a key of the ball."""
    return float(bpy.data.objects["Ball"].data.shape_keys.key_blocks[key].value)


def _begin(window: Window) -> Steps:
    with window.override():
        bpy.ops.stiv.morph_drag("INVOKE_DEFAULT")
    yield from window.until(window.dragging, "a running drag")


def _right(window: Window, pixels: int) -> tuple[int, int]:
    return window.mouse[0] + pixels, window.mouse[1]


def morphed_by_the_mouse(window: Window) -> Steps:
    """A key stops at the wall, a second one is dragged too; one undo step; Esc and typed values."""
    yield from prepare(window)
    yield from _begin(window)
    yield from window.glide(_right(window, 280), 20)
    yield from window.settle(10)
    window.picture("morphed_by_the_mouse")
    assert AT_WALL[0] < value() < AT_WALL[1], value()
    window.key("DOWN_ARROW")
    yield from window.glide(_right(window, -150), 10)
    yield from window.settle(10)
    window.picture("morphed_two_keys")
    assert value("Tall") < -0.5, value("Tall")
    yield from click(window)
    wide, tall = value(), value("Tall")
    assert AT_WALL[0] < wide < AT_WALL[1] and tall < -0.5, (wide, tall)
    expect_free(window)
    yield from window.undo()
    assert (value(), value("Tall")) == (0.0, 0.0), (value(), value("Tall"))
    yield from window.redo()
    assert (value(), value("Tall")) == (wide, tall)
    yield from _begin(window)
    yield from window.type("0.25")
    yield from window.settle(10)
    assert value() == 0.25, value()
    yield from click(window, "ESC")
    assert (value(), value("Tall")) == (wide, tall)
    yield from _begin(window)
    yield from window.type("0.25")
    yield from click(window, "RET")
    assert (value(), value("Tall")) == (0.25, tall)


def morphed_under_the_guard(window: Window) -> Steps:
    """Blender's own field of a value, as its release leaves it, is corrected by the live guard in the same step."""
    yield from prepare(window)
    bpy.context.scene.stiv.live_transforms = True
    yield from window.settle(20)
    with window.override():
        bpy.data.objects["Ball"].data.shape_keys.key_blocks["Wide"].value = 1.0
        bpy.ops.ed.undo_push(message="Value")
    yield from window.until(lambda: value() < AT_WALL[1], "a correction")
    yield from window.settle(10)
    window.picture("morphed_under_the_guard")
    assert value() > AT_WALL[0], value()
    expect_free(window)
    yield from window.undo()
    yield from window.settle(20)
    assert value() == 0.0, value()
    bpy.context.scene.stiv.live_transforms = bpy.context.scene.stiv.live_guard = False


MORPHING_DRAGS = {each.__name__: each for each in (morphed_by_the_mouse, morphed_under_the_guard)}
