# SPDX-License-Identifier: GPL-3.0-or-later
"""Proportional editing in a drag: points of a strip and of a lattice."""

from __future__ import annotations

import bmesh
import bpy
import extension
import scenes
from playing import CLOSE, INTO_WALL, click, expect_free, expect_near, prepared, start
from simulation import Steps, Window


def strip_y(at_x: float) -> float:
    """Displacement of the strip along y at x."""
    content = bmesh.from_edit_mesh(bpy.data.objects["Strip"].data)
    return max(vertex.co.y for vertex in content.verts if abs(vertex.co.x - at_x) < 0.05) - 0.2


def circle_radius() -> float | None:
    """Radius of the circle that is drawn; None without one."""
    shown = extension.module("overlay.guides").shown()
    return None if shown is None else shown.radius


def proportional(window: Window) -> Steps:
    """O moves neighbours too, the wheel and the page keys change the size, Shift+O the falloff."""
    yield from prepared(window, scenes.add_strip, "Strip", "EDIT")
    content = bmesh.from_edit_mesh(bpy.context.object.data)
    for vertex in content.verts:
        vertex.select_set(vertex.co.x > 1.1)
    content.select_flush_mode()
    bmesh.update_edit_mesh(bpy.context.object.data)
    yield from start(window)
    window.key("Y")
    yield from window.glide(window.pixel((0.0, 0.5, 0.0)))
    expect_near(strip_y(1.2), 0.5, CLOSE, "the end of the strip")
    expect_near(strip_y(0.6), 0.0, 1e-6, "a neighbour without proportional editing")
    window.key("O")
    yield from window.settle()
    before, radius = strip_y(0.6), circle_radius()
    assert 0.05 < before < 0.45, before
    window.picture("proportional")
    assert radius == 1.0 and strip_y(0.0) < 1e-6 < strip_y(0.3), "the circle encloses the moved vertices"
    for _ in range(4):
        window.key("WHEELDOWNMOUSE")
        yield
    window.key("PAGE_UP")
    yield from window.settle()
    larger = strip_y(0.6)
    assert larger > before + 0.05, (before, larger)
    expect_near(circle_radius() or 0.0, radius * 1.1**5, 1e-3, "the circle after five steps of its size")
    for _ in range(6):
        window.key("O", shift=True)  # smooth, ... constant
        yield
    yield from window.settle()
    expect_near(strip_y(0.6), strip_y(1.2), 1e-5, "a neighbour with the constant falloff")
    yield from click(window)
    assert circle_radius() is None
    expect_near(strip_y(0.6), 0.5, CLOSE, "a neighbour after confirming")
    expect_free(window)
    yield from window.undo()
    expect_near(max(abs(strip_y(0.6)), abs(strip_y(1.2))), 0.0, 1e-6, "the strip after undo")


def proportional_lattice(window: Window) -> Steps:
    """Neighbouring points of a lattice move with the selection; the ball in it stops at the wall."""
    yield from prepared(window, scenes.add_ball_in_lattice, "Lattice", "EDIT")
    bpy.context.scene.tool_settings.use_proportional_edit = True
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    expect_near(scenes.evaluated_extent("Ball"), scenes.WALL_FACE, 0.1, "the ball at the wall")
    yield from click(window)
    expect_free(window)


_ALL = (
    proportional,
    proportional_lattice,
)
PROPORTIONAL_EDITING = {scenario.__name__: scenario for scenario in _ALL}
