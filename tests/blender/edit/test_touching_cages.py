# SPDX-License-Identifier: GPL-3.0-or-later
"""Cages that touch other objects at the start, such as a cube on the floor in Edit Mode: they slide, rise and bend in
contact, and never cut deeper than rounding.
"""

from collections.abc import Callable
from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from building import (
    add_cube,
    add_grid,
    add_lattice,
    add_modifier,
    deepest,
    edit_mode,
    evaluated,
    select,
    shift,
    snapshot,
    turn,
)
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import stiv
from stiv.blender import BlenderEdit, EditSettings
from stiv.blender.edit import touching_start

DEEPEST = 64  # roundings of the largest coordinate
ROUNDING = 1e-5
SUPPRESSED = [HealthCheck.function_scoped_fixture]


def cube_on_floor(faces: int = 8) -> Any:
    """The default cube, exactly on a floor."""
    add_grid("Floor", faces, 6.0)
    return add_cube("Cube", (0.13, 0.21, 1))


def edited(cube: Any, chosen: Callable[[Any], bool]) -> Any:
    """The cube in Edit Mode, with the chosen vertices selected, by their place."""
    edit_mode(cube)
    content = bmesh.from_edit_mesh(cube.data)
    for vertex in content.verts:
        vertex.select = chosen(vertex.co)
    content.select_flush_mode()
    bmesh.update_edit_mesh(cube.data)
    return cube


def applied(matrix: np.ndarray, kind: str = "move", **changes: Any) -> stiv.EditResult:
    """An edit of a typed value, written; nothing cuts deeper than rounding."""
    edit = BlenderEdit.begin(bpy.context, EditSettings(**changes), kind)
    result = edit.apply(matrix)
    assert edit.write().passed
    bpy.ops.object.mode_set(mode="OBJECT")
    assert deepest() < DEEPEST
    return result


def top(place: Any) -> bool:
    return bool(place.z > 0)


def bottom(place: Any) -> bool:
    return bool(place.z < 0)


def test_the_top_moves_freely() -> None:
    cube = edited(cube_on_floor(), top)
    assert applied(shift(0.3, 0, 1)).status == "reached"
    assert evaluated(cube)[:, 2].max() == 3 and evaluated(cube)[:, 2].min() == 0


def test_the_bottom_slides_without_rising() -> None:
    cube = edited(cube_on_floor(), bottom)
    before = evaluated(cube)
    applied(shift(0.7, 0.3))
    expected = before + np.where(before[:, 2:] < 0.5, (0.7, 0.3, 0), 0)
    assert evaluated(cube) == pytest.approx(expected, abs=ROUNDING)


def test_the_bottom_rises() -> None:
    cube = edited(cube_on_floor(), bottom)
    assert applied(shift(0, 0, 0.5)).status == "reached"
    assert evaluated(cube)[:, 2].min() == pytest.approx(0.5)


def test_the_bottom_is_not_pressed_into_the_floor() -> None:
    cube = edited(cube_on_floor(), bottom)
    before = evaluated(cube)
    assert applied(shift(0, 0, -0.5)).status == "corrected"
    assert evaluated(cube) == pytest.approx(before, abs=ROUNDING)


