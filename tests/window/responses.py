# SPDX-License-Identifier: GPL-3.0-or-later
"""Suzanne at walls, as an artist drags her: she slides without turning, T lets her turn, locks and proportions hold."""

from __future__ import annotations

import math

import bpy
import scenes
from playing import click, ended, start
from simulation import Steps, Window


def _monkey(window: Window, *walls: tuple[float, float]) -> Steps:
    """Suzanne at the origin, and walls across x at these places, turned by these angles."""
    with window.override():
        scenes.clear()
        for x, angle in walls:
            bpy.ops.mesh.primitive_cube_add(size=1, location=(x, 0, 0), rotation=(0, 0, angle), scale=(0.2, 14, 6))
        bpy.ops.mesh.primitive_monkey_add(size=1.6, rotation=(0.2, 0, 0.3))
        scenes.look_from_above(window.area)
        bpy.ops.ed.undo_push(message="start")
    yield from window.settle()
    yield from window.rest_at((0.0, 0.0, 0.0))


def _rotation() -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in bpy.data.objects["Suzanne"].matrix_world.to_3x3())


def _expect_apart(window: Window) -> None:
    """Her eyes cut her head; nothing else intersects."""
    with window.override():
        assert bpy.ops.stiv.check() == {"FINISHED"}
    found = bpy.context.window_manager.stiv_check.summary.splitlines()
    assert "Suzanne cuts itself" in found[0] and not any("Cube" in line for line in found), found


def figure_at_wall(window: Window) -> Steps:
    """She once ended turned by 90 degrees."""
    yield from _monkey(window, (2.2, 0.5))
    before = _rotation()
    yield from start(window)
    yield from window.glide(window.pixel((3.4, 0.6, 0.0)))
    yield from window.settle()
    figure = bpy.data.objects["Suzanne"]
    slid = figure.location.copy()
    assert slid.length > 0.9, slid
    assert _rotation() == before
    window.picture("figure_at_wall")
    window.key("T")
    yield from window.until(lambda: _rotation() != before, "Suzanne turned by the wall")
    yield from window.settle()
    window.picture("figure_at_wall_turned")
    window.key("T")
    yield from window.settle()
    window.picture("figure_at_wall_deformed")
    window.key("T")
    yield from window.until(lambda: _rotation() == before, "Suzanne sliding again")
    yield from click(window)
    assert _rotation() == before
    _expect_apart(window)
    yield from window.undo()
    assert bpy.data.objects["Suzanne"].location.length == 0


def figure_along_an_axis(window: Window) -> Steps:
    """X, typed 6, once ended at Y -0.36, Z 0.40."""
    yield from _monkey(window, (2.2, 0.5))
    before = _rotation()
    yield from start(window)
    window.key("X")
    yield from window.glide(window.pixel((3.4, 1.0, 0.0)))
    yield from window.settle()
    x, y, z = bpy.data.objects["Suzanne"].location
    assert x > 0.3 and y == z == 0, (x, y, z)
    yield from window.type("6")
    window.key("RET")
    yield from ended(window)
    x, y, z = bpy.data.objects["Suzanne"].location
    assert 0.3 < x < 2 and y == z == 0, (x, y, z)
    assert _rotation() == before
    window.picture("figure_along_an_axis")
    _expect_apart(window)


def figure_scaled_between_walls(window: Window) -> Steps:
    """She once ended at (3.55, 6.88, 6.89)."""
    yield from _monkey(window, (2.6, 0.1), (-2.4, -0.1))
    yield from start(window, "E")
    yield from window.type("7")
    window.key("RET")
    yield from ended(window)
    x, y, z = bpy.data.objects["Suzanne"].scale
    assert x == y == z and 1.5 < x < 5, (x, y, z)
    window.picture("figure_scaled_between_walls")
    _expect_apart(window)


def figure_rotated_at_wall(window: Window) -> Steps:
    """The cursor is her pivot, and stays it."""
    yield from _monkey(window, (1.6, 0.0))
    figure, pivot = bpy.data.objects["Suzanne"], (-1.0, -2.0, 0.0)
    bpy.context.scene.cursor.location = pivot
    bpy.context.scene.tool_settings.transform_pivot_point = "CURSOR"
    before = figure.matrix_world.inverted() @ bpy.context.scene.cursor.location
    yield from start(window, "R")
    yield from window.type("90-")
    window.key("RET")
    yield from ended(window)
    figure = bpy.data.objects["Suzanne"]
    moved = (figure.matrix_world @ before - bpy.context.scene.cursor.location).length
    angle = 0.3 - figure.rotation_euler.z
    assert moved < 1e-5, moved
    assert 0.05 < angle < math.radians(89), angle
    window.picture("figure_rotated_at_wall")
    _expect_apart(window)


_ALL = (figure_at_wall, figure_along_an_axis, figure_scaled_between_walls, figure_rotated_at_wall)
RESPONSES = {scenario.__name__: scenario for scenario in _ALL}
