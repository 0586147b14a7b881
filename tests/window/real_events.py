# SPDX-License-Identifier: GPL-3.0-or-later
"""Drags by keyboard and mouse of the display, like those of a user; Blender must not simulate events."""

from __future__ import annotations

import subprocess
from typing import Any

import scenes
from playing import FURTHEST, INTO_WALL, NEAR, box_x, click, expect_free, expect_near, prepared, start
from simulation import Steps, Window

BUTTONS = {"LEFTMOUSE": "1", "RIGHTMOUSE": "3"}
KEYS = {"ESC": "Escape", "RET": "Return"}  # by their names on the display; letters by themselves


class Display:
    """Sends events by xdotool; positions of the mouse are pixels of the window, which covers the display."""

    def __init__(self, window: Window):
        """For the window that covers the display."""
        self.height = window.handle.height

    def send(self, kind: str, value: str, mouse: tuple[int, int], **modifiers: bool) -> None:
        """One event; modifiers are held from a press to its release."""
        if kind == "MOUSEMOVE":
            tell("mousemove", str(mouse[0]), str(self.height - 1 - mouse[1]))
            return
        held = [name for name, on in modifiers.items() if on]
        direction = "down" if value == "PRESS" else "up"
        what = (
            ("mouse" + direction, BUTTONS[kind])
            if kind in BUTTONS
            else ("key" + direction, KEYS.get(kind, kind.lower()))
        )
        holding: list[Any] = [("key" + direction, name) for name in held]
        for words in [*holding, what] if value == "PRESS" else [what, *holding]:
            tell(*words)


def tell(*words: str) -> None:
    """Run xdotool."""
    subprocess.run(["xdotool", *words], check=True)


def real_events(window: Window) -> Steps:
    """A box against a wall by the mouse, confirmed by a click, undone by its keys; another drag ended by Esc."""
    window.send = Display(window).send
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    expect_near(box_x(), FURTHEST, NEAR, "the box at the wall while dragging")
    window.picture("real_events")
    yield from click(window)
    expect_near(box_x(), FURTHEST, NEAR, "the box at the wall")
    expect_free(window)
    yield from window.undo()
    assert box_x() == 0.0, box_x()
    yield from window.rest_at((0.0, 0.0, 0.0))
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    yield from click(window, "ESC")
    assert box_x() == 0.0, box_x()


REAL_EVENTS = {"real_events": real_events}
