# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a drag takes in the window, on the plant in its vase; only when named, since nothing is asserted."""

from __future__ import annotations

import statistics
import time
from collections import defaultdict
from pathlib import Path
from typing import Any

import bpy
import scenes
from scenarios import click, start
from simulation import Steps, Window

PLANT = Path(__file__).resolve().parents[2] / "blend_fixtures/plant_in_vase.blend"
MOVES = 30


class Stopwatch:
    """Adds up the time spent in methods, since the last `lap`, in milliseconds."""

    def __init__(self) -> None:
        """Nothing is watched yet."""
        self.spent: dict[str, float] = defaultdict(float)
        self._undo: list[tuple[Any, str, Any]] = []

    def watch(self, owner: Any, name: str, label: str) -> None:
        """Time a method from now on."""
        original = getattr(owner, name)

        def timed(*given: Any, **named: Any) -> Any:
            began = time.perf_counter()
            try:
                return original(*given, **named)
            finally:
                self.spent[label] += 1000.0 * (time.perf_counter() - began)

        self._undo.append((owner, name, owner.__dict__[name] if isinstance(owner, type) else original))
        setattr(owner, name, timed)

    def lap(self) -> dict[str, float]:
        """What was spent, and start again."""
        found, self.spent = dict(self.spent), defaultdict(float)
        return found

    def end(self) -> None:
        """Watch no more."""
        for owner, name, original in reversed(self._undo):
            setattr(owner, name, original)


def measure_plant(window: Window) -> Steps:
    """The lattice moved into the vase: medians from the event to the drawn frame, and what they are made of."""
    from stiv.blender import edit as edit_module
    from stiv.blender import verification

    bpy.ops.wm.open_mainfile(filepath=str(PLANT))
    yield from window.settle()
    bpy.context.scene.stiv.object_response = "deform"
    with window.override():
        scenes.select_only(bpy.data.objects["Lattice"])
        bpy.ops.view3d.view_all(center=True)
    yield from window.settle(10)
    centre = window.pixel(tuple(bpy.data.objects["Lattice"].matrix_world.translation))
    for offset in (0, 1, 0):
        window.move(centre[0] + offset, centre[1])
        yield
    watch = Stopwatch()
    watch.watch(edit_module.BlenderEdit, "drag", "solving")
    watch.watch(edit_module.BlenderEdit, "write", "write, all")
    watch.watch(edit_module.BlenderEdit, "_write", "write controls and evaluate")
    watch.watch(verification, "read_shown", "read back")
    try:
        began = time.perf_counter()
        yield from start(window)
        print(f"start of the drag, to the first event after it: {1000.0 * (time.perf_counter() - began):.0f} ms")
        laps = []
        for step in range(MOVES):
            watch.lap()
            sent, drawn = time.perf_counter(), window.drawn_at
            window.move(centre[0], centre[1] - 4 * step)
            while window.drawn_at == drawn or "write, all" not in watch.spent:
                yield 0.001
            laps.append(watch.lap() | {"event to drawn frame": 1000.0 * (window.drawn_at - sent)})
        yield from window.glide((centre[0], centre[1] - 4 * MOVES - 60), 30)
        sent = time.perf_counter()
        window.key("ESC")
        while window.dragging():
            yield 0.001
        print(f"Esc: {1000.0 * (time.perf_counter() - sent):.0f} ms")
    finally:
        watch.end()
    for label in laps[-1]:
        values = sorted(lap.get(label, 0.0) for lap in laps)
        print(f"{label}: median {statistics.median(values):.1f} ms, worst {values[-1]:.1f} ms", flush=True)
    yield from click(window) if window.dragging() else iter(())


MEASURES = {"measure_plant": measure_plant}
