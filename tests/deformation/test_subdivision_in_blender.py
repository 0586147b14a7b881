# SPDX-License-Identifier: GPL-3.0-or-later
"""Subdivision weights against Blender's Subdivision Surface modifier."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs Blender as a Python module (bpy)")
import bmesh  # noqa: E402

import stiv  # noqa: E402
from tests.deformation.cages import CASES, CageCase, creased_cylinder, cube_with_both_creases, grid  # noqa: E402
from tests.deformation.evaluated_meshes import (  # noqa: E402
    cage_of,
    evaluated_positions,
    linked,
    new_mesh,
    read,
    size_of,
)

TOLERANCE = 1e-5  # of the object's size


def check_equal(item: Any, **options: Any) -> float:
    """Set the modifier, compare, and return the greatest difference relative to the object's size."""
    modifier = item.modifiers.get("subdivision") or item.modifiers.new("subdivision", "SUBSURF")
    modifier.levels = options.get("levels", 1)
    modifier.use_limit_surface = options.get("limit_surface", True)
    modifier.quality = options.get("quality", 3)
    modifier.subdivision_type = "SIMPLE" if options.get("simple") else "CATMULL_CLARK"
    modifier.boundary_smooth = options.get("boundary", "all").upper()
    expected = evaluated_positions(item)
    vertices = read(item.data.vertices, "co")
    found = stiv.linear(stiv.subdivision_weights(cage_of(item.data), **options)).surface(vertices)
    assert found.shape == expected.shape
    difference = float(np.abs(found - expected).max()) / size_of(vertices)
    assert difference < TOLERANCE, options
    return difference


@pytest.mark.parametrize("make_case", CASES)
@pytest.mark.parametrize("limit_surface", [True, False])
def test_every_rule(make_case: Callable[[], CageCase], limit_surface: bool) -> None:
    with linked(new_mesh(make_case())) as item:
        for levels in (1, 2, 3):
            for boundary in ("all", "preserve_corners"):
                check_equal(item, levels=levels, limit_surface=limit_surface, boundary=boundary)
            check_equal(item, levels=levels, limit_surface=limit_surface, simple=True)


@pytest.mark.parametrize("make_case", [cube_with_both_creases, creased_cylinder, grid])
@pytest.mark.parametrize("quality", [1, 2, 4, 6])
def test_quality(make_case: Callable[[], CageCase], quality: int) -> None:
    with linked(new_mesh(make_case())) as item:
        for levels in (1, 2, 3):
            check_equal(item, levels=levels, quality=quality)


@pytest.fixture
def monkey() -> Any:
    mesh = bpy.data.meshes.new("monkey")
    shape = bmesh.new()
    bmesh.ops.create_monkey(shape)
    shape.to_mesh(mesh)
    shape.free()
    return mesh


def test_monkey(monkey: Any) -> None:
    random = np.random.default_rng(9)
    creases = random.random(len(monkey.edges)) * (random.random(len(monkey.edges)) < 0.1)
    with linked(monkey) as item:
        for limit_surface in (True, False):
            for simple in (True, False):
                check_equal(item, levels=2, limit_surface=limit_surface, simple=simple)
        check_equal(item, levels=3)
        monkey.attributes.new("crease_edge", "FLOAT", "EDGE").data.foreach_set("value", creases)
        check_equal(item, levels=2)


def test_weights_hold_for_every_shape(monkey: Any) -> None:
    """The weights do not depend on where the cage's vertices are."""
    with linked(monkey) as item:
        check_equal(item, levels=2)
        moved = read(monkey.vertices, "co") + np.random.default_rng(10).normal(
            scale=0.2, size=(len(monkey.vertices), 3)
        )
        monkey.vertices.foreach_set("co", moved.astype(np.float32).ravel())
        monkey.update()
        check_equal(item, levels=2)


def test_no_level_and_many_levels() -> None:
    with linked(new_mesh(creased_cylinder())) as item:
        for levels in (0, 4, 5, 6):
            check_equal(item, levels=levels)
    with linked(new_mesh(grid(2))) as item:
        for limit_surface in (True, False):
            check_equal(item, levels=8, limit_surface=limit_surface)


def test_faces_are_those_of_blender(monkey: Any) -> None:
    with linked(monkey) as item:
        item.modifiers.new("subdivision", "SUBSURF").levels = 2
        bpy.context.view_layer.update()
        evaluated = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        expected = {frozenset(face.vertices) for face in evaluated.polygons}
        found = {frozenset(face.tolist()) for face in stiv.subdivided_faces(cage_of(monkey), 2)}
        assert found == expected
