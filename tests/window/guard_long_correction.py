# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard with a long correction of a sculpt stroke: progress, Esc, and a window that stays alive."""

from __future__ import annotations

import time

import bpy
import extension
import numpy as np
from finishing import add_fine_ball, ball
from guard_scenarios import at_rest, guarded, steps
from guard_sculpting import sculpting, stroke
from playing import INTO_WALL, expect_free
from scenes import WALL_FACE
from simulation import Steps, Window

CELLS = 100  # of the ball: 120,000 triangles
LONG = 180.0  # seconds


def points() -> np.ndarray:
    """The vertices of the ball."""
    found = np.empty(3 * len(ball().data.vertices), np.float32)
    ball().data.vertices.foreach_get("co", found)
    return found.reshape(-1, 3)


def correcting() -> bool:
    """Whether the window shows a correction."""
    return extension.module("guard.waiting")._shown is not None


def idle() -> bool:
    """Whether the guard is at rest."""
    return not bpy.app.timers.is_registered(extension.module("guard.watcher").observe_and_act)


def guard_long_correction(window: Window) -> Steps:
    """Esc restores the ball before the stroke exactly; without it, the correction ends in front of the wall."""
    yield from guarded(window, lambda: add_fine_ball(CELLS), "Ball")
    sculpting(window)
    yield from window.until(idle, "the guard at rest", LONG)
    before, history = points(), steps()
    yield from stroke(window, INTO_WALL)
    yield from window.until(correcting, "a long correction", LONG)
    turns, longest, last = 0, 0.0, time.perf_counter()
    while correcting() and turns < 8:
        yield 0.01
        now = time.perf_counter()
        turns, longest, last = turns + 1, max(longest, now - last), now
    assert turns > 5, turns
    window.picture("guard_long_correction")
    pressed, spent = time.perf_counter(), time.thread_time()
    window.key("ESC")
    while correcting():
        yield 0.001
    ended = time.perf_counter() - pressed, time.thread_time() - spent
    while not idle():
        yield 0.001
    restored = time.perf_counter() - pressed, time.thread_time() - spent
    print(f"  longest pause {longest:.2f} s; Esc, and restored: clock {ended[0]:.2f}, {restored[0]:.2f} s,", end=" ")
    print(f"of this thread {ended[1]:.2f}, {restored[1]:.2f} s", flush=True)
    assert np.array_equal(points(), before), "Esc has not restored the ball"
    window.picture("guard_stopped_correction")
    yield from stroke(window, INTO_WALL)
    yield from window.until(idle, "the end of a correction", LONG)
    yield from at_rest(window)
    assert len(steps()) == len(history) + 2, (history, steps())
    assert before[:, 0].max() + 0.3 < points()[:, 0].max() < WALL_FACE, points()[:, 0].max()
    expect_free(window)
    bpy.context.scene.stiv.live_guard = False


GUARD_LONG_CORRECTION = {"guard_long_correction": guard_long_correction}
