# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects without a surface of their own that move others: hooks, lattices, targets of constraints and drivers."""

from collections.abc import Callable
from typing import Any

import bpy
import mathutils
import numpy as np
import pytest
from building import (
    add,
    add_cube,
    add_grid,
    add_lattice,
    add_modifier,
    evaluated,
    select,
    shift,
    snapshot,
    stretch,
    turn,
)

from stiv import InputError
from stiv.blender import BlenderEdit, EditSettings, Motion, check_scene, guard_result
from stiv.blender.guard.accepted_scene import AcceptedScene
from stiv.blender.guard.known_intersections import find_intersections


def cube() -> Any:
    """A cube of edge 2 whose lowest point is 1 above a floor at z = 0."""
    add_grid("Floor", 8, 8.0)
    return add_cube("Cube", (0, 0, 2))


def hooked(name: str, vertices: Any, target: Any, location: Any, **properties: Any) -> Any:
    """An empty that hooks vertices of a cube, as Blender's own Hook to New Object does."""
    empty = add(name, None, location, **properties)
    bpy.context.view_layer.update()
    hook = add_modifier(target, "HOOK", name, object=empty)
    hook.vertex_indices_set(vertices)
    hook.matrix_inverse = empty.matrix_world.inverted() @ target.matrix_world
    return empty


def below_hook() -> tuple[Any, Any]:
    target = cube()
    return hooked("Hook", (0, 2, 4, 6), target, (0, 0, 1)), target


def below_parent_of_hook() -> tuple[Any, Any]:
    """The hook is an empty that another one carries."""
    empty, target = below_hook()
    above = add("Above", None, (3, 0, 1))
    bpy.context.view_layer.update()
    empty.parent = above
    empty.matrix_parent_inverse = above.matrix_world.inverted()
    return above, target


def below_lattice() -> tuple[Any, Any]:
    target, lattice = cube(), add_lattice("Lattice", (2, 2, 2), (0, 0, 2), scale=(3, 3, 3))
    add_modifier(target, "LATTICE", object=lattice)
    for point in list(lattice.data.points)[:4]:
        point.co_deform.z -= 0.38
    return lattice, target


def below_mirror() -> tuple[Any, Any]:
    target, middle = cube(), add("Mirror", None, (0, 0, 4))
    add_modifier(target, "MIRROR", mirror_object=middle, use_axis=(False, False, True))
    return middle, target


def below_constraint() -> tuple[Any, Any]:
    target, other = cube(), add("Target", None, (4, 0, 2))
    constraint = target.constraints.new("COPY_LOCATION")
    constraint.target, constraint.use_offset, constraint.use_x = other, True, False
    target.location = (0, 0, 0)
    return other, target


def below_driver() -> tuple[Any, Any]:
    target, other = cube(), add("Source", None, (4, 0, 2))
    driver = target.driver_add("location", 2).driver
    variable = driver.variables.new()
    variable.type, driver.expression = "TRANSFORMS", variable.name
    variable.targets[0].id, variable.targets[0].transform_type = other, "LOC_Z"
    return other, target


