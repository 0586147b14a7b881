# SPDX-License-Identifier: GPL-3.0-or-later
"""How rigid objects respond: they slide, and rotate only if the user lets them."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, evaluated, mesh, select, shift, turn

import stiv
from stiv.blender import BlenderEdit, EditSettings
from stiv.blender.scene.arrays import as_matrix


def begin(kind: str = "move", **settings: Any) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, EditSettings(**settings), kind)


def random_figure(name: str, seed: int, location: Any = (0, 0, 0)) -> Any:
    """An uneven tetrahedron, which any contact turns if it may turn."""
    random = np.random.default_rng(seed)
    corners = np.array([(1, 1, 1), (-1, -1, 1), (-1, 1, -1), (1, -1, -1)]) * random.uniform(0.4, 1.0, (4, 3))
    data = mesh(name, corners, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    return add(name, data, location, rotation_euler=tuple(random.uniform(-3, 3, 3)))


def rotation_bits(ob: Any) -> tuple[bytes, bytes]:
    return np.array(ob.rotation_euler).tobytes(), as_matrix(ob.matrix_world)[:3, :3].tobytes()


def are_apart(*objects: Any) -> bool:
    """An exact test of the visible objects."""
    q, triangles, count = [], [], 0
    for ob in objects:
        ob.data.calc_loop_triangles()
        q.append(evaluated(ob))
        triangles += [[count + v for v in each.vertices] for each in ob.data.loop_triangles]
        count += len(q[-1])
    return len(stiv.find_intersections(np.concatenate(q), np.array(triangles))) == 0


@pytest.mark.parametrize("seed", range(6))
def test_a_move_into_an_inclined_wall_slides_and_never_turns(seed: int) -> None:
    """It once ended turned by up to 90 degrees."""
    random = np.random.default_rng(seed)
    figure = random_figure("Figure", seed)
    wall = add_grid("Wall", 2, 20.0, (2.5, 0, 0), rotation_euler=(0, random.uniform(0.5, 1.2), random.uniform(-1, 1)))
    normal = as_matrix(wall.matrix_world)[:3, 2]
    goal = np.array([4.0, 0, 0])
    select(figure)
    before = rotation_bits(figure)
    edit = begin()
    edit.apply(shift(*goal))
    assert edit.write().passed
    assert edit.turned == 0
    assert rotation_bits(figure) == before
    assert are_apart(figure, wall)
    along = goal - normal * (normal @ goal)  # on a plane, the nearest place to the goal slides by all of this
    moved = np.array(figure.location)
    assert moved @ along == pytest.approx(along @ along, rel=0.02)


def test_slide_and_turn_turns() -> None:
    figure, wall = random_figure("Figure", 1), add_grid("Wall", 2, 20.0, (2.5, 0, 0), rotation_euler=(0, 1.2, 0))
    before = rotation_bits(figure)
    select(figure)
    edit = begin(object_response="slide_and_turn")
    edit.apply(shift(4))
    assert edit.write().passed
    assert rotation_bits(figure) != before
    start = np.frombuffer(before[1]).reshape(3, 3)
    angle = np.arccos((np.trace(start.T @ as_matrix(figure.matrix_world)[:3, :3]) - 1) / 2)
    assert edit.turned == pytest.approx(angle, abs=1e-3)
    assert are_apart(figure, wall)


@pytest.mark.parametrize("responders", ["unselected", "all"])
@pytest.mark.parametrize("kind", ["move", "rotate", "scale"])
def test_what_is_pushed_aside_slides(kind: str, responders: str) -> None:
    pusher, figure = add_cube("Pusher"), random_figure("Figure", 3, (1.8, 0.6, 0.2))
    before, place = rotation_bits(figure), tuple(figure.location)
    select(pusher)
    goal = {"move": shift(1.5), "rotate": turn(0.8, "Z"), "scale": np.diag([2.0, 2.0, 2.0, 1.0])}[kind]
    edit = begin(kind, responders=responders)
    edit.apply(goal)
    assert edit.write().passed
    assert rotation_bits(figure) == before
    assert tuple(figure.location) != place
    assert are_apart(pusher, figure)


def test_deform_dents_the_selected_mesh_and_slides_the_rest() -> None:
    cube, figure = add_cube("Cube"), random_figure("Figure", 3, (1.8, 0.6, 0.2))
    before = rotation_bits(figure)
    select(cube)
    edit = begin(object_response="deform", responders="all")
    edit.apply(shift(1.5))
    assert edit.write().passed
    assert np.ptp(evaluated(cube), axis=0) != pytest.approx([2, 2, 2], abs=1e-4)
    assert rotation_bits(figure) == before


def test_the_value_of_the_first_version_still_turns() -> None:
    assert EditSettings(object_response="rigid") == EditSettings(object_response="slide_and_turn")
