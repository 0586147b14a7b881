# SPDX-License-Identifier: GPL-3.0-or-later
"""The interface in a large and in a small window: header, status bar, redo panel, sidebar and overlay."""

from __future__ import annotations

import subprocess

import bpy
import scenes
from playing import INTO_WALL, click, prepared, start
from simulation import Steps, Window

SMALL = (960, 600)


def resized(window: Window, width: int, height: int) -> Steps:
    """Give Blender's window another size, which its redraws follow."""
    found = subprocess.check_output(["xdotool", "search", "--onlyvisible", "--class", "blender"], text=True)
    subprocess.run(["xdotool", "windowsize", found.split()[-1], str(width), str(height)], check=True)
    yield from window.until(lambda: window.handle.width == width, "a window of another size")
    yield from window.settle(10)


def in_small_window(scenario: object) -> object:
    """The scenario in a window of 960 by 600 pixels."""

    def small(window: Window) -> Steps:
        before = window.handle.width, window.handle.height
        yield from resized(window, *SMALL)
        try:
            yield from scenario(window)
        finally:
            yield from resized(window, *before)

    small.__name__ = f"{scenario.__name__}_small"
    return small


def blender_headers(window: Window) -> Steps:
    """Blender's own headers, to compare by eye."""
    yield from prepared(window, scenes.add_box, "Box")
    for key in "GRS":
        window.key(key)
        yield from window.settle()
        yield from window.glide(window.pixel((0.7, 0.4, 0.0)))
        window.picture(f"blender_{key}")
        window.key("X")
        yield from window.settle()
        window.picture(f"blender_{key}_x")
        window.key("ESC")
        yield from window.settle()


def headers(window: Window) -> Steps:
    """Ours: free, along an axis, typed, and blocked by two objects with long names."""
    yield from prepared(window, scenes.add_box, "Box")
    bpy.data.objects["Wall"].name = "The Wall Beside the Stairs of the House"
    for kind, key in {"move": "M", "rotate": "R", "scale": "E"}.items():
        yield from window.rest_at((0.0, 0.0, 0.0))
        yield from start(window, key)
        yield from window.glide(window.pixel(INTO_WALL))
        window.picture(f"header_{kind}_{window.handle.width}")
        window.key("X")
        yield from window.settle()
        window.picture(f"header_{kind}_x_{window.handle.width}")
        yield from window.type("1.5")
        yield from window.settle()
        window.picture(f"header_{kind}_typed_{window.handle.width}")
        yield from click(window, "ESC")


_BOTH = (headers,)
INTERFACE = {scenario.__name__: scenario for each in _BOTH for scenario in (each, in_small_window(each))}
INTERFACE |= {"blender_headers": blender_headers}
