# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigid and scaled placements, written through parents, deltas and rotation modes, against Blender's evaluation."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import (
    add,
    add_cube,
    add_grid,
    add_lattice,
    add_modifier,
    evaluated,
    mesh,
    moved,
    select,
    shift,
    snapshot,
    stretch,
    turn,
)
from mathutils import Matrix

from stiv import InputError
from stiv.blender import BlenderEdit, EditSettings

TURN = turn(0.9, "X", (1, 2, 3)) @ turn(0.4, "Z") @ shift(0.3, -0.2, 0.1)


def edited(matrix: np.ndarray, kind: str, *objects: Any) -> BlenderEdit:
    """The goal reached and written, restored exactly, reached and written again."""
    select(*objects)
    before = snapshot()
    edit = BlenderEdit.begin(bpy.context, EditSettings(), kind)
    assert edit.drag(matrix).status == "reached"
    assert edit.write().passed
    edit.restore()
    assert snapshot() == before
    assert edit.drag(matrix).status == "reached"
    assert edit.write().passed
    return edit


def moves(matrix: np.ndarray, kind: str, *objects: Any) -> None:
    """The evaluation afterwards equals the start, moved."""
    bpy.context.view_layer.update()
    before = [evaluated(ob) for ob in objects]
    edited(matrix, kind, *objects)
    for ob, start in zip(objects, before, strict=True):
        assert evaluated(ob) == pytest.approx(moved(matrix, start), abs=1e-5)


@pytest.mark.parametrize("mode", ["QUATERNION", "AXIS_ANGLE", "XYZ", "ZYX", "YXZ"])
def test_rotation_modes_and_deltas(mode: str) -> None:
    cube = add_cube("Cube", (1, 0, 0), scale=(1, 2, -0.5), delta_location=(0.2, 0.1, 0), delta_scale=(1, 1.5, 1))
    cube.rotation_mode = mode
    cube.rotation_euler, cube.rotation_quaternion = (0.4, 0.5, 0.6), (0.8, 0.1, 0.2, -0.4)
    cube.rotation_axis_angle = (0.7, 0.6, 0, 0.8)
    cube.delta_rotation_euler, cube.delta_rotation_quaternion = (0.1, 0.2, 0.3), (0.9, 0.1, 0.3, 0.1)
    moves(TURN, "rotate", cube)
    moves(shift(1, 2, 3), "move", cube)
    moves(stretch(1.5, (1, 2, 3)), "scale", cube)


def test_below_a_parent_with_inverse_and_mirror() -> None:
    parent = add("Parent", None, (3, 2, 1), rotation_euler=(0.3, 0.4, 0.5), scale=(-2, -2, -2))
    child = add_cube("Child", (1, 0, 0), parent=parent, rotation_euler=(0.2, 0, 0.4), scale=(1, 2, 0.4))
    child.matrix_parent_inverse = Matrix.Translation((1, 2, 3)) @ Matrix.Rotation(0.3, 4, "X")
    moves(TURN, "rotate", child)
    moves(stretch(0.5, (0, 0, 1)), "scale", child)


def test_below_a_bone() -> None:
    armature = bpy.data.armatures.new("Armature")
    holder = add("Armature", armature, (1, 1, 1), rotation_euler=(0.5, 0, 0))
    select(holder)
    bpy.ops.object.mode_set(mode="EDIT")
    bone = armature.edit_bones.new("Bone")
    bone.tail = (0, 1, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    child = add_cube("Child", parent=holder, parent_type="BONE", parent_bone="Bone")
    moves(TURN, "rotate", child)


def test_below_an_uneven_parent_only_moves() -> None:
    parent = add("Parent", None, scale=(1, 3, 1))
    child = add_cube("Child", (5, 0, 0), parent=parent, rotation_euler=(0.5, 0.2, 0.1))
    add_grid("Wall", 2, 20.0, location=(0, 0, -8), rotation_euler=(0.3, 0, 0))
    moves(shift(1, 2, 3), "move", child)
    rotation = tuple(child.rotation_euler)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert edit.apply(shift(z=-14)).status in ("corrected", "blocked")
    assert edit.write().passed
    assert tuple(child.rotation_euler) == rotation


def test_children_move_along_and_are_not_tested_against_their_parent() -> None:
    parent = add_cube("Parent")
    child = add_cube("Child", (0.5, 0.5, 0.5), parent=parent)
    grandchild = add_cube("Grandchild", (0.2, 0, 0), parent=child)
    add_cube("Outside", (9, 0, 0))
    starts = [evaluated(ob) for ob in (parent, child, grandchild)]
    edit = edited(TURN, "rotate", parent, child)
    assert {each.role for each in edit.summary.participants if each.name != "Outside"} == {"rigid"}
    assert edit.summary.controls == 2
    for ob, start in zip((parent, child, grandchild), starts, strict=True):
        assert evaluated(ob) == pytest.approx(moved(TURN, start), abs=1e-5)
    assert tuple(child.location) == (0.5, 0.5, 0.5)


def test_an_empty_carries_its_children() -> None:
    empty = add("Empty", None, (1, 1, 1))
    child = add_cube("Child", parent=empty)
    start = evaluated(child)
    edited(TURN, "rotate", empty)
    assert evaluated(child) == pytest.approx(moved(TURN, start), abs=1e-5)


def test_an_instancer_carries_its_instances() -> None:
    collection = bpy.data.collections.new("Inner")
    collection.objects.link(
        bpy.data.objects.new("Inner", mesh("Inner", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]))
    )
    empty = add("Instancer", None, (1, 0, 0), instance_type="COLLECTION", instance_collection=collection)
    edit = edited(TURN, "rotate", empty)
    assert edit.surface == pytest.approx(moved(TURN, np.array([[1.0, 0, 0], [2, 0, 0], [1, 1, 0]])), abs=1e-6)


