# SPDX-License-Identifier: GPL-3.0-or-later
"""In large scenes, what certainly stays is an obstacle beside the surface; edits end as in a surface of everything."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from building import edit_mode
from numpy.testing import assert_allclose, assert_array_equal

pytest.importorskip("bpy")

import bpy

import stiv
from stiv.blender import (
    BlenderEdit,
    EditSettings,
    SceneChangedError,
    check_scene,
    contact_region,
)
from stiv.blender.controls.participants import find_participants
from stiv.blender.scene import obstacle_choice
from stiv.blender.scene.near_assembly import near_assembly
from stiv.blender.verify.scene_check import nearest_pair

DEFORM = EditSettings(object_response="deform")


@pytest.fixture(autouse=True)
def every_scene_is_large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obstacle_choice, "MIN_FACES", 0)
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


def obstacles(settings: EditSettings = EditSettings()) -> set[str]:  # noqa: B008 (frozen)
    participants = find_participants(bpy.context, settings)
    reshaped = {each.reference.name for each in participants if each.role != "rigid"}
    moving = [each.reference.find() for each in participants]
    return set(obstacle_choice.find_obstacles(bpy.context, moving, reshaped, settings))


def test_independent_objects_are_obstacles_beside_the_surface(row: Any) -> None:
    assert obstacles() == {"Wall", "Neighbour"}
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert names(edit) == ["Box"] and {each.owner.name for each in edit.assembly.obstacles} == {"Wall", "Neighbour"}
    assert edit.drag(along_x(0.5)).status == "reached" and edit.write().passed
    whole_summary = whole(EditSettings())().summary
    assert set(edit.summary.participants) == set(whole_summary.participants)
    assert edit.summary.triangles == whole_summary.triangles


def test_the_separation_holds_toward_obstacles(row: Any) -> None:
    """The wall begins 9.5 away from the box."""
    roles = {"Neighbour": "ignored"}
    for separation in (1.0, 4.0, 9.0):
        settings = EditSettings(separation=separation, roles=roles)
        edit = BlenderEdit.begin(bpy.context, settings, "move")
        for step in range(1, 21):
            edit.drag(along_x(0.5 * step))
            assert edit.write().passed
            nearest = nearest_pair(bpy.context, settings)
            assert nearest is not None and nearest.distance >= separation * (1 - 1e-6)
        edit.restore()


@pytest.mark.shared
@pytest.mark.parametrize("settings", [EditSettings(), DEFORM])
@pytest.mark.parametrize("steps", [1, 7, 60])
def test_a_drag_toward_an_obstacle_ends_as_in_a_surface_of_everything(
    row: Any, steps: int, settings: EditSettings
) -> None:
    found = []
    for begin in (lambda: BlenderEdit.begin(bpy.context, settings, "move"), whole(settings)):
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


def whole(settings: EditSettings) -> Callable[[], BlenderEdit]:
    return lambda: BlenderEdit.begin_with(bpy.context, settings, "move", find_participants(bpy.context, settings))


def names(edit: Any) -> list[str]:
    return [mesh.owner.name for mesh in edit.assembly.meshes]


def test_everything_is_restored_after_long_drags(row: Any) -> None:
    before = [np.array(ob.matrix_world) for ob in bpy.data.objects]
    for distance in (0.5, 3.0, 14.0):
        edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
        edit.drag(along_x(distance))
        edit.write()
        edit.restore()
        bpy.context.view_layer.update()
        assert_array_equal([np.array(ob.matrix_world) for ob in bpy.data.objects], before)


def test_starts_are_the_same_with_and_without_obstacles(row: Any) -> None:
    near, all_of_it = BlenderEdit.begin(bpy.context, EditSettings(), "move"), whole(EditSettings())()
    assert near.start_digest == all_of_it.start_digest
    row.location.x = 0.25
    bpy.context.view_layer.update()
    assert whole(EditSettings())().start_digest != near.start_digest


def test_collisions_off_and_on_again_far_away(row: Any) -> None:
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
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


@pytest.mark.parametrize("tie", ["parent", "modifier", "constraint", "settings"])
def test_what_depends_on_moving_objects_belongs_to_the_surface(row: Any, tie: str) -> None:
    wall, settings = bpy.data.objects["Wall"], EditSettings()
    if tie == "parent":
        wall.parent = row
    elif tie == "modifier":
        wall.modifiers.new("Boolean", "BOOLEAN").object = row
    elif tie == "constraint":
        wall.constraints.new("COPY_ROTATION").target = row
    else:
        settings = EditSettings(roles={"Wall": "rigid"})
    bpy.context.view_layer.update()
    assert "Wall" not in obstacles(settings)


def test_small_scenes_have_no_obstacles(row: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obstacle_choice, "MIN_FACES", 1000)
    assert BlenderEdit.begin(bpy.context, EditSettings(), "move").assembly.obstacles == ()


@pytest.fixture
def ground() -> Any:
    """A ball above one end of a long wavy ground, of which only a part is near at first."""
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


def test_states_are_tested_against_the_near_part_of_an_obstacle(ground: Any) -> None:
    edit, entire = BlenderEdit.begin(bpy.context, EditSettings(), "move"), whole(EditSettings())()
    assert edit.start_digest == entire.start_digest
    near = near_assembly(edit.assembly, edit.surface).assembly
    part, all_of_it = near.meshes[1], entire.assembly.meshes[names(entire).index("Ground")]
    assert part.owner == all_of_it.owner and 0 < len(part.triangles) < 0.2 * len(all_of_it.triangles)
    matrix = np.eye(4)
    matrix[2, 3] = -0.8
    for each in (edit, entire):
        assert each.drag(matrix).status == "corrected"
    assert_allclose(moved(edit, "Ball"), moved(entire, "Ball"), atol=1e-3)
    assert edit.write().passed and check_scene(bpy.context).pairs == ()


@pytest.mark.parametrize("steps", [1, 8, 50])
def test_a_drag_along_a_large_obstacle_touches_all_of_it(ground: Any, steps: int) -> None:
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    matrix = np.eye(4)
    for step in range(1, steps + 1):
        matrix[0, 3], matrix[2, 3] = 30.0 * step / steps, -1.2
        edit.drag(matrix)
        assert edit.write().passed and check_scene(bpy.context).pairs == ()
    assert moved(edit, "Ball")[:, 2].min() > -0.35
    edit.restore()
    assert ground.location.x == -15


def below(distance: float, x: float = 0.0) -> np.ndarray:
    matrix = along_x(x)
    matrix[2, 3] = -distance
    return matrix


def test_contacts_and_distances_are_those_of_a_surface_of_everything(ground: Any) -> None:
    shown = []
    for edit in (BlenderEdit.begin(bpy.context, EditSettings(), "move"), whole(EditSettings())()):
        result = edit.drag(below(0.8))
        result = result if len(result.events) else edit.drag(below(0.9))
        region, distance = contact_region(edit.assembly, result), edit.least_distance()
        assert region.closest is not None and distance is not None
        shown.append((region, distance, edit.surface))
        assert distance.bodies == ("Ball", "Ground") or distance.bodies == ("Ground", "Ball")
        edit.restore()
    (ours, near, _), (theirs, far, _) = shown
    assert len(ours.triangles) > 0
    assert_allclose(ours.closest, theirs.closest, atol=0.02)
    assert near.distance == pytest.approx(far.distance, abs=1e-3)


@pytest.mark.parametrize("is_solving", [False, True])
def test_the_least_distance_counts_obstacles_far_away(
    row: Any, is_solving: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The wall begins at 10, and the box is one large. The session is in use while a job solves."""
    bpy.data.objects.remove(bpy.data.objects["Neighbour"])
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    if is_solving:
        monkeypatch.setattr(stiv.EditSession, "least_distance", in_use)
    for x in (0.0, 3.0, 9.0, -30.0):
        edit.drag(along_x(x))
        edit.take_state()
        found = edit.least_distance()
        assert found is not None and set(found.bodies) == {"Box", "Wall"}
        assert found.distance == pytest.approx(9.5 - x, abs=1e-5)


