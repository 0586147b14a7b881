# SPDX-License-Identifier: GPL-3.0-or-later
"""Locked axes, uniform scales and pivots hold in the fields and matrices that Blender shows."""

from dataclasses import replace
from typing import Any

import bpy
import numpy as np
import pytest
from building import add_cube, add_grid, add_lattice, add_modifier, edit_mode, evaluated, select, shift, stretch, turn
from mathutils import Matrix

from stiv.blender import BlenderEdit, EditSettings, FreeDirections, Motion, check_scene
from stiv.blender.scene.arrays import Floats, as_matrix, transform_points

AXES = [(True, False, False), (False, True, False), (False, False, True), (True, True, False), (False, True, True)]


def begin(kind: str = "move", **settings: Any) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, EditSettings(**settings), kind)


def locked(matrix: Floats, chosen: Any, axes: Floats | None = None, pivot: Any = (0, 0, 0)) -> Motion:
    free = FreeDirections(np.eye(3) if axes is None else axes, np.array(chosen))
    return Motion(matrix, np.array(pivot, np.float64), free=free)


def hills(seed: int) -> Any:
    """Uneven ground that pushes in all directions."""
    ground = add_grid("Hills", 6, 6.0, (0, 0, -2.2))
    for vertex in ground.data.vertices:
        vertex.co.z = np.random.default_rng((seed, vertex.index)).uniform(-0.8, 0.8)
    return ground


def finish(edit: BlenderEdit, motion: Any) -> None:
    """A typed value, then a drag elsewhere and back; all of it is written and free of intersections."""
    edit.apply(motion)
    assert edit.write().passed
    edit.drag(replace(motion, matrix=np.eye(4)))
    edit.write()
    edit.drag(motion)
    edit.settle()
    assert edit.write().passed
    assert check_scene(bpy.context).pairs == ()


@pytest.mark.parametrize("response", ["slide", "slide_and_turn"])
@pytest.mark.parametrize("chosen", AXES)
@pytest.mark.parametrize("seed", range(2))
def test_an_object_keeps_its_locked_axes_to_the_last_bit(chosen: Any, seed: int, response: str) -> None:
    """X, typed 6, once ended at Y -0.36, Z 0.40."""
    random = np.random.default_rng(seed)
    hills(seed)
    cube = add_cube("Cube", seed * random.uniform(-0.3, 0.3, 3), rotation_euler=tuple(random.uniform(-3, 3, 3)))
    add_cube("Post", (3.5, 2.5, 0), 0.8)
    select(cube)
    start, rotation = np.array(cube.location), as_matrix(cube.matrix_world)[:3, :3].tobytes()
    goal = np.where(chosen, random.uniform(2, 6, 3) * [1, 1, -1], 0)
    edit = begin(object_response=response)
    finish(edit, locked(shift(*goal), chosen))
    moved = np.array(cube.matrix_world.translation) - start
    assert not moved[~np.array(chosen)].any()
    assert np.abs(moved).max() > 0.3
    assert as_matrix(cube.matrix_world)[:3, :3].tobytes() == rotation


def child_below_turned_parent(random: np.random.Generator) -> Any:
    """A cube with an arbitrary parent, inverse and delta; selected."""
    place = {"rotation_euler": tuple(random.uniform(-3, 3, 3)), "scale": tuple(random.uniform(0.5, 2, 3))}
    parent = add_cube("Parent", random.uniform(-3, 3, 3), 0.1, **place)
    cube = add_cube("Cube", random.uniform(-5, 5, 3), 0.3, rotation_euler=tuple(random.uniform(-3, 3, 3)))
    cube.parent, cube.matrix_parent_inverse = parent, Matrix.Rotation(random.uniform(-3, 3), 4, (1, 2, 3))
    cube.delta_location = random.uniform(-1, 1, 3)
    parent.location.z += 30
    select(cube)
    bpy.context.view_layer.update()
    return cube


