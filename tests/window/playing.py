# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the scenarios: scenes, gestures of a drag, and expectations after it."""

from __future__ import annotations

import bmesh
import bpy
import scenes
from scenes import HALF, WALL_FACE
from simulation import Steps, Window

FURTHEST = WALL_FACE - HALF  # of the box's centre
NEAR = 0.02  # how near to contact a drag has to come
CLOSE = 0.02  # about a pixel of the view
INTO_WALL = (3.2, 0.0, 0.0)


def prepared(window: Window, build: object, active: str, mode: str = "OBJECT") -> Steps:
    """Build a scene with the wall, select, look from above, and begin the undo history with it."""
    with window.override():
        scenes.clear()
        build()
        scenes.add_wall()
        scenes.select_only(bpy.data.objects[active])
        scenes.look_from_above(window.area)
        if mode == "EDIT":
            bpy.ops.object.mode_set(mode="EDIT")
            select_right_half()
        bpy.ops.ed.undo_push(message="start")
    yield from window.settle()
    yield from window.rest_at((0.0, 0.0, 0.0))


def select_right_half() -> None:
    """In Edit Mode: the vertices at x > 0; all points of a curve."""
    data = bpy.context.object.data
    if bpy.context.object.type == "MESH":
        content = bmesh.from_edit_mesh(data)
        for vertex in content.verts:
            vertex.select_set(vertex.co.x > 0.1)
        content.select_flush_mode()
        bmesh.update_edit_mesh(data)
    elif bpy.context.object.type == "CURVE":
        for point in data.splines[0].bezier_points:
            point.select_control_point = point.select_left_handle = point.select_right_handle = True
    else:
        for point in data.points:
            point.select = point.co_deform.x > 0.1  # `co` is nonsense in Edit Mode


def start(window: Window, key: str = "M") -> Steps:
    """Begin a transform by its key."""
    window.key(key, shift=True, alt=True)
    yield from window.until(window.dragging, "a running transform")


def click(window: Window, button: str = "LEFTMOUSE") -> Steps:
    """Press a button, and see the transform end."""
    window.key(button)
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    yield from window.settle()


def ended(window: Window) -> Steps:
    """Wait for the end of a drag."""
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    yield from window.settle()


def expect_free(window: Window) -> None:
    """Expect no intersections in Blender's evaluation."""
    with window.override():
        assert bpy.ops.stiv.check() == {"FINISHED"}
    found = bpy.context.window_manager.stiv_check.summary
    assert found.splitlines()[0] == "No intersections", found


def expect_near(value: float, expected: float, tolerance: float, what: str) -> None:
    """Compare; the message names the quantity."""
    assert abs(value - expected) <= tolerance, f"{what}: {value!r}, expected {expected!r} within {tolerance!r}"


def box() -> bpy.types.Object:
    """The box; looked up at each use, since undo creates new objects."""
    return bpy.data.objects["Box"]


def box_x() -> float:
    """Position of the box; looked up at each use, since undo creates new objects."""
    return bpy.data.objects["Box"].location.x