def in_use(_session: stiv.EditSession) -> None:
    raise stiv.InputError("the session is in use")


def test_a_start_inside_of_an_obstacle_names_both_objects_and_faces(ground: Any) -> None:
    ground.location.z = 0.2
    bpy.context.view_layer.update()
    found = []
    for begin in (lambda: BlenderEdit.begin(bpy.context, EditSettings(), "move"), whole(EditSettings())):
        with pytest.raises(stiv.StartIntersectsError) as refused:
            begin()
        found.append(refused.value.objects)
    assert found[0] == found[1]
    assert found[0][0][:2] == ("Ball", "Ground")


@pytest.mark.parametrize("kind", ["edge", "vertex"])
def test_loose_elements_of_obstacles_collide(row: Any, kind: str) -> None:
    """A drag down onto a loose edge, or a loose vertex, below the middle of the box."""
    data = bpy.data.meshes.new("Wire")
    ends = [(-2, 0.1, -1), (2, 0.1, -1)] if kind == "edge" else [(0.1, 0.1, -1)]
    data.from_pydata([*ends, (50, 0, 0), (51, 0, 0), (50, 1, 0)], [(0, 1)] if kind == "edge" else [], [])
    bpy.context.collection.objects.link(bpy.data.objects.new("Wire", data))
    select(row)
    assert "Wire" in obstacles()
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    for depth in (0.3, 0.45, 0.55):
        result = edit.drag(below(depth))
        assert edit.write().passed and check_scene(bpy.context).pairs == ()
    assert result.status != "reached" and moved(edit, "Box")[:, 2].min() >= -1


