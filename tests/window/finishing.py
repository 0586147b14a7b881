# SPDX-License-Identifier: GPL-3.0-or-later
"""The ends of long drags: a click right after the last motion, Esc during a typed value, Esc during the start."""

from __future__ import annotations

import time
from typing import Any

import bmesh
import bpy
import extension
import numpy as np
from playing import CLOSE, NEAR, click, ended, expect_free, expect_near, prepared, start
from scenes import HALF, WALL_FACE
from simulation import Steps, Window

CELLS = 90  # edges of a fine ball along a side of the cube that it was


def add_fine_ball(cells: int = CELLS) -> bpy.types.Object:
    """A ball of radius HALF with 12 cells^2 triangles."""
    shape = bmesh.new()
    bmesh.ops.create_cube(shape, size=1.0)
    bmesh.ops.subdivide_edges(shape, edges=shape.edges, cuts=cells - 1, use_grid_fill=True)
    for vertex in shape.verts:
        vertex.co = HALF * vertex.co.normalized()
    mesh = bpy.data.meshes.new("Ball")
    shape.to_mesh(mesh)
    shape.free()
    ball = bpy.data.objects.new("Ball", mesh)
    bpy.context.collection.objects.link(ball)
    return ball


def ball() -> bpy.types.Object:
    """The ball; looked up at each use, since undo creates new objects."""
    return bpy.data.objects["Ball"]


def state() -> tuple[bytes, tuple[float, ...]]:
    """All bits of the ball's vertices and of its placement."""
    points = np.empty(3 * len(ball().data.vertices), np.float32)
    ball().data.vertices.foreach_get("co", points)
    return points.tobytes(), tuple(value for row in ball().matrix_world for value in row)


def drag_of_window() -> Any:
    """The running drag; None if there is none."""
    running = extension.module("operators.running")._running
    return None if running is None else running._drag


def solved_part() -> float:
    """The fraction of the way to a confirmed goal; 1 after it."""
    drag = drag_of_window()
    return 1.0 if drag is None else float(drag.fraction)


def progress_of_drag() -> str:
    """The progress of the running drag by name; "" if none runs."""
    drag = drag_of_window()
    return "" if drag is None else drag.progress.name


def click_after_the_last_move(window: Window) -> Steps:
    """A click in the same moment as the last motion: the drag ends at its goal, or at the wall."""
    for mode, goal, expected, tolerance in (
        ("slide", (1.2, 0.9, 0.0), 1.2, CLOSE),
        ("slide", (3.4, 0.4, 0.0), WALL_FACE - HALF, NEAR),
        ("deform", (1.2, 0.9, 0.0), 1.2, CLOSE),
    ):
        yield from prepared(window, add_fine_ball, "Ball")
        bpy.context.scene.stiv.object_response = mode
        yield from start(window)
        yield from window.until(lambda: progress_of_drag() == "RUNNING", "the start of the drag", 60.0)
        window.move(*window.pixel(goal))
        yield from click(window)
        points = np.array([ball().matrix_world @ vertex.co for vertex in ball().data.vertices])
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        expect_near(middle[0], expected, tolerance, f"x of the ball ({mode})")
        expect_near(middle[1], goal[1], CLOSE, f"y of the ball ({mode})") if expected == goal[0] else None
        assert "budget" not in bpy.context.window_manager.stiv_last_edit
        expect_free(window)
        window.picture(f"click_after_the_last_move_{mode}")


def esc_during_a_typed_value(window: Window) -> Steps:
    """Esc while a typed value is solved for: the part of the way that is safe stays, as one undo step."""
    yield from prepared(window, lambda: add_fine_ball(120), "Ball")
    bpy.context.scene.stiv.object_response = "deform"
    before = state()
    yield from start(window)
    yield from window.until(lambda: progress_of_drag() == "RUNNING", "the start of the drag", 60.0)
    yield from window.type("9")
    window.key("X")
    yield from window.until(lambda: drag_of_window().state.axis_lock.axis == 0, "the axis lock")
    window.key("RET")
    yield from window.until(lambda: progress_of_drag() != "RUNNING", "the confirmation")
    yield from window.until(lambda: solved_part() > 0.1, "a part of the way", 120.0)
    assert progress_of_drag() == "FINISHING", "the value was solved for before Esc"
    window.picture("esc_during_a_typed_value")
    window.key("ESC")
    yield from ended(window)
    assert state() != before
    expect_free(window)
    yield from window.undo()
    assert state() == before


def esc_during_the_start(window: Window) -> Steps:
    """Esc while a drag begins: the scene stays the same to the last bit."""
    yield from prepared(window, lambda: add_fine_ball(160), "Ball")
    before = state()
    window.key("M", shift=True, alt=True)
    yield from window.until(window.dragging, "the start of the drag")
    pressed, spent = time.perf_counter(), time.thread_time()
    window.key("ESC")
    while window.dragging():
        yield 0.001
    clock, own = time.perf_counter() - pressed, time.thread_time() - spent
    print(f"  Esc during a start: {clock:.2f} s, of this thread {own:.2f} s", flush=True)
    yield from window.settle()
    assert state() == before
    yield from start(window)
    yield from window.until(lambda: progress_of_drag() == "RUNNING", "the start of another drag", 60.0)
    window.key("ESC")
    yield from ended(window)
    assert state() == before


def a_second_drag_keeps_the_session(window: Window) -> Steps:
    """The session of a confirmed drag of vertices is used by the next one, after an undo too; the wall still stops."""
    yield from prepared(window, lambda: add_fine_ball(16), "Ball")
    with window.override():
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.ed.undo_push(message="edit mode")
    sessions = []
    for goal in ((0.3, 0.4, 0.0), (0.2, -0.4, 0.0), (WALL_FACE - HALF + 0.1, 0.0, 0.0)):
        yield from start(window)
        yield from window.until(lambda: progress_of_drag() == "RUNNING", "the start of the drag", 60.0)
        sessions.append(drag_of_window().edit._solver.session)
        window.move(*window.pixel(goal))
        yield from click(window)
        if len(sessions) == 2:
            yield from window.undo()
    assert sessions[0] is sessions[1] is sessions[2]
    with window.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    assert max(vertex.co.x for vertex in ball().data.vertices) < WALL_FACE
    expect_free(window)


_ALL = (click_after_the_last_move, esc_during_a_typed_value, esc_during_the_start, a_second_drag_keeps_the_session)
FINISHING = {scenario.__name__: scenario for scenario in _ALL}