@settings(suppress_health_check=SUPPRESSED, max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_any_motion_in_the_plane_of_the_floor_arrives(seed: int) -> None:
    """The edges of the floor's faces do not hold a cage that stands on it."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    chance = np.random.default_rng(seed)
    add_grid("Floor", int(chance.integers(1, 17)), 12.0)
    place = (*chance.uniform(-1, 1, 2), 1)
    if chance.random() < 0.5:
        bpy.ops.mesh.primitive_cylinder_add(vertices=int(chance.integers(3, 33)), location=place)
    cube = bpy.context.object if bpy.context.object else add_cube("Cube", place)
    cube.rotation_euler.z = chance.uniform(-1, 1)
    edited(cube, lambda _: True)
    before, kind = evaluated(cube), str(chance.choice(["move", "rotate", "scale"]))
    matrix = {
        "move": shift(*chance.uniform(-2, 2, 2)),
        "rotate": turn(chance.uniform(-0.6, 0.6), "Z"),
        "scale": np.diag([*chance.uniform(0.7, 1.4, 2), 1, 1]),
    }[kind]
    applied(matrix, kind)
    assert evaluated(cube) == pytest.approx(before @ matrix[:3, :3].T + matrix[:3, 3], abs=ROUNDING)


@pytest.mark.parametrize("seed", range(5))
def test_a_cage_moves_on_and_beside_a_table_but_not_into_it(seed: int) -> None:
    """Its faces and edges slide over those of the table, whose inside is compared with points on the cage."""
    chance = np.random.default_rng(seed)
    add_cube("Table", (0, 0, -0.5), 0.5, scale=(4, 3, 1))
    cube = add_cube("Cube", (*chance.uniform(-1, 1, 2), 1))
    for _ in range(5):
        way = chance.choice([-2, -1, -0.5, 0, 0, 0.5, 1, 2], 3) * (1, 1, 0.5)
        edited(cube, lambda _: True)
        middle = evaluated(cube).mean(axis=0)
        applied(shift(*way) @ turn(chance.uniform(-0.3, 0.3), "Z", middle), "rotate")
        assert _depth_in_table(cube, chance) < ROUNDING


def _depth_in_table(cube: Any, chance: np.random.Generator) -> float:
    """How deep random points on a mesh are inside the table."""
    cube.data.calc_loop_triangles()
    corners = evaluated(cube)[[list(each.vertices) for each in cube.data.loop_triangles]]
    points = (chance.dirichlet([0.5] * 3, 500) @ corners).reshape(-1, 3)
    return float((np.array([2, 1.5, 0.5]) - np.abs(points - [0, 0, -0.5])).min(axis=1).max())


@settings(suppress_health_check=SUPPRESSED, max_examples=12, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_any_motion_of_any_vertices_cuts_no_deeper_than_rounding(seed: int) -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    chance = np.random.default_rng(seed)
    chosen = iter(np.append(chance.uniform(size=8) < 0.4, True))
    cube = cube_on_floor(int(chance.integers(1, 9)))
    add_cube("Neighbor", (2.13, 0.21 + chance.uniform(-1, 1), 1))
    edited(cube, lambda _: bool(next(chosen)))
    if not cube.data.total_vert_sel:
        return
    applied(shift(*chance.uniform(-1, 1, 3)))


def test_subdivided_shapes_and_lattices_touch_too() -> None:
    cube = cube_on_floor()
    add_modifier(cube, "SUBSURF", subdivision_type="SIMPLE", levels=2, render_levels=2)
    edited(cube, bottom)
    applied(shift(0.7, 0.3, -0.1))
    assert evaluated(cube)[:, 2].min() == pytest.approx(0, abs=ROUNDING)
    cage = add_lattice("Cage", (2, 2, 2), (0, 0, 1), scale=(4, 4, 4))
    add_modifier(cube, "LATTICE", object=cage)
    edit_mode(cage)
    for point in cage.data.points:
        point.select = True
    applied(shift(0, 0, -0.4))
    assert evaluated(cube)[:, 2].min() == pytest.approx(0, abs=ROUNDING)


def test_cages_in_object_mode_touch_too() -> None:
    cube = cube_on_floor()
    select(cube)
    applied(shift(0.5, 0, -0.3), object_response="deform")
    assert evaluated(cube)[:, 2].min() == pytest.approx(0, abs=ROUNDING)


def test_a_chosen_minimum_distance_holds_beside_the_contact() -> None:
    cube = edited(cube_on_floor(), bottom)
    applied(shift(0.7, 0.3), separation=0.01)
    assert 0.01 < evaluated(cube)[:, 2].min() < 0.021


def test_a_frame_that_rounds_more_keeps_the_automatic_distance(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(touching_start, "KEPT", 1e-6)
    edited(cube_on_floor(), bottom)
    assert applied(shift(0.7, 0.3)).status == "corrected"


@pytest.mark.parametrize("depth", [1e-3, 1.0])
def test_what_cuts_deeper_is_refused_as_before(depth: float) -> None:
    cube = cube_on_floor()
    cube.location.z -= depth
    edited(cube, top)
    before = snapshot()
    with pytest.raises(stiv.StartIntersectsError, match="already intersects"):
        BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert snapshot() == before
