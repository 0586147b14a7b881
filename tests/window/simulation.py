# SPDX-License-Identifier: GPL-3.0-or-later
"""Keyboard and mouse of the window under test."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable, Generator
from pathlib import Path
from typing import Any

import bpy
import extension
from bpy_extras.view3d_utils import location_3d_to_region_2d

Steps = Generator[float | None, None, None]  # a number: seconds until the next step, None: as usual
DIGIT_NAMES = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")
CHARACTER_KEYS = (
    {str(digit): name for digit, name in enumerate(DIGIT_NAMES)}
    | {".": "PERIOD", "-": "MINUS", "=": "EQUAL", "+": "NUMPAD_PLUS", "*": "NUMPAD_ASTERIX", "\t": "TAB", " ": "SPACE"}
    | {letter: letter.upper() for letter in "abcdefghijklmnopqrstuvwxyz"}
)
SETTLE = 4  # ticks after which Blender has handled an event, solved and drawn


class Window:
    """The first window of Blender and its 3D view; positions of the mouse are pixels of the window."""

    def __init__(self, output: Path):
        """Watch the drawing of the 3D view; pictures go to `output`."""
        self.output = output
        self.mouse = (0, 0)
        self.send: Callable[..., None] = self._simulate
        self._draws = 0
        self.drawn_at = 0.0
        self._watch_interface()
        bpy.types.SpaceView3D.draw_handler_add(self._count, (), "WINDOW", "POST_PIXEL")

    def _count(self) -> None:
        self._draws += 1
        self.drawn_at = time.perf_counter()

    def _watch_interface(self) -> None:
        """Count the timers and texts that a drag adds and removes, which Blender does not list."""
        window_io = extension.module("operators.window_io")
        self.timers, self.texts = 0, False
        start_timer, stop_timer, show, clear = (
            getattr(window_io, name) for name in ("start_timer", "stop_timer", "show", "clear")
        )

        def started(*given: Any) -> Any:
            self.timers += 1
            return start_timer(*given)

        def stopped(*given: Any) -> None:
            stop_timer(*given)
            self.timers -= 1

        def shown(*given: Any) -> None:
            self.texts = True
            show(*given)

        def cleared(*given: Any) -> None:
            clear(*given)
            self.texts = False

        window_io.start_timer, window_io.stop_timer, window_io.show, window_io.clear = started, stopped, shown, cleared

    def leftovers(self) -> str:
        """Leftovers of a drag, empty if none."""
        left = {"a running operator": self.dragging(), "a timer": self.timers != 0, "a text in the header": self.texts}
        return ", ".join(name for name, is_left in left.items() if is_left)

    @property
    def handle(self) -> Any:
        """Blender's window; looked up at each use, since loading a file replaces it."""
        return bpy.context.window_manager.windows[0]

    @property
    def area(self) -> Any:
        """The 3D view."""
        return next(area for area in self.handle.screen.areas if area.type == "VIEW_3D")

    @property
    def region(self) -> Any:
        """Its main region."""
        return next(region for region in self.area.regions if region.type == "WINDOW")

    def override(self) -> Any:
        """The context of the 3D view, which timers do not have."""
        return bpy.context.temp_override(window=self.handle, area=self.area, region=self.region)

    def first_draw(self, limit: float) -> Steps:
        """Wait until the 3D view has been drawn."""
        deadline = time.time() + limit
        while self._draws < 1:
            assert time.time() < deadline, "the window was never drawn"
            self.area.tag_redraw()
            yield

    def next_draw(self, limit: float = 20.0) -> Steps:
        """Wait until the 3D view has been drawn once more."""
        drawn = self._draws
        self.area.tag_redraw()
        yield from self.until(lambda: self._draws > drawn, "a drawing", limit)

    def settle(self, ticks: int = SETTLE) -> Steps:
        """Wait for some ticks of Blender."""
        for _ in range(ticks):
            yield

    def until(self, condition: Callable[[], bool], what: str, limit: float = 20.0) -> Steps:
        """Wait for a condition."""
        deadline = time.time() + limit
        while not condition():
            assert time.time() < deadline, f"never came: {what}"
            yield

    def pixel(self, point: tuple[float, float, float]) -> tuple[int, int]:
        """The pixel of a world position in the window."""
        seen = location_3d_to_region_2d(self.region, self.area.spaces.active.region_3d, point)
        return self.region.x + round(seen[0]), self.region.y + round(seen[1])

    def event(self, kind: str, value: str, **modifiers: Any) -> None:
        """One event at the position of the mouse."""
        self.send(kind, value, self.mouse, **modifiers)

    def _simulate(self, kind: str, value: str, mouse: tuple[int, int], **modifiers: Any) -> None:
        """Simulate it with Blender's own function, which needs a command-line option."""
        self.handle.event_simulate(type=kind, value=value, x=mouse[0], y=mouse[1], **modifiers)

    def key(self, kind: str, text: str = "", **modifiers: bool) -> None:
        """Press and release a key or button."""
        self.event(kind, "PRESS", **modifiers, **({"unicode": text} if text else {}))
        self.event(kind, "RELEASE", **modifiers)

    def type(self, text: str) -> Steps:
        """Type characters; a tabulator is the key Tab."""
        for character in text:
            self.key(CHARACTER_KEYS[character], character if character.isprintable() else "")
            yield

    def move(self, x: int, y: int, **modifiers: bool) -> None:
        """Move the mouse."""
        self.mouse = (x, y)
        self.event("MOUSEMOVE", "NOTHING", **modifiers)

    def glide(self, target: tuple[int, int], steps: int = 8, **modifiers: bool) -> Steps:
        """Move the mouse in a straight line."""
        start = self.mouse
        for i in range(1, steps + 1):
            share = i / steps
            x, y = (round(a + (b - a) * share) for a, b in zip(start, target, strict=True))
            self.move(x, y, **modifiers)
            yield
        yield from self.settle()

    def rest_at(self, point: tuple[float, float, float]) -> Steps:
        """Move the mouse over a world position; Blender needs several moves to track it."""
        x, y = self.pixel(point)
        for offset in (0, 1, 0):
            self.move(x + offset, y)
            yield

    def undo(self) -> Steps:
        """Ctrl-Z."""
        self.key("Z", ctrl=True)
        yield from self.settle()

    def redo(self) -> Steps:
        """Ctrl-Shift-Z."""
        self.key("Z", ctrl=True, shift=True)
        yield from self.settle()

    def picture(self, name: str) -> None:
        """A picture of the whole screen, as <name>.png."""
        subprocess.run(["import", "-window", "root", str(self.output / f"{name}.png")], check=True)

    def dragging(self) -> bool:
        """Whether one of the transforms runs."""
        return any(operator.bl_idname.startswith("STIV_OT") for operator in self.handle.modal_operators)