def test_a_child_of_a_turned_parent_keeps_its_locked_axes() -> None:
    """To the last bit, unless Blender's single-precision matrices cannot represent that; then to the nearest one."""
    exact = 0
    for seed in range(12):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        random, chosen = np.random.default_rng(seed), np.array(AXES[seed % len(AXES)])
        cube = child_below_turned_parent(random)
        start, edit = np.array(cube.matrix_world.translation), begin()
        for _ in range(3):
            goal = np.where(chosen, random.uniform(-4, 4, 3), 0)
            edit.drag(locked(shift(*goal), chosen))
            assert edit.write().passed
            off = np.array(cube.matrix_world.translation) - start - goal
            assert np.abs(off[~chosen]).max() <= np.spacing(np.float32(32.0))
            assert np.abs(off[chosen]).max() < 2e-5
            exact += not off[~chosen].any()
    assert exact >= 30


def test_contact_may_leave_the_axis_if_the_user_lets_it() -> None:
    ball = add_cube("Cube", rotation_euler=(0.3, 0.5, 0.2))
    add_cube("Post", (4, 0.9, 0.3), 1.0, rotation_euler=(0.2, 0.4, 0.7))
    select(ball)
    edit = begin(slide_out_of_axis=True)
    edit.apply(locked(shift(6), AXES[0]))
    assert edit.write().passed
    assert abs(ball.location.y) > 0.01
    assert ball.location.x > 3


def test_a_locked_axis_stops_on_the_line_and_a_free_one_slides() -> None:
    cube = add_cube("Cube")
    wall = add_grid("Wall", 2, 20.0, (4, 0, 0), rotation_euler=(0, 1.1, 0))
    select(cube)
    ends = []
    for motion in (locked(shift(6), AXES[0]), Motion.of(shift(6))):
        edit = begin()
        edit.apply(motion)
        assert edit.write().passed
        ends.append(np.array(cube.location))
        edit.restore()
    assert ends[0][1] == ends[0][2] == 0
    assert 1 < ends[0][0] < 4
    assert np.linalg.norm(ends[1] - [6, 0, 0]) < np.linalg.norm(ends[0] - [6, 0, 0])
    assert wall.location.x == 4


@pytest.mark.parametrize("name", ["local", "view"])
def test_locks_in_other_orientations_hold_up_to_rounding(name: str) -> None:
    hills(1)
    cube = add_cube("Cube", rotation_euler=(0.4, 1.0, 0.2))
    axes = as_matrix(Matrix.Rotation(0.7, 3, (1, 2, 3)) if name == "view" else cube.matrix_world)[:3, :3]
    axes = np.linalg.qr(axes)[0]
    select(cube)
    for chosen in AXES:
        goal = axes @ np.where(chosen, (2, 3, -4), 0)
        edit = begin()
        edit.apply(locked(shift(*goal), chosen, axes))
        assert edit.write().passed
        along = axes.T @ np.array(cube.location)
        assert np.abs(along[~np.array(chosen)]).max() < 1e-6 < np.abs(along).max()
        edit.restore()


@pytest.mark.parametrize("chosen", AXES)
@pytest.mark.parametrize("kind", ["cage", "lattice", "subdivided"])
def test_points_keep_their_locked_axes_to_the_last_bit(kind: str, chosen: Any) -> None:
    hills(2)
    if kind == "lattice":
        ob = add_lattice("Lattice", (3, 3, 3), (0.1, 0.2, 0.3), scale=(2.1, 2.1, 2.1))
        add_modifier(add_cube("Cube", size=0.8), "LATTICE", object=ob)
    else:
        ob = add_grid("Sheet", 8, 1.5, (0.1, 0.2, 0.3))
        for vertex in ob.data.vertices:
            vertex.select = vertex.index % 3 > 0
        if kind == "subdivided":
            add_modifier(ob, "SUBSURF", levels=1, render_levels=1)

    def stored() -> Floats:
        bpy.ops.object.mode_set(mode="OBJECT")
        points = ob.data.points if kind == "lattice" else ob.data.vertices
        found = np.array([tuple(each.co_deform if kind == "lattice" else each.co) for each in points], np.float32)
        bpy.ops.object.mode_set(mode="EDIT")
        return found

    edit_mode(ob)
    if kind == "lattice":
        bpy.ops.lattice.select_all(action="SELECT")
    before = stored()
    goal = np.where(chosen, (1.5, 1.1, -2.5), 0)
    edit = begin()
    finish(edit, locked(shift(*goal), chosen))
    after = stored()
    assert (before == after)[:, ~np.array(chosen)].all()
    assert np.abs(after - before).max() > 0.3