def test_a_mesh_and_its_lattice_move_together() -> None:
    cube, lattice = add_cube("Cube"), add_lattice("Lattice", (2, 2, 2), (0.1, 0, 0), scale=(3, 3, 3))
    lattice.data.points[0].co_deform.x -= 0.3
    add_modifier(cube, "LATTICE", object=lattice)
    start = evaluated(cube)
    edit = edited(TURN, "rotate", cube, lattice)
    assert edit.summary.controls == 2
    assert evaluated(cube) == pytest.approx(moved(TURN, start), abs=1e-5)


def test_several_selected_objects_are_separate_bodies() -> None:
    """Two separate bodies, one goal: each turns about the common pivot."""
    moves(TURN, "rotate", add_cube("One"), add_cube("Two", (4, 0, 0)))


def test_rigid_objects_may_have_any_modifier() -> None:
    cube = add_cube("Cube")
    add_modifier(cube, "SOLIDIFY")
    add_modifier(cube, "BEVEL")
    moves(TURN, "rotate", cube)


def test_more_than_a_turn() -> None:
    cube = add_cube("Cube")
    select(cube)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "rotate")
    for degrees in range(10, 500, 10):
        assert edit.drag(turn(np.radians(degrees), "Z", (5, 0, 0))).status == "reached"
    assert edit.controls[1] == pytest.approx([0, 0, np.radians(490)])
    assert edit.write().passed
    assert cube.rotation_euler.z == pytest.approx(np.radians(490), abs=1e-5) or np.cos(cube.rotation_euler.z) == (
        pytest.approx(np.cos(np.radians(490)), abs=1e-5)
    )


def test_an_object_at_a_wall_changes_only_along_its_motion() -> None:
    """A solve leaves turns and shifts of 1e-8, which Blender's fields would show as -0."""
    cube = add_cube("Cube")
    add_grid("Wall", 2, 3.0, location=(2, 0, 0), rotation_euler=(0, np.pi / 2, 0))
    select(cube)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.apply(shift(1.5, 0, 0))
    assert edit.write().passed
    assert 0.9 < cube.location.x < 1.0
    assert tuple(cube.location[1:]) == (0.0, 0.0) and tuple(cube.rotation_euler) == (0.0, 0.0, 0.0)


def test_scaling_along_an_objects_own_axes() -> None:
    cube = add_cube("Cube", (1, 2, 3), rotation_euler=(0, 0, np.pi / 4))
    frame = turn(np.pi / 4, "Z")
    goal = shift(1, 2, 3) @ frame @ stretch((2, 1, 0.5)) @ frame.T @ shift(-1, -2, -3)
    moves(goal, "scale", cube)
    assert tuple(cube.scale) == pytest.approx((2, 1, 0.5), abs=1e-6)


def test_growing_stops_at_a_wall() -> None:
    cube = add_cube("Cube")
    for x in (-2, 2):
        add_grid(f"Wall {x}", 2, 3.0, location=(x, 0, 0), rotation_euler=(0, np.pi / 2, 0))
    select(cube)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "scale")
    edit.apply(stretch(3.0))
    assert edit.write().passed
    assert 1.8 < np.abs(evaluated(cube)[:, 0]).max() < 2


@pytest.mark.parametrize("factors", [(0.0, 0.0, 0.0), (1.0, 0.0, 2.0)])
def test_scale_zero_is_refused(factors: tuple[float, float, float]) -> None:
    """Rigid objects are not tested against themselves: with a scale of 0 all faces once intersected."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_cube_add()
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "scale")
    with pytest.raises(InputError, match="flat"):
        edit.drag(np.diag([*factors, 1.0]))
    edit.apply(np.diag([-2.0, -2.0, -2.0, 1.0]))  # its way leads through 0
    assert edit.write().passed
    assert tuple(round(value, 5) for value in bpy.context.object.scale) == (-2.0, -2.0, -2.0)
