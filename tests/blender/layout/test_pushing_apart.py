# SPDX-License-Identifier: GPL-3.0-or-later
"""Push Apart: against the closed form of two boxes, and the exact test of random piles."""

import bpy
import numpy as np
import pytest
from building import add_cube, add_grid, add_modifier, select
from hypothesis import given, settings
from hypothesis import strategies as st

import stiv
from stiv.blender import EditSettings, check_scene, nearest_pair, push_apart

H = 0.01
EDIT = EditSettings(separation=H)


@given(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5), st.floats(-1.5, 1.5))
@settings(max_examples=15, deadline=None)
def test_two_cubes_part_along_the_axis_of_least_depth(x: float, y: float, z: float) -> None:
    for ob in list(bpy.data.objects):
        bpy.data.objects.remove(ob)
    first, second = add_cube("A"), add_cube("B", (x, y, z))
    select(first, second)
    report = push_apart(bpy.context, EDIT)
    depth = 2 + H - np.abs((x, y, z)).max()  # of two axis-aligned cubes of edge 2
    moved = np.linalg.norm(first.location) + np.linalg.norm(np.array(second.location) - (x, y, z))
    assert report.changed == ("A", "B") and moved == pytest.approx(depth, rel=1e-3)
    assert np.allclose(np.linalg.norm(first.location), depth / 2, rtol=1e-3)
    bpy.context.view_layer.update()
    assert nearest_pair(bpy.context).distance >= H * (1 - 1e-4)


@pytest.mark.shared
@pytest.mark.parametrize("seed", range(2))
def test_a_random_pile_comes_apart(seed: int) -> None:
    rng = np.random.default_rng(seed)
    add_grid("Floor", 2, 6.0)
    cubes = [
        add_cube(f"Cube {k}", rng.uniform(-1.2, 1.2, 3), 0.7, rotation_euler=rng.uniform(-3, 3, 3)) for k in range(6)
    ]
    select(*cubes)
    assert check_scene(bpy.context).pairs
    report = push_apart(bpy.context, EDIT)
    assert report.status == "done" and not check_scene(bpy.context).pairs
    assert nearest_pair(bpy.context).distance >= H * (1 - 1e-4)


def test_only_selected_objects_move_and_a_locked_axis_holds() -> None:
    add_cube("Fixed")
    cube = add_cube("Cube", (0.2, 0, 1.5), lock_location=(False, False, True))
    select(cube)
    push_apart(bpy.context, EDIT)
    assert tuple(bpy.data.objects["Fixed"].location) == (0, 0, 0)
    assert cube.location.z == 1.5 and cube.location.x == pytest.approx(2 + H, rel=1e-3)
    cube.lock_location, cube.location = (True, True, False), (0.2, 0, 1.5)
    push_apart(bpy.context, EDIT)
    assert cube.location.z == pytest.approx(2 + H, rel=1e-3) and cube.location.x == pytest.approx(0.2)


def test_what_is_inside_a_closed_room_stays_inside() -> None:
    add_cube("Room", size=4.0)
    table = add_cube("Table", (0, 0, -3.01))
    select(table)
    push_apart(bpy.context, EDIT)
    assert table.location.z == pytest.approx(-3 + H, abs=1e-4)


def test_a_cube_whose_topology_changes_on_the_way_is_named() -> None:
    cutter, cut, other = add_cube("Cutter", (0.9, 0.9, 0.9)), add_cube("Cut"), add_cube("Other", (-1.5, -0.2, -0.1))
    add_modifier(cut, "BOOLEAN", object=cutter, operation="DIFFERENCE")
    cutter.hide_set(True)
    other.lock_location = (True, True, True)
    for ob in (cut, other):
        ob.rotation_euler = (0.2, 0.3, 0.1)
    select(cut)
    with pytest.raises(stiv.InputError, match="Cut: its shape changes as it moves; use Collision Move"):
        push_apart(bpy.context, EditSettings(separation=2.5))
    assert tuple(cut.location) == (0, 0, 0)


def test_apart_already() -> None:
    select(add_cube("A"), add_cube("B", (3, 0, 0)))
    assert push_apart(bpy.context, EDIT).status == "unchanged"