@pytest.mark.parametrize("seed", range(4))
def test_a_uniform_scale_between_walls_stays_uniform(seed: int) -> None:
    """It once ended at (3.55, 6.88, 6.89)."""
    random = np.random.default_rng(seed)
    cube = add_cube("Cube", rotation_euler=tuple(random.uniform(-0.2, 0.2, 3)), scale=(1, 1, 1))
    for sign in (-1, 1):
        add_grid(f"Wall {sign}", 2, 12.0, (4 * sign, 0, 0), rotation_euler=(0.1, sign * 1.5, 0))
    add_grid("Floor", 2, 3.4, (0, 0, -2))
    select(cube)
    edit = begin("scale")
    finish(edit, Motion(stretch(7, (0.1, 0.2, 0)), np.array([0.1, 0.2, 0])))
    x, y, z = cube.scale
    assert x == y == z
    assert 2.2 < x < 7
    assert as_matrix(cube.matrix_world)[:3, :3] @ as_matrix(cube.matrix_world)[:3, :3].T == pytest.approx(
        x * x * np.eye(3), abs=1e-5
    )


def test_a_scale_along_chosen_axes_leaves_the_others() -> None:
    cube = add_cube("Cube")
    add_grid("Wall", 2, 9.0, (3, 0, 0), rotation_euler=(0, 1.5707963, 0))
    add_grid("Other wall", 2, 9.0, (-2, 0, 0), rotation_euler=(0, 1.5707963, 0))
    select(cube)
    edit = begin("scale")
    finish(edit, locked(np.diag([4.0, 3.0, 1.0, 1.0]), (True, True, False)))
    assert cube.scale.x == pytest.approx(2.5, abs=0.01)
    assert cube.scale.y == pytest.approx(3, abs=0.05)
    assert cube.scale.z == 1
    assert cube.location.z == 0


@pytest.mark.parametrize("individual", [False, True])
@pytest.mark.parametrize("response", ["slide", "slide_and_turn"])
@pytest.mark.parametrize("seed", range(3))
def test_a_rotation_keeps_its_pivot(seed: int, response: str, individual: bool) -> None:
    random = np.random.default_rng(seed)
    hills(seed)
    bar = add_cube("Bar", (0.2, 0.1, 0), scale=(1.6, 0.3, 0.3), rotation_euler=(0, 0, random.uniform(-0.3, 0.3)))
    pivot = np.array(bar.location) if individual else random.uniform(-0.5, 0.5, 3)
    select(bar)
    start = as_matrix(bar.matrix_world)
    matrix = turn(2.0, "Y", pivot)
    edit = begin("rotate", object_response=response)
    motion = Motion(matrix, np.zeros(3) + pivot, individual=individual)
    finish(edit, motion)
    done = as_matrix(bar.matrix_world) @ np.linalg.inv(start)
    assert transform_points(done, pivot[None])[0] == pytest.approx(pivot, abs=2e-6)
    angle = np.arccos(np.clip((np.trace(done[:3, :3]) - 1) / 2, -1, 1))
    assert angle > 0.2
    if response == "slide":
        assert angle < 2.0001
        assert done[:3, :3] @ [0, 1, 0] == pytest.approx([0, 1, 0], abs=2e-6)
    edit.restore()
    assert as_matrix(bar.matrix_world).tobytes() == start.tobytes()


