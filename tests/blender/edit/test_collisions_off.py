# SPDX-License-Identifier: GPL-3.0-or-later
"""Collisions off and on again within an edit."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import (
    add_cube,
    add_grid,
    add_lattice,
    add_modifier,
    edit_mode,
    evaluated,
    moved,
    select,
    shift,
    snapshot,
)

import stiv
from stiv.blender import BlenderEdit, EditSettings, check_scene


def cube_before_wall() -> Any:
    add_grid("Wall", 2, 3.0, (2.0, 0, 0), rotation_euler=(0, np.pi / 2, 0))
    cube = add_cube("Cube")
    select(cube)
    return cube


def begin(**settings: Any) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, EditSettings(**settings), "move")


@pytest.mark.parametrize("response", ["rigid", "deform"])
def test_off_passes_through_and_on_continues_from_the_other_side(response: str) -> None:
    cube = cube_before_wall()
    start, before = snapshot(), evaluated(cube)
    edit = begin(object_response=response)
    edit.drag(shift(0.5))
    assert edit.write().passed
    assert edit.interference
    assert edit.set_interference(False) == ""
    assert not edit.interference
    for x in (2.0, 4.0):
        assert edit.drag(shift(x)).status == "unguarded"
        assert edit.write().passed
        assert evaluated(cube) == pytest.approx(moved(shift(x), before), abs=1e-6)
        assert (check_scene(bpy.context).pairs == ()) == (x == 4.0)
    assert edit.set_interference(True) == ""
    assert edit.drag(shift(4.5)).status == "reached"
    assert edit.drag(shift(0.0)).status != "reached"
    assert edit.write().passed
    assert evaluated(cube)[:, 0].min() > 2.0
    assert check_scene(bpy.context).pairs == ()
    edit.restore()
    assert snapshot() == start


@pytest.mark.parametrize("response", ["rigid", "deform"])
def test_on_inside_the_wall_returns_to_the_last_accepted_state(response: str) -> None:
    cube = cube_before_wall()
    edit = begin(object_response=response)
    edit.drag(shift(0.5))
    assert edit.write().passed
    free = evaluated(cube)
    edit.set_interference(False)
    edit.drag(shift(2.2))
    edit.write()
    message = edit.set_interference(True)
    assert edit.interference
    assert message == "back to the last state without intersections: Cube, Wall intersect here"
    assert edit.write().passed
    assert (evaluated(cube) == free).all()
    edit.drag(shift(2.2))
    assert edit.write().passed
    assert 1.9 < evaluated(cube)[:, 0].max() < 2.0
    assert check_scene(bpy.context).pairs == ()


def test_off_from_the_start_accepts_a_start_that_intersects() -> None:
    cube = cube_before_wall()
    cube.location.x = 1.5
    select(cube)
    start = snapshot()
    with pytest.raises(stiv.StartIntersectsError):
        begin()
    edit = begin(interference=False)
    assert snapshot() == start
    edit.apply(shift(0.2))
    assert edit.write().passed
    message = edit.set_interference(True)
    assert not edit.interference
    assert message == "collisions stay off: Cube, Wall intersect here"
    edit.drag(shift(-1.0))
    edit.write()
    assert edit.set_interference(True) == ""
    assert edit.drag(shift(1.0)).status != "reached"
    assert edit.write().passed
    assert check_scene(bpy.context).pairs == ()
    edit.restore()
    assert snapshot() == start


def test_a_start_that_intersects_elsewhere_than_at_a_bent_quad_is_refused() -> None:
    """The search for bent quads once never ended."""
    cube = cube_before_wall()
    cube.location.x = 1.5
    cube.data.vertices[0].co.z += 1.5
    select(cube)
    add_cube("In the way", (1.5, 0, 0), 0.3)
    bpy.data.objects["In the way"].location.x = 2.0
    with pytest.raises(stiv.StartIntersectsError):
        begin(object_response="deform")


def test_restoring_with_collisions_off_is_exact() -> None:
    ball, lattice = add_cube("Ball"), add_lattice("Cage", (3, 3, 3), scale=(3.1, 3, 3), rotation_euler=(0.1, 0.2, 0))
    add_modifier(ball, "LATTICE", object=lattice)
    add_grid("Floor", 2, 3.0, (0, 0, -2))
    edit_mode(lattice)
    bpy.ops.lattice.select_all(action="SELECT")
    start = snapshot()
    edit = begin(interference=False)
    edit.drag(shift(z=-1.3))
    edit.write()
    assert check_scene(bpy.context).pairs != ()
    assert edit.surface[edit.assembly.vertices(0)] == pytest.approx(evaluated(ball), abs=1e-5)
    edit.drag(shift())
    edit.write()
    assert snapshot() == start
    edit.drag(shift(z=-1.3))
    edit.write()
    edit.restore()
    assert snapshot() == start
