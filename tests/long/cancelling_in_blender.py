# SPDX-License-Identifier: GPL-3.0-or-later
"""Press Esc at random moments of drags of 75,592 faces in Blender, and measure the response times.

    python tests/long/cancelling_in_blender.py [--times 200] [--seed 1]

The vertices of a ball are dragged through a wall in Edit Mode, like in the add-on and with its time limit per
solve, but without a window. The mouse moves for a second and rests for half a second. Esc takes effect after
the current solve, writing and testing; then everything is restored. The delay is the time from the key to the
end of the restore. The exit code is 1 if the scene changed by a bit, or if a drag took more than 100 ms of
the main thread's processor time to return. Other programs add to wall times, and Blender's own threads to the
time of the process. Needs Blender as a Python module, and the add-on as `stiv_addon`.
"""

import argparse
import hashlib
import os
import sys
import threading
import time
from pathlib import Path
from types import SimpleNamespace

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent), str(TESTS), str(TESTS / "faults"), str(TESTS / "blender")]

import bpy  # noqa: E402
import building  # noqa: E402
import numpy as np  # noqa: E402
from ball_above_wall import ball_above_wall  # noqa: E402

from stiv.blender import BlenderEdit, EditSettings  # noqa: E402
from stiv.task import Task  # noqa: E402
from stiv_addon.modal.drag_calls import DragCalls  # noqa: E402
from stiv_addon.modal.drag_end import Progress  # noqa: E402
from stiv_addon.modal.drag_loop import DragLoop  # noqa: E402
from stiv_addon.modal.event import Event  # noqa: E402
from stiv_addon.modal.pointer import Pointer  # noqa: E402
from stiv_addon.modal.request import Request  # noqa: E402
from stiv_addon.modal.state import State  # noqa: E402
from stiv_addon.scene.edit_settings import DRAG_BUDGET  # noqa: E402

SHIFT = np.array([0.02, 0.01, -0.45])
MOVES, RESTS = 1.0, 0.5  # seconds
TICK = 1.0 / 60.0  # the add-on's timer
MOST = 100.0  # milliseconds


def make_scene() -> None:
    """Create ball and wall as two objects, with the ball in Edit Mode and all its vertices selected."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    surface, positions, ball = ball_above_wall()
    first = ball[0]
    faces = np.asarray(surface.triangles)
    building.add("Wall", building.mesh("Wall", positions[:first], faces[faces[:, 0] < first]))
    ball = building.add("Ball", building.mesh("Ball", positions[first:], faces[faces[:, 0] >= first] - first))
    building.edit_mode(ball)
    bpy.ops.mesh.select_all(action="SELECT")


def digest() -> str:
    """Digest of everything in the scene that an edit might change."""
    return hashlib.sha256(repr(building.snapshot()).encode()).hexdigest()


def new_drag(threads: int) -> DragLoop:
    """A drag as the add-on starts it, toward SHIFT times a thousandth of the pointer's x."""
    settings = EditSettings(time_budget=DRAG_BUDGET, threads=threads)
    calls = DragCalls(
        begin=lambda request: BlenderEdit.begin_steps(bpy.context, settings, kind=request.kind),
        transform_of=lambda state: state.pointer.effective[0] / 1000,
        motion_of=lambda share, state: building.shift(*(share * SHIFT)),
        apply=no_typed_values,
        task=Task,
    )
    return DragLoop(calls, State(Pointer.at((0.0, 0.0)), Request("move")))


def no_typed_values(share: float, state: State) -> None:
    """Typed values do not occur here."""
    raise AssertionError("no values are typed")


def clocks() -> tuple[float, float]:
    """Seconds of wall time, and of processor time of the main thread."""
    main_thread = threading.main_thread().ident
    return time.perf_counter(), time.clock_gettime(time.pthread_getcpuclockid(main_thread))


def cancelled_after(seconds: float, drag: DragLoop) -> SimpleNamespace:
    """Drag until Esc; returns milliseconds of both clocks until it took effect, and until the end."""
    pressed: list[tuple[float, float]] = []
    timer = threading.Timer(seconds, lambda: pressed.append(clocks()))
    begin = time.perf_counter()
    timer.start()
    while not pressed:
        ticked = time.perf_counter()
        drag.handle(Event("MOUSEMOVE", "NOTHING", (1000 * min(1.0, (ticked - begin) / MOVES), 0.0)))
        drag.tick()
        time.sleep(max(0.0, TICK - (time.perf_counter() - ticked)) if not pressed else 0.0)
    heard = clocks()
    drag.handle(Event("ESC"))
    done = clocks()
    if drag.progress is not Progress.CANCELLED or drag.error is not None:
        raise SystemExit(f"the drag was not cancelled: {drag.error}")
    since = [[1000 * (b - a) for a, b in zip(pressed[0], each, strict=True)] for each in (heard, done)]
    return SimpleNamespace(heard=since[0], done=since[1])


def main() -> int:
    """Drag, press Esc, compare and print the delays."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--times", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1)
    chosen = parser.parse_args()
    chance = np.random.default_rng(chosen.seed)
    make_scene()
    before, changed, delays = digest(), 0, []
    for _ in range(chosen.times):
        delays.append(cancelled_after(chance.uniform(0, MOVES + RESTS), new_drag(chosen.threads)))
        changed += digest() != before
    for name, column in (("wall", 0), ("processor", 1)):
        heard = np.percentile([each.heard[column] for each in delays], [50, 95, 100])
        done = np.percentile([each.done[column] for each in delays], [50, 95, 100])
        print(
            f"{name} time: heard after {heard[0]:.0f} ms (median), {heard[1]:.0f} (95 %), {heard[2]:.0f} (worst);",
            end=" ",
        )
        print(f"restored after {done[0]:.0f} ms (median), {done[1]:.0f} (95 %), {done[2]:.0f} (worst)")
    late = [sum(each.done[column] > MOST for each in delays) for column in range(2)]
    print(f"{late[0]} came back later than {MOST:.0f} ms of wall time, {late[1]} of processor time")
    print(f"{len(delays)} drags cancelled, {changed} scenes changed")
    return int(changed > 0 or late[1] > 0)


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    os._exit(code)  # Blender may hang when Python exits
