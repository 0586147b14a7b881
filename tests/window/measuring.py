# SPDX-License-Identifier: GPL-3.0-or-later
"""The times of a drag in the window, on two scenes; runs only by name, since it asserts nothing."""

from __future__ import annotations

import statistics
import sys
import time
from collections import defaultdict
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import scenes
from playing import start
from simulation import Steps, Window

ROOT = Path(__file__).resolve().parents[2]
PLANT = ROOT / "blend_fixtures/plant_in_vase.blend"
MOVES = 30
PIXELS = 4  # the mouse moves from one to the next
HEAD = ("event to drawn frame", "solving", "write, all", "writing controls", "Blender's evaluation", "reading back")


def now() -> Any:
    """Milliseconds of the clock, and of this thread's processor time."""
    return 1000.0 * np.array([time.perf_counter(), time.thread_time()])


class Stopwatch:
    """Adds up the time spent in methods, since the last `lap`, in milliseconds: of the clock, and of this thread alone.

    The second measures the work itself while other programs use the processor.
    """

    def __init__(self) -> None:
        """Nothing is watched yet."""
        self.spent: dict[str, Any] = defaultdict(lambda: np.zeros(2))
        self._undo: list[tuple[Any, str, Any]] = []

    def watch(self, owner: Any, name: str, label: str) -> None:
        """Time a method from now on."""
        original = getattr(owner, name)

        def timed(*given: Any, **named: Any) -> Any:
            began = now()
            try:
                return original(*given, **named)
            finally:
                self.spent[label] += now() - began

        self._undo.append((owner, name, owner.__dict__[name] if isinstance(owner, type) else original))
        setattr(owner, name, timed)

    def lap(self) -> dict[str, Any]:
        """Return the time spent, and restart."""
        found = dict(self.spent)
        self.spent.clear()
        return found

    def end(self) -> None:
        """Watch no more."""
        for owner, name, original in reversed(self._undo):
            setattr(owner, name, original)


def watch_all(watch: Stopwatch) -> None:
    """The parts of a frame."""
    from stiv.blender.controls import lattice_points
    from stiv.blender.edit import blender_edit, state_writer
    from stiv.blender.verify import verification

    watch.watch(blender_edit.BlenderEdit, "drag", "solving")
    watch.watch(blender_edit.BlenderEdit, "write", "write, all")
    watch.watch(blender_edit.BlenderEdit, "write_taken", "write, all")
    watch.watch(state_writer.StateWriter, "write", "writing and evaluation")
    watch.watch(lattice_points.LatticeWriter, "write", "writing controls")
    watch.watch(verification, "read_shown", "reading back")


def measured(window: Window, key: str, step: tuple[int, int]) -> Steps:
    """A drag from the middle of the view: medians from the event to the drawn frame, their parts, and Esc."""
    centre = window.pixel((0.0, 0.0, 0.0)) if key == "M" else window.pixel(tuple(bpy.context.object.dimensions / 2))
    for offset in (0, 1, 0):
        window.move(centre[0] + offset, centre[1])
        yield
    watch = Stopwatch()
    watch_all(watch)
    try:
        began = time.perf_counter()
        yield from start(window, key)
        print(
            f"start of the drag, to the first event after it: {1000.0 * (time.perf_counter() - began):.0f} ms",
            flush=True,
        )
        laps = []
        for number in range(1, MOVES + 1):
            watch.lap()
            sent, drawn = now(), window.drawn_at
            window.move(centre[0] + step[0] * number, centre[1] + step[1] * number)
            while window.drawn_at == drawn or "write, all" not in watch.spent:
                assert window.dragging(), "the drag has ended"
                yield 0.001
            lap = watch.lap()
            # The clock as the frame was drawn; the thread's time has run on a little further.
            lap["event to drawn frame"] = np.array([1000.0 * window.drawn_at - sent[0], (now() - sent)[1]])
            lap["Blender's evaluation"] = lap.get("writing and evaluation", 0.0) - lap.get("writing controls", 0.0)
            laps.append(lap)
        window.move(centre[0] + 2 * step[0] * MOVES, centre[1] + 2 * step[1] * MOVES)
        yield 0.02  # Esc arrives while this one is solved
        sent = now()
        window.key("ESC")
        while window.dragging():
            yield 0.001
        clock, own = now() - sent
        print(f"Esc: {clock:.0f} ms, of this thread {own:.0f} ms", flush=True)
    finally:
        watch.end()
    for label in HEAD:
        clock, own = np.transpose([lap.get(label, np.zeros(2)) for lap in laps])
        print(f"{label}: {statistics.median(clock):.1f} ms, least {clock.min():.1f}, most {clock.max():.1f};", end=" ")
        print(f"of this thread {statistics.median(own):.1f} ms", flush=True)


def measure_plant(window: Window) -> Steps:
    """The lattice of a plant of 26.8 thousand triangles moved down into its vase."""
    bpy.ops.wm.open_mainfile(filepath=str(PLANT))
    yield from window.settle()
    bpy.context.scene.stiv.object_response = "deform"
    with window.override():
        scenes.select_only(bpy.data.objects["Lattice"])
        bpy.ops.view3d.view_all(center=True)
    yield from window.settle(10)
    yield from measured(window, "M", (0, -PIXELS))


def measure_pressed(window: Window) -> Steps:
    """A body of 69 thousand triangles in a lattice, 35 thousand vertices, grown against the inside of a shell."""
    sys.path.insert(0, str(ROOT))
    from blend_fixtures.scenes.detection_steps import rounded_box

    with window.override():
        scenes.clear()
        for name, shape in (("Body", rounded_box(76, 0.12)), ("Shell", rounded_box(23, 0.1, 1.0215))):
            mesh = bpy.data.meshes.new(name)
            turned = shape.turned((0.3, 0.2, 0.1))
            mesh.from_pydata(turned.vertices.tolist(), [], [list(face) for face in turned.faces])
            bpy.context.collection.objects.link(bpy.data.objects.new(name, mesh))
        data = bpy.data.lattices.new("Lattice")
        data.points_u = data.points_v = data.points_w = 8
        lattice = bpy.data.objects.new("Lattice", data)
        lattice.scale = (2.6, 2.6, 2.6)
        bpy.context.collection.objects.link(lattice)
        bpy.data.objects["Body"].modifiers.new("Lattice", "LATTICE").object = lattice
        bpy.data.objects["Shell"].display_type = "WIRE"
        scenes.select_only(lattice)
        scenes.look_from_above(window.area)
        bpy.context.scene.stiv.object_response = "deform"
    yield from window.settle(10)
    yield from measured(window, "E", (PIXELS, 0))


MEASURES = {"measure_plant": measure_plant, "measure_pressed": measure_pressed}
