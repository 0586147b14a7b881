# SPDX-License-Identifier: GPL-3.0-or-later
"""Times from a motion of the mouse to the redraw with a changed value, beside Blender's own G; asserts nothing."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import bmesh
import bpy
from finishing import add_fine_ball, ball, progress_of_drag
from playing import prepared
from simulation import Steps, Window

MOVES = 24
PIXELS = 3
POLL = 0.0005  # seconds


def placed_x() -> float:
    """The value of a rigid drag."""
    return float(ball().location.x)


def edited_x() -> float:
    """The value of a drag of vertices in Edit Mode."""
    vertices = bmesh.from_edit_mesh(ball().data).verts
    vertices.ensure_lookup_table()
    return float(vertices[0].co.x)


def times(window: Window, key: str, value: Callable[[], float], **modifiers: bool) -> Steps:
    """Milliseconds of the start, of the motions (median, most), of the confirmation after a rest; redraws a motion.

    The time of this thread alone measures the work while other programs use the processor.
    """
    x, y = window.pixel((0.0, 0.0, 0.0))
    yield from window.rest_at((0.0, 0.0, 0.0))
    began, spent = time.perf_counter(), time.thread_time()
    window.key(key, **modifiers)
    while not window.handle.modal_operators or (key != "G" and progress_of_drag() != "RUNNING"):
        yield POLL
    started, start_spent = time.perf_counter() - began, time.thread_time() - spent
    laps, draws, of_thread = [], [], []
    for number in range(1, MOVES + 1):
        last, drawn, count = value(), window.drawn_at, window._draws
        sent, spent = time.perf_counter(), time.thread_time()
        window.move(x + PIXELS * number, y)
        while window.drawn_at == drawn or value() == last:
            yield POLL
        laps.append(window.drawn_at - sent)
        of_thread.append(time.thread_time() - spent)
        yield 0.1
        draws.append(window._draws - count)
    yield 0.5
    sent, spent = time.perf_counter(), time.thread_time()
    window.key("RET")
    while window.handle.modal_operators:
        yield POLL
    ended, end_spent = time.perf_counter() - sent, time.thread_time() - spent
    shown = 1000.0 * statistics.median(laps), 1000.0 * max(laps), statistics.mean(draws)
    print(
        f"  {'Blender' if key == 'G' else 'STIV'}: start {1000 * started:.0f} ms, motion {shown[0]:.1f} ms, most "
        f"{shown[1]:.1f}, confirmation {1000 * ended:.0f} ms, redraws {shown[2]:.1f}; of this thread: start "
        f"{1000 * start_spent:.0f}, motion {1000 * statistics.median(of_thread):.1f}, confirmation "
        f"{1000 * end_spent:.0f} ms",
        flush=True,
    )
    yield from window.settle()


def measure_latency(window: Window) -> Steps:
    """A rigid ball, and a ball of vertices in Edit Mode, of 37 and 146 thousand triangles."""
    for mode, cells in (("OBJECT", 56), ("OBJECT", 110), ("EDIT", 56), ("EDIT", 110)):
        yield from prepared(window, lambda cells=cells: add_fine_ball(cells), "Ball")
        if mode == "EDIT":
            with window.override():
                bpy.ops.object.mode_set(mode="EDIT")
                bpy.ops.mesh.select_all(action="SELECT")
                bpy.ops.ed.undo_push(message="edit mode")
        yield from window.next_draw()
        print(f"{mode}, {12 * cells**2} triangles", flush=True)
        value = placed_x if mode == "OBJECT" else edited_x
        yield from times(window, "G", value)
        yield from window.undo()
        yield from times(window, "M", value, shift=True, alt=True)


LATENCIES = {"measure_latency": measure_latency}
