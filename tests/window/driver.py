# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender: plays the scenarios in sequence and writes results.json beside the pictures."""

from __future__ import annotations

import faulthandler
import json
import os
import sys
import time
import traceback
from collections.abc import Callable, Generator
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
TICK = 0.05  # seconds between two steps of a scenario: Blender handles events and draws in between
UNDO_STEPS = 256  # the most that Blender keeps: scenarios count their steps, which a full history would hide
HANG = 300.0  # seconds without a step after which Blender is ended, with the place where it hangs
DRAW_LIMIT = 120.0  # seconds for the first picture; software rendering compiles its shaders first


class Driver:
    """Plays generators: each `yield` hands control back to Blender for a tick."""

    def __init__(self, output: Path, names: list[str]):
        """Choose scenarios by name; none means all."""
        from deforming_drags import DEFORMING_DRAGS
        from disturbed_drags import DISTURBED_DRAGS
        from drags import DRAGS
        from finishing import FINISHING
        from getting_started import GETTING_STARTED
        from grammar import GRAMMAR
        from guard_edit_mode import GUARD_EDIT_MODE
        from guard_long_correction import GUARD_LONG_CORRECTION
        from guard_new_geometry import GUARD_NEW_GEOMETRY
        from guard_scenarios import GUARD
        from guard_sculpting import GUARD_SCULPTING
        from guard_switch import GUARD_SWITCH
        from guard_uncorrected import GUARD_UNCORRECTED
        from guide_pictures import PICTURES
        from interface import INTERFACE
        from intersecting_starts import INTERSECTING_STARTS
        from languages import LANGUAGES
        from latency import LATENCIES
        from layout_scenarios import LAYOUT
        from measuring import MEASURES
        from morphing_drags import MORPHING_DRAGS
        from morphing_in_steps import MORPHING_IN_STEPS
        from posing_drags import POSING_DRAGS
        from proportional_editing import PROPORTIONAL_EDITING
        from real_events import REAL_EVENTS
        from redo_panel import REDO_PANEL
        from responses import RESPONSES
        from sequences import SEQUENCES
        from simulation import Window
        from snapping_and_pivots import SNAPPING_AND_PIVOTS
        from snapping_beside_blender import SNAPPING_BESIDE_BLENDER
        from undo_in_edit_mode import UNDO_IN_EDIT_MODE

        from tools import TOOLS

        bpy.context.preferences.edit.undo_steps = UNDO_STEPS
        self.window = Window(output)
        guard = GUARD | GUARD_NEW_GEOMETRY | GUARD_EDIT_MODE | GUARD_SCULPTING | GUARD_SWITCH | GUARD_UNCORRECTED
        guard |= GUARD_LONG_CORRECTION
        drags = DRAGS | FINISHING | DEFORMING_DRAGS | POSING_DRAGS | DISTURBED_DRAGS | RESPONSES | INTERSECTING_STARTS
        grammar = GRAMMAR | SNAPPING_AND_PIVOTS | SNAPPING_BESIDE_BLENDER | PROPORTIONAL_EDITING | REDO_PANEL
        usual = drags | grammar | guard | INTERFACE | LAYOUT | LANGUAGES | SEQUENCES | TOOLS | PICTURES
        usual |= GETTING_STARTED | MORPHING_DRAGS | MORPHING_IN_STEPS | UNDO_IN_EDIT_MODE
        chosen = {name: (usual | LATENCIES | MEASURES | REAL_EVENTS)[name] for name in names} or usual
        self.results = {"complete": False, "scenarios": {}}
        self.path = output / "results.json"
        self.steps = self.play(chosen)

    def play(self, chosen: dict) -> Generator[float | None, None, None]:
        """Wait for the first drawing (events before it are lost), then all scenarios."""
        yield from self.window.first_draw(DRAW_LIMIT)
        for name, scenario in chosen.items():
            started = time.time()
            self.save(name)  # in case it takes Blender down
            self.results["scenarios"][name] = yield from self.play_one(scenario)
            failure = self.results["scenarios"][name].strip()
            outcome = f"FAILED: {failure.splitlines()[-1]}" if failure else "passed"
            print(f"{name}: {time.time() - started:.1f} s, {outcome}", flush=True)
            self.save()
        self.results["complete"] = True

    def play_one(
        self, scenario: Callable[[object], Generator[float | None, None, None]]
    ) -> Generator[float | None, None, str]:
        """The failure of one scenario, empty if it passed; afterwards no drag and no message box is left over."""
        failure = ""
        try:
            yield from scenario(self.window)
        except Exception:
            failure = traceback.format_exc()
            self.window.picture(f"failed_{scenario.__name__}")
        self.window.key("ESC")
        yield from self.window.settle()
        return failure or self.window.leftovers()

    def save(self, running: str = "") -> None:
        """Write the results so far, so that a crash can be located."""
        self.path.write_text(json.dumps(self.results | {"running": running}))

    def tick(self) -> float:
        """Called by Blender's timer."""
        faulthandler.dump_traceback_later(HANG, exit=True)
        pause: float | None = TICK
        try:
            pause = next(self.steps)
        except StopIteration:
            self.save()
            leave(0)
        except Exception:
            traceback.print_exc()
            self.save()
            leave(3)
        return TICK if pause is None else pause


def leave(code: int) -> None:
    """End at once: a window that closes normally asks to save."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


def start() -> float | None:
    """Begin when the window exists."""
    if not bpy.context.window_manager.windows:
        return TICK
    try:
        import extension

        problem = extension.problem()
        assert not problem, problem
        output, *names = sys.argv[sys.argv.index("--") + 1 :]
        bpy.app.timers.register(Driver(Path(output), names).tick, persistent=True)  # files are opened
    except Exception:
        traceback.print_exc()
        leave(3)
    return None


bpy.context.preferences.view.show_splash = False  # it would swallow the first events
bpy.context.preferences.system.viewport_aa = "OFF"  # software rendering draws in half the time
bpy.app.timers.register(start)