def test_a_state_that_blender_shows_elsewhere_fails_beside_the_session(ground: Any) -> None:
    """As the add-on writes, while a job uses the session: the ground is moved into the ball behind the edit's back."""
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.drag(below(0.3))
    taken = edit.take_state()
    assert taken is not None
    assert edit.write_taken(taken) is not None
    edit.drag(below(0.4))
    taken = edit.take_state()
    assert taken is not None
    bpy.data.objects["Ground"].location.z += 1.0
    bpy.context.view_layer.update()
    assert edit.write_taken(taken) is None


def test_a_second_drag_reads_nothing_again_and_uses_the_same_session(ground: Any) -> None:
    edit_mode(ground)
    first = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    (obstacle,), session = first.assembly.obstacles, first._solver.session
    first.drag(below(0.3))
    assert first.write().passed
    first.finish()
    second = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert second.assembly.obstacles[0] is obstacle and second._solver.session is session
    second.finish()
    bpy.data.objects["Ground"].data.vertices[0].co.z += 0.01
    bpy.data.objects["Ground"].data.update()
    third = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert third.assembly.obstacles[0] is not obstacle and third._solver.session is not session


def test_a_parent_that_moves_between_two_drags_takes_its_obstacle_along(row: Any) -> None:
    wall, parent = bpy.data.objects["Wall"], bpy.data.objects.new("Parent", None)
    bpy.context.collection.objects.link(parent)
    wall.parent = parent
    bpy.data.objects.remove(bpy.data.objects["Neighbour"])
    bpy.context.view_layer.update()
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    session = edit._solver.session
    edit.drag(along_x(0.1))
    assert edit.write().passed
    edit.finish()
    parent.location.x = -9
    bpy.context.view_layer.update()
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert "Wall" in {each.owner.name for each in edit.assembly.obstacles} and edit._solver.session is not session
    edit.drag(along_x(3.0))
    assert edit.write().passed and check_scene(bpy.context).pairs == ()
    assert 0.1 < row.location.x <= 0.5  # the wall begins at 1, and the box ends 0.5 beside its middle


def test_distances_from_instances_name_their_instancer(row: Any) -> None:
    collection, wall = bpy.data.collections.new("Walls"), bpy.data.objects["Wall"]
    bpy.context.collection.objects.unlink(wall)
    collection.objects.link(wall)
    for name, x in (("Near", -18.0), ("Far", 30.0)):
        ob = bpy.data.objects.new(name, None)
        ob.instance_type, ob.instance_collection, ob.location.x = "COLLECTION", collection, x
        bpy.context.collection.objects.link(ob)
    bpy.data.objects.remove(bpy.data.objects["Neighbour"])
    bpy.context.view_layer.update()
    assert obstacles() == {"Near", "Far"}
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")  # the first instance ends at -4
    assert edit.drag(along_x(-2.0)).status == "reached" and edit.write().passed
    distance = edit.least_distance()
    assert distance is not None and set(distance.bodies) == {"Box", "Near"}
    edit.drag(along_x(3.0))
    assert edit.write().passed and check_scene(bpy.context).pairs == ()
    with pytest.raises(stiv.StartIntersectsError) as refused:
        row.location.x = 40
        bpy.context.view_layer.update()
        BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert refused.value.objects[0][:2] == ("Box", "Far")