def below_armature() -> tuple[Any, Any]:
    """A rig that is not the parent of its mesh, moved in Object Mode."""
    target = cube()
    rig = add("Rig", bpy.data.armatures.new("Rig"), (0, 0, 2))
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bone = rig.data.edit_bones.new("Bone")
    bone.tail = (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    target.vertex_groups.new(name="Bone").add(range(8), 1.0, "REPLACE")
    add_modifier(target, "ARMATURE", object=rig)
    rig.pose.bones["Bone"].rotation_mode, rig.pose.bones["Bone"].rotation_euler = "XYZ", (0.5, 0, 0)
    return rig, target


SCENES = [
    below_hook, below_parent_of_hook, below_lattice, below_mirror, below_constraint, below_driver, below_armature,
]  # fmt: skip
GOALS = {below_mirror: shift(z=2.5), below_lattice: shift(z=2.5), below_armature: shift(y=2.5)}  # of others: down
Make = Callable[[], tuple[Any, Any]]


def lowest(ob: Any) -> float:
    return float(evaluated(ob)[:, 2].min())


def moved_by_blender(mover: Any, target: Any, matrix: np.ndarray) -> np.ndarray:
    """The surface that Blender shows once the mover itself has moved; the mover returns."""
    before = mover.matrix_world.copy()
    mover.matrix_world = mathutils.Matrix((matrix @ np.array(before)).tolist())
    shown = evaluated(target)
    mover.matrix_world = before
    bpy.context.view_layer.update()
    return shown


@pytest.mark.parametrize("make", SCENES)
@pytest.mark.parametrize("kind", ["move", "rotate", "scale"])
def test_followers_move_as_in_blender_where_they_are_free(make: Make, kind: str) -> None:
    mover, target = make()
    select(mover)
    place = tuple(mover.matrix_world.translation)
    matrices = {"move": shift(0.2, 0.1, 0.3), "rotate": turn(0.2, "Z", place), "scale": stretch(1.1, place)}
    shown = moved_by_blender(mover, target, matrices[kind])
    start = snapshot()
    edit = BlenderEdit.begin(bpy.context, EditSettings(), kind)
    assert edit.apply(matrices[kind]).status == "reached" and edit.write().passed
    np.testing.assert_allclose(evaluated(target), shown, atol=2e-5)
    edit.restore()
    assert snapshot() == start


@pytest.mark.parametrize("make", SCENES)
def test_followers_stop_at_an_obstacle(make: Make) -> None:
    mover, target = make()
    select(mover)
    goal = GOALS.get(make, shift(z=-2.5))
    if make is below_mirror:
        bpy.data.objects["Floor"].location.z = 8
    before = tuple(mover.location)
    free = moved_by_blender(mover, target, goal)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.apply(goal)
    assert edit.write().passed and check_scene(bpy.context).pairs == ()
    gap = 8 - evaluated(target)[:, 2].max() if make is below_mirror else lowest(target)
    assert 0 < gap < 0.02 and free[:, 2].min() * (8 - free[:, 2].max()) < 0
    assert tuple(mover.location) != before


def test_two_hooks_of_one_mesh_move_together() -> None:
    target = cube()
    hooks = [hooked(f"Hook {n}", chosen, target, (0, y, 1)) for n, chosen, y in ((1, (0, 4), -1), (2, (2, 6), 1))]
    select(*hooks)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.apply(shift(z=-3))
    assert edit.write().passed and 0 < lowest(target) < 0.02
    assert hooks[0].location.z == pytest.approx(hooks[1].location.z) and hooks[0].location.z < 0.05
    np.testing.assert_allclose(evaluated(target)[[1, 3, 5, 7], 2], 3, atol=1e-6)


@pytest.mark.parametrize("kind", ["rotate", "scale"])
def test_hooks_turn_and_scale_about_their_own_origins(kind: str) -> None:
    target = cube()
    hooks = [hooked(f"Hook {n}", chosen, target, (0, y, 1)) for n, chosen, y in ((1, (0, 4), -1), (2, (2, 6), 1))]
    matrix = turn(0.4, "X") if kind == "rotate" else stretch((0.5, 1, 1))
    motion = Motion(matrix, np.zeros(3), individual=True)
    select(*hooks)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), kind)
    places = [tuple(hook.location) for hook in hooks]
    assert edit.apply(motion).status == "reached" and edit.write().passed
    assert [tuple(hook.location) for hook in hooks] == places
    if kind == "rotate":
        assert [hook.rotation_euler.x for hook in hooks] == pytest.approx([0.4, 0.4], abs=1e-6)
    else:
        assert [hook.scale.x for hook in hooks] == pytest.approx([0.5, 0.5])


@pytest.mark.parametrize("kind", ["rotate", "scale"])
def test_objects_that_can_only_move_as_one_have_no_origins_of_their_own(kind: str) -> None:
    empty, target = below_hook()
    select(empty, target)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), kind)
    motion = Motion(turn(0.4, "X") if kind == "rotate" else stretch(1.5), np.zeros(3), individual=True)
    with pytest.raises(InputError, match=r'^Cube: only moves together with "Hook"; choose another pivot$'):
        edit.apply(motion)


def test_a_mesh_and_its_hook_move_as_one() -> None:
    empty, target = below_hook()
    start = evaluated(target)
    select(target, empty)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.apply(shift(x=1, z=-3))
    assert edit.write().passed and 0 < lowest(target) < 0.02
    np.testing.assert_allclose(np.ptp(evaluated(target), axis=0), np.ptp(start, axis=0), atol=1e-6)
    assert empty.location.z - 1 == pytest.approx(target.location.z - 2, abs=1e-6) and empty.location.x == 1


def test_the_guard_corrects_followers() -> None:
    empty, target = below_hook()
    settings = EditSettings()
    accepted = AcceptedScene.read(bpy.context, find_intersections(bpy.context, settings))
    empty.location.z -= 2.5
    bpy.context.view_layer.update()
    result = guard_result(bpy.context, settings, accepted)
    assert result.corrected == ["Hook"] and result.pairs == () and result.deformers == ()
    assert 0 < lowest(target) < 0.02 and check_scene(bpy.context).pairs == ()


def test_instances_that_follow_are_still_refused() -> None:
    """Only the meshes of objects are evaluated elsewhere."""
    source, other = add_cube("Source"), add("Target", None, (4, 0, 2))
    parts = bpy.data.collections.new("Parts")
    parts.objects.link(source)
    shown = add("Shown", None, (0, 0, 5), instance_type="COLLECTION", instance_collection=parts)
    constraint = shown.constraints.new("COPY_LOCATION")
    constraint.target = other
    select(other)
    with pytest.raises(ValueError, match="Target: no surface; also select an object that has one"):
        BlenderEdit.begin(bpy.context, EditSettings(), "move")
