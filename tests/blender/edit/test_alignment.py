# SPDX-License-Identifier: GPL-3.0-or-later
"""Align Rotation to Target: objects turn their Z axis onto the normal of a target, and stop at the separation."""

import bpy
import numpy as np
import pytest
from building import add_cube, add_grid, select, shift
from mathutils import Matrix, Vector

from stiv.blender import Alignment, BlenderEdit, EditSettings, FreeDirections, Motion, check_scene

SLOPE = Vector((0.3, -0.5, 0.8)).normalized()
TARGET = Vector((1.0, 0.5, 0.2))  # on the slope


def tilted_cube() -> bpy.types.Object:
    """A cube above a slope through TARGET; selected."""
    slope = add_grid("Slope", 4, 6.0, TARGET)
    slope.rotation_euler = SLOPE.to_track_quat("Z", "Y").to_euler()
    cube = add_cube("Cube", (-1.0, -0.5, 4.0), 0.5, rotation_euler=(0.4, -0.7, 1.1))
    select(cube)
    bpy.context.view_layer.update()
    return cube


def snapped(cube: bpy.types.Object, source: Vector) -> Motion:
    """The motion that takes a point of the cube onto the target."""
    align = Alignment(np.array(SLOPE), np.array(source))
    return Motion(shift(*(TARGET - source)), np.array(cube.location), align=align)


def expected(cube: bpy.types.Object, source: Vector) -> Matrix:
    """The same by Blender's own rotations."""
    turn = cube.matrix_world.col[2].to_3d().normalized().rotation_difference(SLOPE).to_matrix().to_4x4()
    about = Matrix.Translation(source) @ turn @ Matrix.Translation(-source)
    return Matrix.Translation(TARGET - source) @ about @ cube.matrix_world


@pytest.mark.parametrize("response", ["slide", "slide_and_turn"])
def test_an_object_turns_onto_the_normal_and_stops_at_the_separation(response: str) -> None:
    cube = tilted_cube()
    lowest = cube.matrix_world @ Vector((0.0, 0.0, -0.5))  # the middle of its lower face
    free = expected(cube, lowest)
    edit = BlenderEdit.begin(bpy.context, EditSettings(separation=0.05, object_response=response), "move")
    for _ in range(3):
        edit.drag(snapped(cube, lowest))
    edit.settle()
    assert edit.write().passed
    away = cube.matrix_world.translation - free.translation
    assert away.normalized().dot(SLOPE) > 0.999 and 0.0499 < away.length < 0.11
    np.testing.assert_allclose(np.array(cube.matrix_world)[:3, :3], np.array(free)[:3, :3], atol=1e-3)
    assert check_scene(bpy.context).pairs == ()


def test_without_collisions_the_object_ends_as_blender_turns_it() -> None:
    cube = tilted_cube()
    corner = cube.matrix_world @ Vector((0.5, 0.5, -0.5))
    goal = expected(cube, corner)
    edit = BlenderEdit.begin(bpy.context, EditSettings(interference=False), "move")
    edit.drag(snapped(cube, corner))
    edit.write()
    np.testing.assert_allclose(np.array(cube.matrix_world), np.array(goal), atol=2e-6)
    edit.drag(Motion(shift(0, 0, 1), np.zeros(3)))  # the pointer has left the target
    edit.write()
    assert cube.rotation_euler == tilted_start(edit)


def tilted_start(edit: BlenderEdit) -> object:
    """The rotation before the edit."""
    edit.restore()
    return bpy.data.objects["Cube"].rotation_euler


def test_a_lock_holds_for_the_origin_and_locked_rotation_turns_nothing() -> None:
    cube = tilted_cube()
    start = np.array(cube.location)
    top = cube.matrix_world @ Vector((0.0, 0.0, 0.5))
    motion = snapped(cube, top)
    along_x = FreeDirections(np.eye(3), np.array([True, False, False]))
    edit = BlenderEdit.begin(bpy.context, EditSettings(interference=False), "move")
    edit.drag(Motion(motion.matrix, motion.pivot, free=along_x, align=motion.align))
    edit.write()
    assert cube.matrix_world.col[2].to_3d().normalized().dot(SLOPE) == pytest.approx(1.0)
    np.testing.assert_allclose(np.array(cube.location)[1:], start[1:], atol=1e-6)
    edit.restore()
    cube.lock_rotation[1] = True
    edit = BlenderEdit.begin(bpy.context, EditSettings(interference=False), "move")
    edit.drag(motion)
    edit.write()
    np.testing.assert_allclose(cube.rotation_euler, (0.4, -0.7, 1.1), atol=1e-6)


@pytest.mark.parametrize("target", ["normal", "face"])
def test_an_object_that_deforms_turns_and_follows_its_origin_as_a_whole(target: str) -> None:
    cube = tilted_cube()
    corner = cube.matrix_world @ Vector((0.5, 0.5, -0.5))
    before, motion = np.array(cube.matrix_world), snapped(cube, corner)
    goal = np.array(expected(cube, corner))
    if target == "face":
        motion = Motion(shift(1, 0, 0), np.zeros(3), place=lambda points, moved: moved - [0, 0, 0.25])
        goal = shift(1, 0, -0.25) @ before
    local = np.array([vertex.co for vertex in cube.data.vertices])
    edit = BlenderEdit.begin(bpy.context, EditSettings(interference=False, object_response="deform"), "move")
    edit.drag(motion)
    edit.write()
    shown = np.array([cube.matrix_world @ vertex.co for vertex in cube.data.vertices])
    np.testing.assert_allclose(shown, local @ goal[:3, :3].T + goal[:3, 3], atol=2e-6)
    assert np.array_equal(np.array(cube.matrix_world), before)