def test_a_free_rotation_reaches_its_goal_and_the_same_drag_resumes() -> None:
    cube = add_cube("Cube", (2, 0, 0))
    select(cube)
    before = evaluated(cube)
    motion = Motion(turn(2.5, "Z", (1, 1, 0)), np.array([1.0, 1, 0]))
    edit = begin("rotate")
    assert edit.apply(motion).status == "reached"
    assert edit.write().passed
    assert evaluated(cube) == pytest.approx(transform_points(motion.matrix, before), abs=1e-5)
    accepted, placed = edit.controls, as_matrix(cube.matrix_world)
    edit.restore()
    again = begin("rotate")
    assert again.resume_from(accepted, motion)
    assert again.write().passed
    assert as_matrix(cube.matrix_world).tobytes() == placed.tobytes()


def test_a_rotation_that_is_cancelled_at_its_first_step_can_begin_again() -> None:
    cube = add_cube("Cube", (2, 0, 0))
    select(cube)
    edit, motion = begin("rotate"), Motion(turn(1.0, "Z"), np.zeros(3))
    steps = edit.drag_steps(motion)
    next(steps)  # opens the session about the pivot
    steps.close()
    assert edit.drag(motion).status == "reached"
    assert edit.write().passed
    assert tuple(cube.location) == pytest.approx((2 * np.cos(1), 2 * np.sin(1), 0), abs=1e-6)


def test_a_rotation_that_places_the_origin_moves_it_there_and_still_turns() -> None:
    """Face Project and Face Nearest put the origin onto a face, off the circle about the pivot."""
    cube = add_cube("Cube", (2, 0, 0))
    select(cube)
    start, place = as_matrix(cube.matrix_world), np.array([0.5, 1.5, 0.25])
    edit = begin("rotate")
    edit.drag(Motion(turn(0.5, "Z"), np.zeros(3), place=lambda points, moved: np.tile(place, (len(points), 1))))
    assert edit.write().passed
    assert tuple(cube.location) == pytest.approx(tuple(place), abs=1e-6)
    assert as_matrix(cube.matrix_world)[:3, :3] == pytest.approx((turn(0.5, "Z") @ start)[:3, :3], abs=1e-6)
    edit.drag(Motion(turn(0.5, "Z"), np.zeros(3)))  # without the face: about the pivot
    assert edit.write().passed
    assert tuple(cube.location) == pytest.approx((2 * np.cos(0.5), 2 * np.sin(0.5), 0), abs=1e-6)


def test_a_drag_among_distant_obstacles_rotates_about_its_pivot() -> None:
    """Larger boxes of obstacles open new edits, which resume about the same pivot."""
    bar = add_cube("Bar", (2, 0, 0), 0.3)
    for k in range(60):
        add_grid(f"Far {k}", 60, 0.5, (0, 6 + 2 * k, 0), rotation_euler=(1.2, 0, 0))
    select(bar)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "rotate")
    start = as_matrix(bar.matrix_world)
    for degrees in range(10, 130, 20):
        edit.drag(Motion(turn(np.radians(degrees), "Z"), np.zeros(3)))
        assert edit.write().passed
    done = as_matrix(bar.matrix_world) @ np.linalg.inv(start)
    assert done == pytest.approx(turn(np.radians(110), "Z"), abs=1e-5)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_axes_of_any_precision_become_orthonormal(dtype: Any) -> None:
    """An axis of Blender's own floats once made a rotation end with "weight axes must be orthonormal columns"."""
    random = np.random.default_rng(3)
    for count in [1, 2, 3] * 20:
        axes = FreeDirections.of_normals(random.normal(size=(count, 3)).astype(dtype)).axes
        assert np.abs(axes.T @ axes - np.eye(3)).max() < 1e-14
