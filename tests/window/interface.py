# SPDX-License-Identifier: GPL-3.0-or-later
"""The interface in a large and in a small window: header, status bar, redo panel, sidebar and overlay."""

from __future__ import annotations

import subprocess
from typing import Any

import bpy
import extension
import scenes
from playing import FURTHEST, INTO_WALL, NEAR, box_x, click, expect_near, prepared, start
from scenes import WALL_FACE
from simulation import Steps, Window

SMALL = (960, 600)


def resized(window: Window, width: int, height: int) -> Steps:
    """Give Blender's window another size, which its redraws follow."""
    found = subprocess.check_output(["xdotool", "search", "--onlyvisible", "--class", "blender"], text=True)
    subprocess.run(["xdotool", "windowsize", found.split()[-1], str(width), str(height)], check=True)
    yield from window.until(lambda: window.handle.width == width, "a window of another size")
    yield from window.settle(10)


def in_small_window(scenario: Any) -> Any:
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


def headers(window: Window) -> Steps:
    """Free, along an axis, and typed: no part of the header and no important key is left out."""
    yield from prepared(window, scenes.add_box, "Box")
    bpy.data.objects["Wall"].name = "The Wall Beside the Stairs of the House"
    io, lines, hints = extension.module("operators.window_io"), [], []
    fitted, hints_that_fit = io.fitted, io.hints_that_fit

    def record_line(parts: Any, fits: Any) -> str:
        lines.append((len(parts), fitted(parts, fits)))
        return str(lines[-1][1])

    def record_hints(given: Any, *others: Any) -> Any:
        hints.append((len(given), hints_that_fit(given, *others)))
        return hints[-1][1]

    io.fitted, io.hints_that_fit = record_line, record_hints
    try:
        for kind, key in {"move": "M", "rotate": "R", "scale": "E"}.items():
            yield from drag_with_pictures(window, kind, key)
    finally:
        io.fitted, io.hints_that_fit = fitted, hints_that_fit
    assert lines and hints
    for count, line in lines:
        assert line.count("  |  ") == count - 1, (count, line)
    for count, shown in hints:
        assert len(shown) >= min(count, 6), (count, shown)


def drag_with_pictures(window: Window, kind: str, key: str) -> Steps:
    """A cancelled drag into the wall, along X, and by a typed value."""
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


def overlay(window: Window) -> Steps:
    """Contacts, clearance and ghost: only while the box that is drawn touches the wall, and at its place."""
    yield from prepared(window, scenes.add_box, "Box")
    scenes.look_from_corner(window.area)
    yield from window.settle()
    yield from window.rest_at((0.0, 0.0, 0.0))
    display = extension.module("overlay.display")
    yield from start(window)
    window.key("X")
    for place in (0.8, 1.3, 2.2, 3.2):
        yield from window.glide(window.pixel((place, 0.0, 0.0)))
        yield from window.until(lambda: display.content().milliseconds is not None, "a step of the drag")
        found = display.content()
        lit = found.contacts is not None and len(found.contacts.triangles) > 0
        assert lit == (place > FURTHEST), (place, lit)
        if lit:
            expect_near(box_x(), FURTHEST, NEAR, "the box that is drawn")
            where = found.contacts.triangles[found.contacts.strengths > 0.5][:, 0]
            assert abs(where - WALL_FACE).max() < 0.1, where
            assert found.ghost.points[:, 0].mean() > box_x() + 0.5, found.ghost
            assert 0.0 < found.clearance.distance < NEAR, found.clearance
    window.picture(f"overlay_{window.handle.width}")
    yield from click(window, "ESC")
    assert not display.content()


def sidebar(window: Window) -> Steps:
    """The tab at its default width, after a check of a scene that intersects, and the redo panel of the check."""
    yield from prepared(window, scenes.add_box, "Box")
    bpy.data.objects["Box"].location.x = WALL_FACE
    selected = [obj.name for obj in bpy.context.selected_objects]
    window.area.spaces.active.show_region_ui = True
    yield from window.settle()
    region = next(region for region in window.area.regions if region.type == "UI")
    region.active_panel_category = "STIV"
    with window.override():
        bpy.ops.ed.undo_push(message="moved")
        assert bpy.ops.stiv.check("EXEC_DEFAULT", True) == {"FINISHED"}
    assert [obj.name for obj in bpy.context.selected_objects] == selected
    assert bpy.context.window_manager.stiv_check.summary.startswith("Box cuts Wall, "), "the summary"
    yield from window.settle(10)
    window.picture(f"sidebar_{window.handle.width}")
    yield from window.rest_at((-1.0, 0.0, 0.0))
    window.key("F9")
    yield from window.settle(10)
    window.picture(f"redo_check_{window.handle.width}")
    window.key("ESC")
    window.area.spaces.active.show_region_ui = False
    yield from window.settle()


_BOTH = (headers, overlay, sidebar)
INTERFACE = {scenario.__name__: scenario for each in _BOTH for scenario in (each, in_small_window(each))}
