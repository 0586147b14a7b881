# SPDX-License-Identifier: GPL-3.0-or-later
"""Quads that flip back and forth, with an obstacle near the other diagonal, compared with a new test of the scene."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_cube, mesh

import stiv
from stiv.blender import check_scene
from stiv.blender.scene import triangulation_flips
from stiv.blender.scene.assembly import Assembly, assemble
from stiv.blender.scene.evaluated_scene import read_scene
from stiv.blender.verify.verification import Verifier, read_shown

WINGS = (1, 3)  # corners that bend a square cut along the x axis
BENDS = (0.1, 2.0, 0.1, 2.1, -2.0, 0.5, 1.9)  # Blender splits along the other diagonal from 1 on


def add_sheet(distance: float = 3.0) -> Any:
    """Two squares side by side, each with its own corners."""
    square = [(-1, 0, 0), (0, -1, 0), (1, 0, 0), (0, 1, 0)]
    corners = [(x + shift, y, z) for shift in (0, distance) for x, y, z in square]
    return add("Sheet", mesh("Sheet", corners, [(0, 1, 2, 3), (4, 5, 6, 7)]))


def bend(sheet: Any, heights: tuple[float, float]) -> None:
    for first, height in zip((0, 4), heights, strict=True):
        for corner in WINGS:
            sheet.data.vertices[first + corner].co.z = height
    sheet.data.update()
    bpy.context.view_layer.update()


def read() -> Assembly:
    meshes = read_scene(bpy.context).meshes
    return assemble(meshes, ["deformable"] * len(meshes))


def verifier_of(assembly: Assembly) -> Verifier:
    """It tests the triangles of the assembly each time."""
    return Verifier(assembly, lambda _, shown: len(stiv.find_intersections(shown, assembly.surface)) == 0)


def passes(verifier: Verifier) -> bool:
    """Does the present evaluation pass the test from itself?"""
    return verifier.verify(bpy.context, read_shown(bpy.context, verifier.assembly)).passed


@pytest.fixture
def readings(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Grows with each triangulation that a test reads from Blender."""
    found: list[int] = []
    read_triangles = triangulation_flips.read_triangles
    monkeypatch.setattr(triangulation_flips, "read_triangles", lambda each: found.append(1) or read_triangles(each))
    return found


def test_flips_between_diagonals_that_are_both_free_need_no_reading(readings: list[int]) -> None:
    sheet = add_sheet()
    verifier = verifier_of(read())
    for height in BENDS:
        bend(sheet, (height, -height))
        assert passes(verifier) and check_scene(bpy.context).pairs == ()
    assert not readings


@pytest.mark.parametrize("post", [0, 1])
def test_a_flip_into_a_post_is_found_each_time(post: int) -> None:
    """The second quad flips only after the first one was included. The post stands where the other diagonal goes."""
    sheet = add_sheet()
    add_cube("Post", (3 * post, 0, 3.3), 1, scale=(0.02, 0.02, 3))  # from z = 0.3 up
    verifier = verifier_of(read())
    found = []
    for heights in [(0.1, 0.0), (2.0, 0.1), (0.1, 2.0), (0.2, 0.2), (2.0, 0.2), (2.0, 2.0), (0.0, 2.0), (0.1, -2.0)]:
        bend(sheet, heights)
        found.append(passes(verifier))
        assert found[-1] == (check_scene(bpy.context).pairs == ())
    assert {True, False} == set(found)


def test_a_post_that_approaches_after_the_flip_is_found() -> None:
    """Only the triangles of the former test remain; it is repeated at the new positions."""
    sheet = add_sheet()
    post = add_cube("Post", (0, 4, 3.3), 1, scale=(0.02, 0.02, 3))
    verifier = verifier_of(read())
    for y, free in [(4.0, True), (0.0, False), (4.0, True), (0.0, False)]:
        post.location.y = y
        bend(sheet, (2.0, 2.0))
        assert passes(verifier) == free == (check_scene(bpy.context).pairs == ())


def test_a_quad_that_was_flipped_at_the_start_is_tested_when_it_flips_back() -> None:
    """The bar is below the flipped quad, and in the way of its first diagonal."""
    sheet = add_sheet()
    bend(sheet, (2.0, 0.0))
    add_cube("Bar", (0, 0, 0), 1, scale=(0.02, 0.02, 0.1))
    verifier = verifier_of(read())
    for height, free in [(2.0, True), (0.7, False), (1.6, True), (0.5, False), (2.0, True)]:
        bend(sheet, (height, 0.0))
        assert passes(verifier) == free == (check_scene(bpy.context).pairs == ())


def test_random_bends_pass_exactly_where_a_new_test_finds_nothing() -> None:
    sheet = add_sheet(distance=1.2)
    verifier = verifier_of(read())
    chance, found = np.random.default_rng(3), []
    start = np.array([vertex.co for vertex in sheet.data.vertices])
    start[4:, 1] += 0.7
    for _ in range(60):
        moved = start + chance.choice([0.1, 0.6, 1.5]) * chance.normal(size=start.shape) * (0.2, 0.2, 1)
        sheet.data.vertices.foreach_set("co", moved.astype(np.float32).ravel())
        sheet.data.update()
        bpy.context.view_layer.update()
        free = check_scene(bpy.context).pairs == ()
        verdict = passes(verifier)
        assert not verdict or free  # what passes is free in Blender's own triangulation
        found.append((verdict, free))
    assert (True, True) in found and (False, False) in found
