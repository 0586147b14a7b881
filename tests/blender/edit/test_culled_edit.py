# SPDX-License-Identifier: GPL-3.0-or-later
"""Distant obstacles are left out of a drag, and loaded before anything can touch them."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

pytest.importorskip("bpy")

import bpy

from stiv.blender import BlenderEdit, EditSettings, SceneChangedError, begin_culled_edit, check_scene
from stiv.blender.controls.participants import find_participants
from stiv.blender.edit.culled_edit import names_of
from stiv.blender.scene import culling
from stiv.blender.verify.scene_check import nearest_pair

DEFORM = EditSettings(object_response="deform")


@pytest.fixture(autouse=True)
def every_scene_is_large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(culling, "MIN_FACES", 0)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)


def box(name: str, x: float, size: float = 1.0, y: float = 0.0) -> Any:
    bpy.ops.mesh.primitive_cube_add(size=size, location=(x, y, 0))
    bpy.context.object.name = name
    return bpy.context.object


def select(ob: Any) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    ob.select_set(True)
    bpy.context.view_layer.objects.active = ob
    bpy.context.view_layer.update()


@pytest.fixture
def row() -> Any:
    """The box to be moved at 0, a neighbour at 1.7 that ends at y = -1, and a wall at 12."""
    box("Neighbour", 1.7, y=-1.5)
    box("Wall", 12, size=4)
    mover = box("Box", 0)
    select(mover)
    return mover


def along_x(distance: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[0, 3] = distance
    return matrix


def left_out(settings: EditSettings = EditSettings()) -> set[str]:  # noqa: B008 (frozen)
    found = culling.find_culling_box(bpy.context, names_of(find_participants(bpy.context, settings)), settings)
    return set() if found is None else set(found.left_out)


def test_distant_obstacles_are_left_out(row: Any) -> None:
    assert left_out() == {"Wall"}
    edit = begin_culled_edit(bpy.context, EditSettings(), "move")
    assert {mesh.owner.name for mesh in edit.assembly.meshes} == {"Box", "Neighbour"}
    assert edit.drag(along_x(0.5)).status == "reached" and not edit.has_all_obstacles


def test_the_box_allows_for_the_separation(row: Any) -> None:
    """The wall begins 9.5 away from the box."""
    roles = {"Neighbour": "ignored"}
    assert left_out(EditSettings(separation=1.0)) >= {"Wall"}
    assert "Wall" not in left_out(EditSettings(separation=5.0))
    for separation in (1.0, 4.0, 9.0):
        settings = EditSettings(separation=separation, roles=roles)
        edit = begin_culled_edit(bpy.context, settings, "move")
        for step in range(1, 21):
            edit.drag(along_x(0.5 * step))
            assert edit.write().passed
            nearest = nearest_pair(bpy.context, settings)
            assert nearest is not None and nearest.distance >= separation * (1 - 1e-6)
        edit.restore()


@pytest.mark.parametrize("settings", [EditSettings(), DEFORM])
@pytest.mark.parametrize("steps", [1, 7, 60])
def test_a_drag_toward_a_culled_obstacle_ends_as_without_culling(row: Any, steps: int, settings: EditSettings) -> None:
    found = []
    for begin in (lambda: begin_culled_edit(bpy.context, settings, "move"), whole(settings)):
        edit = begin()
        for step in range(1, steps + 1):
            edit.drag(along_x(14.0 * step / steps))
            assert edit.write().passed
            assert check_scene(bpy.context).pairs == ()
        for _ in range(40):
            edit.drag(along_x(14.0))
        edit.settle()
        assert edit.write().passed and check_scene(bpy.context).pairs == ()
        found.append(edit.surface[edit.assembly.vertices(names(edit).index("Box"))])
        edit.restore()
        assert row.location.x == 0
    assert found[0][:, 0].max() < 10
    assert found[0][:, 0].max() > 9.9
    assert_allclose(found[0], found[1], atol=0.02)


def test_only_approached_obstacles_are_loaded(row: Any) -> None:
    box("Ground", 0, y=60, size=20)
    select(row)
    assert left_out() == {"Wall", "Ground"}
    edit = begin_culled_edit(bpy.context, EditSettings(), "move")
    for step in range(1, 50):
        edit.drag(along_x(0.2 * step))
        edit.write()
    assert "Wall" in names(edit) and "Ground" not in names(edit)
    assert row.location.x > 9.3 and check_scene(bpy.context).pairs == ()
    edit.restore()
    assert row.location.x == 0


def whole(settings: EditSettings) -> Callable[[], BlenderEdit]:
    return lambda: BlenderEdit.begin(bpy.context, settings, "move")


def names(edit: Any) -> list[str]:
    return [mesh.owner.name for mesh in edit.assembly.meshes]


def test_everything_is_restored_after_long_drags(row: Any) -> None:
    before = [np.array(ob.matrix_world) for ob in bpy.data.objects]
    for distance in (0.5, 3.0, 14.0):
        edit = begin_culled_edit(bpy.context, EditSettings(), "move")
        edit.drag(along_x(distance))
        edit.write()
        edit.restore()
        bpy.context.view_layer.update()
        assert_array_equal([np.array(ob.matrix_world) for ob in bpy.data.objects], before)


def test_starts_are_the_same_with_and_without_culling(row: Any) -> None:
    near, all_of_it = begin_culled_edit(bpy.context, EditSettings(), "move"), whole(EditSettings())()
    assert near.start_digest == all_of_it.start_digest
    row.location.x = 0.25
    bpy.context.view_layer.update()
    assert whole(EditSettings())().start_digest != near.start_digest


def test_collisions_off_and_on_again_outside_the_box(row: Any) -> None:
    edit = begin_culled_edit(bpy.context, EditSettings(), "move")
    edit.drag(along_x(0.5))
    edit.write()
    edit.set_interference(False)
    edit.drag(along_x(9.8))
    edit.write()
    assert_allclose(row.location.x, 9.8)
    assert "back to" in edit.set_interference(True)
    edit.write()
    assert_allclose(row.location.x, 0.5, atol=1e-6)
    assert check_scene(bpy.context).pairs == ()


@pytest.mark.parametrize("tie", ["parent", "child", "modifier", "constraint", "settings"])
def test_dependent_obstacles_are_never_culled(row: Any, tie: str) -> None:
    wall, settings = bpy.data.objects["Wall"], EditSettings()
    if tie == "parent":
        wall.parent = bpy.data.objects["Neighbour"]
    elif tie == "child":
        bpy.data.objects["Neighbour"].parent = wall
    elif tie == "modifier":
        wall.modifiers.new("Boolean", "BOOLEAN").object = row
    elif tie == "constraint":
        wall.constraints.new("COPY_ROTATION").target = row
    else:
        settings = EditSettings(roles={"Wall": "rigid"})
    bpy.context.view_layer.update()
    assert "Wall" not in left_out(settings)


def test_small_scenes_are_not_culled(row: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(culling, "MIN_FACES", 1000)
    assert isinstance(begin_culled_edit(bpy.context, EditSettings(), "move"), BlenderEdit)


@pytest.fixture
def ground(monkeypatch: pytest.MonkeyPatch) -> Any:
    """A ball above one end of a long wavy ground, of which only a part is loaded at first."""
    monkeypatch.setattr(culling, "MIN_CROPPED_FACES", 100)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=80, y_subdivisions=20, size=2)
    below = bpy.context.object
    below.name, below.scale = "Ground", (20, 5, 1)
    for vertex in below.data.vertices:
        vertex.co.z = 0.3 * np.sin(20 * vertex.co.x)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8, location=(-15, 0, 1.5))
    bpy.context.object.name = "Ball"
    select(bpy.context.object)
    return bpy.context.object


def moved(edit: Any, name: str) -> np.ndarray:
    return edit.surface[edit.assembly.vertices(names(edit).index(name))]


def test_a_large_obstacle_is_cropped(ground: Any) -> None:
    edit, entire = begin_culled_edit(bpy.context, EditSettings(), "move"), whole(EditSettings())()
    assert not edit.has_all_obstacles and edit.start_digest == entire.start_digest
    part, all_of_it = (each.assembly.meshes[names(each).index("Ground")] for each in (edit, entire))
    assert 0 < len(part.triangles) < 0.5 * len(all_of_it.triangles)
    matrix = np.eye(4)
    matrix[2, 3] = -0.8
    for each in (edit, entire):
        assert each.drag(matrix).status == "corrected"
    assert_allclose(moved(edit, "Ball"), moved(entire, "Ball"), atol=1e-3)
    assert edit.write().passed and check_scene(bpy.context).pairs == ()


@pytest.mark.parametrize("steps", [1, 8, 50])
def test_a_drag_along_a_large_obstacle_touches_all_of_it(ground: Any, steps: int) -> None:
    edit = begin_culled_edit(bpy.context, EditSettings(), "move")
    matrix = np.eye(4)
    for step in range(1, steps + 1):
        matrix[0, 3], matrix[2, 3] = 30.0 * step / steps, -1.2
        edit.drag(matrix)
        assert edit.write().passed and check_scene(bpy.context).pairs == ()
    assert moved(edit, "Ball")[:, 2].min() > -0.35
    edit.restore()
    assert ground.location.x == -15


def test_an_obstacle_that_changes_its_size_during_a_drag_ends_it(ground: Any) -> None:
    edit = begin_culled_edit(bpy.context, EditSettings(), "move")
    edit.drag(along_x(0.5))
    bpy.data.objects["Ground"].modifiers.new("More", "SUBSURF").levels = 1
    bpy.context.view_layer.update()
    with pytest.raises(SceneChangedError):
        edit.write()