@pytest.mark.parametrize("is_instance", [False, True])
def test_an_object_that_cannot_move_names_the_obstacle(row: Any, is_instance: bool) -> None:
    wall, name = bpy.data.objects["Wall"], "Wall"
    if is_instance:
        collection, name = bpy.data.collections.new("Walls"), "Walls"
        bpy.context.collection.objects.unlink(wall)
        collection.objects.link(wall)
        ob = bpy.data.objects.new(name, None)
        ob.instance_type, ob.instance_collection = "COLLECTION", collection
        bpy.context.collection.objects.link(ob)
        bpy.context.view_layer.update()
    for note in ("", f"nothing moved: already in contact with {name}"):
        edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
        assert name in {each.owner.name for each in edit.assembly.obstacles}
        edit.drag(along_x(14.0))
        result = edit.settle()
        assert edit.write().passed and edit.standstill_note(result) == note
        edit.finish()


def test_a_child_moves_along_its_parent_which_is_an_obstacle(row: Any) -> None:
    row.parent = bpy.data.objects["Wall"]
    row.matrix_parent_inverse = row.parent.matrix_world.inverted()
    bpy.context.view_layer.update()
    assert obstacles() == {"Wall", "Neighbour"}
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.drag(along_x(30.0))
    assert edit.write().passed and check_scene(bpy.context).pairs == ()
    assert 9.4 < row.matrix_world.translation.x < 9.5


def test_objects_that_share_a_mesh_follow_its_edit(row: Any) -> None:
    copy = bpy.data.objects.new("Copy", row.data)
    bpy.context.collection.objects.link(copy)
    copy.location.y = 8
    select(row)
    edit = BlenderEdit.begin(bpy.context, DEFORM, "move")
    assert {each.owner.name for each in edit.assembly.obstacles} == {"Wall", "Neighbour"}
    edit.drag(along_x(0.3))
    assert edit.write().passed and check_scene(bpy.context).pairs == ()


def test_what_only_the_viewport_shows_alike_belongs_to_a_guarded_surface(ground: Any) -> None:
    below = bpy.data.objects["Ground"]
    for settings, expected in ((EditSettings(guard="both"), set()), (EditSettings(guard="viewport"), {"Ground"})):
        below.hide_render = True
        assert obstacles(settings) == expected
        below.hide_render = False
        assert obstacles(settings) == {"Ground"}
        modifier = below.modifiers.new("Finer", "SUBSURF")
        modifier.levels, modifier.render_levels = 0, 1
        assert obstacles(settings) == expected
        below.modifiers.clear()


def test_an_obstacle_that_another_frame_moves_is_found_wherever_it_was(row: Any) -> None:
    """The wall is far away at first. In frame 5 it is there still, and in frame 10 it stands in the box."""
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.collection.objects.link(parent)
    bpy.data.objects["Wall"].parent = parent
    for frame, x in ((1, 0.0), (5, 0.0), (10, -12.0)):
        parent.location.x = x
        parent.keyframe_insert("location", frame=frame)
    for frame, passes in ((1, True), (5, True), (10, False), (1, True)):
        bpy.context.scene.frame_set(frame)
        if frame == 1:
            edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
            assert "Wall" in {each.owner.name for each in edit.assembly.obstacles}
        edit.drag(along_x(0.02 * frame))
        taken = edit.take_state()
        assert taken is not None and (edit.write_taken(taken) is not None) == passes
        report = edit.write()
        assert report.passed == passes
        assert passes or report.message == "Wall: this frame shows it differently; go back to frame 1"


def test_an_obstacle_that_changes_its_size_during_a_drag_ends_it(ground: Any) -> None:
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.drag(along_x(0.5))
    bpy.data.objects["Ground"].modifiers.new("More", "SUBSURF").levels = 1
    bpy.context.view_layer.update()
    with pytest.raises(SceneChangedError):
        edit.write()
