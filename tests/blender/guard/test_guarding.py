# SPDX-License-Identifier: GPL-3.0-or-later
"""One intersection leaves the rest guarded; copies, extrusions and new objects are corrected, placed or named."""

from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from building import CUBE, add_cube, edit_mode, evaluated, select
from guarded_changes import guarded

from stiv.blender import check_scene
from stiv.blender.guard import free_place

WALL = 3.0  # where its face is, along x


def add_wall() -> Any:
    return add_cube("Wall", (WALL + 0.5, 0, 0), 1.0, scale=(0.5, 4, 4))


def pairs() -> set[tuple[str, str]]:
    return {(pair.first.object, pair.second.object) for pair in check_scene(bpy.context).pairs}


def duplicate(ob: Any, **values: Any) -> Any:
    """As Shift+D does it: the copy is selected and then moved."""
    select(ob)
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    for name, value in values.items():
        setattr(copy, name, value)
    return copy


def test_one_intersecting_pair_leaves_all_others_guarded_and_may_part() -> None:
    add_wall()
    box, stuck = add_cube("Box"), add_cube("Stuck", (0, 3, 0))
    add_cube("Other", (-0.5, 4, 0))
    outcome = guarded(lambda: setattr(box, "location", (9, 0, 0)))
    assert outcome.wrote and outcome.corrected == ["Box"]
    assert box.location.x == pytest.approx(WALL - 1, abs=0.02)
    assert pairs() == {("Stuck", "Other")} and len(outcome.pairs) == len(check_scene(bpy.context).pairs)
    outcome = guarded(lambda: setattr(stuck, "location", (9, 3, 0)))  # away from Other, into the wall
    assert stuck.location.x == pytest.approx(WALL - 1, abs=0.03) and outcome.pairs == () and pairs() == set()
    outcome = guarded(lambda: setattr(stuck, "location", (0, 3, 0)))  # guarded again since they are apart
    assert outcome.wrote and pairs() == set()


def test_an_object_that_intersects_itself_is_guarded_against_others() -> None:
    add_wall()
    mesh = bmesh.new()
    for matrix in ((0, 0, 0), (0.5, 0.3, 0.2)):
        moved = bmesh.ops.create_cube(mesh, size=1.0)["verts"]
        bmesh.ops.translate(mesh, verts=moved, vec=matrix)
    data = bpy.data.meshes.new("Eyes")
    mesh.to_mesh(data)
    eyes = bpy.data.objects.new("Eyes", data)
    bpy.context.collection.objects.link(eyes)
    outcome = guarded(lambda: setattr(eyes, "location", (9, 0, 0)))
    assert outcome.corrected == ["Eyes"] and pairs() == {("Eyes", "Eyes")}
    assert evaluated(eyes)[:, 0].max() == pytest.approx(WALL, abs=0.02)


def test_a_copy_dragged_into_a_wall_stops_on_the_side_of_its_original() -> None:
    add_wall()
    box = add_cube("Box")
    outcome = guarded(lambda: duplicate(box, location=(3.5, 0.5, 0)))
    copy = bpy.data.objects["Box.001"]
    assert outcome.corrected == ["Box.001"] and outcome.pairs == () and pairs() == set()
    assert copy.location.x == pytest.approx(WALL - 1, abs=0.02) and box.location.x == 0


def test_a_copy_that_overlaps_its_original_goes_to_the_nearest_free_place() -> None:
    box = add_cube("Box")
    outcome = guarded(lambda: duplicate(box, location=(1.5, 0.2, 0)))
    copy = bpy.data.objects["Box.001"]
    assert outcome.placed == ["Box.001"] and pairs() == set()
    assert tuple(copy.location) == pytest.approx((2, 0.2, 0), abs=0.02)


def test_a_copy_in_the_place_of_its_original_stays_and_is_named() -> None:
    box = add_cube("Box")
    outcome = guarded(lambda: duplicate(box))
    assert not outcome.wrote and outcome.reason == "Box.001: is in the place of Box; move it"
    assert outcome.pairs


@pytest.mark.parametrize("kind", ["primitive", "collection instance", "text"])
def test_a_new_object_goes_to_the_nearest_free_place(kind: str) -> None:
    add_wall()

    def add_new() -> None:
        if kind == "primitive":
            bpy.ops.mesh.primitive_uv_sphere_add(location=(2.8, 0, 0))
        elif kind == "text":
            bpy.ops.object.text_add(location=(2.5, 0, 0))
            bpy.context.object.data.extrude = 0.1
        else:
            sphere = bpy.data.objects.new("Inner", bpy.data.meshes.new("Inner"))
            ball = bmesh.new()
            bmesh.ops.create_icosphere(ball, subdivisions=2, radius=1.0)
            ball.to_mesh(sphere.data)
            collection = bpy.data.collections.new("Asset")
            collection.objects.link(sphere)
            empty = bpy.data.objects.new("New", None)
            empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", collection, (2.8, 0, 0)
            bpy.context.collection.objects.link(empty)

    outcome = guarded(add_new)
    assert outcome.wrote and len(outcome.placed) == 1 and outcome.pairs == () and pairs() == set()
    new = bpy.data.objects[outcome.placed[0]]
    assert 1.0 < new.location.x < 2.5 and abs(new.location.y) < 0.2


def test_a_new_text_of_another_size_is_not_taken_for_a_copy() -> None:
    wall = add_wall()
    bpy.ops.object.text_add(location=(2.9, 0, 0))
    text = bpy.context.object
    text.data.size = 0.05
    outcome = guarded(lambda: bpy.ops.object.text_add(location=(2.5, 0, 0)))
    assert outcome.placed == ["Text.001"] and outcome.reason == "Text.001 was added or shown" and pairs() == set()
    assert text.location.x == np.float32(2.9) and wall.location.x == WALL + 0.5


def test_a_copy_that_intersects_at_the_place_of_its_original_goes_to_a_free_place() -> None:
    """The original does not intersect the wall there, since a modifier shrinks it."""
    add_wall()
    box = add_cube("Box", (2.2, 0, 0))
    box.modifiers.new("Shrink", "DISPLACE").strength = -2
    bpy.context.view_layer.update()

    def copy() -> None:
        duplicate(box, location=(2.5, 0, 0)).modifiers.clear()

    outcome = guarded(copy)
    assert outcome.placed == ["Box.001"] and outcome.pairs == () and pairs() == set()


def test_objects_that_were_only_shown_stay_and_are_named() -> None:
    add_wall()
    box = add_cube("Box", (WALL, 0, 0))
    box.hide_set(True)
    outcome = guarded(lambda: box.hide_set(False))
    assert not outcome.wrote and box.location.x == WALL and outcome.pairs
    assert outcome.reason == "Box was added or shown"


def extrude(box: Any, distance: float) -> None:
    """Extrude the faces at the right side along x."""
    content = bmesh.from_edit_mesh(box.data)
    bpy.ops.mesh.select_all(action="DESELECT")
    for face in content.faces:
        if face.calc_center_median().x > 0.99:
            face.select_set(True)
    bmesh.update_edit_mesh(box.data)
    bpy.ops.mesh.extrude_region_move(TRANSFORM_OT_translate={"value": (distance, 0, 0)})


@pytest.mark.parametrize("levels", [0, 2])
def test_an_extrusion_stops_at_the_wall(levels: int) -> None:
    add_wall()
    box = add_cube("Box")
    if levels:
        box.modifiers.new("Subdivision", "SUBSURF").levels = levels
    edit_mode(box)
    content = bmesh.from_edit_mesh(box.data)
    bmesh.ops.subdivide_edges(content, edges=content.edges[:], cuts=2, use_grid_fill=True)  # vertices inside the region
    outcome = guarded(lambda: extrude(box, 6.0))
    assert outcome.corrected == ["Box"] and outcome.pairs == () and pairs() == set()
    box.update_from_editmode()
    assert WALL - 0.2 < evaluated(box)[:, 0].max() < WALL
    stored = np.array([vertex.co for vertex in box.data.vertices])
    assert np.isclose(stored[:, 0], 1.0).sum() == 12 and stored[:, 0].min() == -1.0
    bpy.ops.object.mode_set(mode="OBJECT")


def test_a_free_extrusion_stays_exactly() -> None:
    add_wall()
    box = add_cube("Box")
    edit_mode(box)
    outcome = guarded(lambda: extrude(box, 1 / 3))
    assert not outcome.wrote and outcome.pairs == ()
    box.update_from_editmode()
    assert max(vertex.co.x for vertex in box.data.vertices) == np.float32(1) + np.float32(1 / 3)
    bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize("what", ["join", "boolean"])
def test_new_geometry_of_other_tools_that_intersects_is_named(what: str) -> None:
    add_wall()
    box, other = add_cube("Box"), add_cube("Other", (0, 0, 5))

    def change() -> None:
        select(box, other)
        if what == "join":
            other.location.x = 3.5
            bpy.context.view_layer.update()
            bpy.ops.object.join()
        else:
            other.location = (3.5, 0, 0)
            modifier = box.modifiers.new("Boolean", "BOOLEAN")
            modifier.object, modifier.operation = other, "UNION"
            bpy.context.view_layer.update()
            bpy.ops.object.modifier_apply(modifier="Boolean")
            bpy.data.objects.remove(other)

    outcome = guarded(change)
    assert outcome.reason and ("Box", "Wall") in {tuple(sorted(pair)) for pair in pairs()}
    assert {each.object for pair in outcome.pairs for each in (pair.first, pair.second)} == {"Box", "Wall"}


@pytest.mark.parametrize("levels", [0, 1])
def test_a_primitive_added_in_edit_mode_goes_to_the_nearest_free_place(levels: int) -> None:
    add_wall()
    box = add_cube("Box", (0, 0, 0), scale=(0.5, 0.5, 0.5))
    if levels:
        box.modifiers.new("Subdivision", "SUBSURF").levels = levels
    edit_mode(box)
    outcome = guarded(lambda: bpy.ops.mesh.primitive_ico_sphere_add(location=(2.8, 0.1, 0)))
    bpy.ops.object.mode_set(mode="OBJECT")
    assert outcome.placed == ["Box"] and outcome.pairs == () and pairs() == set()
    assert evaluated(box)[:, 0].max() == pytest.approx(WALL, abs=0.02)
    assert np.array_equal([vertex.co for vertex in box.data.vertices][:8], np.array(CUBE))


def test_the_nearest_free_place_is_outside_closed_surfaces() -> None:
    """Inside the block, a twentieth of the way would be free."""
    add_cube("Block", (0, 0, 0), 4.0)
    outcome = guarded(lambda: bpy.ops.mesh.primitive_ico_sphere_add(radius=0.3, subdivisions=3, location=(3.75, 0, 0)))
    sphere = bpy.data.objects[outcome.placed[0]]
    assert sphere.location.x == pytest.approx(4.3, abs=0.01) and pairs() == set()


def test_a_slow_machine_finds_a_free_place_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(free_place, "TIME_LIMIT", 0.0)
    add_wall()
    outcome = guarded(lambda: bpy.ops.mesh.primitive_uv_sphere_add(location=(2.8, 0, 0)))
    assert len(outcome.placed) == 1 and pairs() == set()


def test_objects_added_together_stay_together() -> None:
    add_wall()
    box = add_cube("Box", (-9, 0, 0))
    turned, mirrored = (0, 0, 2 * np.pi), (1, -1, 1)

    def append() -> None:
        first = add_cube("First", (2.5, 0, 0))
        add_cube("Child", (0, 0, 2.5), parent=first)
        second = add_cube("Second", (2.5, 3, 0), scale=mirrored)
        second.rotation_euler = turned
        bpy.context.collection.objects.link(bpy.data.objects.new("Apart", None))

    outcome = guarded(append)
    places = np.array([bpy.data.objects[name].matrix_world.translation for name in ("First", "Child", "Second")])
    assert outcome.placed == ["Apart", "Child", "First", "Second"] and pairs() == set() and box.location.x == -9
    second = bpy.data.objects["Second"]
    assert tuple(second.rotation_euler) == pytest.approx(turned) and tuple(second.scale) == mirrored
    assert places - places[0] == pytest.approx(np.array([[0, 0, 0], [0, 0, 2.5], [0, 3, 0]]), abs=1e-5)
    assert places[0] == pytest.approx([2, 0, 0], abs=0.02)


def test_a_separated_part_stays_where_it_touches_the_rest() -> None:
    box = add_cube("Box")
    edit_mode(box)

    def separate() -> None:
        bpy.ops.mesh.select_all(action="DESELECT")
        content = bmesh.from_edit_mesh(box.data)
        content.faces.ensure_lookup_table()
        content.faces[0].select_set(True)
        bmesh.update_edit_mesh(box.data)
        bpy.ops.mesh.separate()
        bpy.ops.object.mode_set(mode="OBJECT")

    outcome = guarded(separate)
    assert not outcome.wrote and outcome.pairs and not outcome.pairs.cutting()


def test_new_objects_that_intersect_only_each_other_stay() -> None:
    add_wall()
    outcome = guarded(lambda: (add_cube("First", (-5, 0, 0)), add_cube("Second", (-5.5, 0, 0))))
    assert not outcome.wrote and pairs() == {("First", "Second")} and outcome.reason and outcome.pairs


def test_a_copy_of_a_large_mesh_in_its_place_names_only_some_faces() -> None:
    """Millions of pairs once took half a minute to name."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6, calc_uvs=False)
    ball = bpy.context.object
    outcome = guarded(lambda: duplicate(ball))
    assert outcome.reason == "Icosphere.001: is in the place of Icosphere; move it"
    assert {(pair.first.object, pair.second.object) for pair in outcome.pairs} == {("Icosphere", "Icosphere.001")}
    assert 0 < len(outcome.pairs) <= 1000


def duplicate_in_edit_mode(box: Any, offset: Any, **settings: Any) -> Any:
    """Shift+D of everything in Edit Mode; the outcome and the vertices of the copy in the world."""
    edit_mode(box)
    bpy.ops.mesh.select_all(action="SELECT")
    outcome = guarded(lambda: bpy.ops.mesh.duplicate_move(TRANSFORM_OT_translate={"value": offset}), **settings)
    bpy.ops.object.mode_set(mode="OBJECT")
    points = np.array([box.matrix_world @ vertex.co for vertex in box.data.vertices])
    return outcome, points[len(points) // 2 :]


@pytest.mark.parametrize("levels", [0, 1])
def test_a_duplicate_in_edit_mode_stops_on_the_side_of_its_source(levels: int) -> None:
    add_wall()
    box = add_cube("Box", (-3, 0, 0))
    if levels:
        box.modifiers.new("Subdivision", "SUBSURF").levels = levels
    source = np.array([box.matrix_world @ vertex.co for vertex in box.data.vertices])
    outcome, copy = duplicate_in_edit_mode(box, (6.5, 0.5, 0))
    assert outcome.corrected == ["Box"] and outcome.pairs == () and pairs() == set()
    assert evaluated(box)[:, 0].max() == pytest.approx(WALL, abs=0.02)
    assert np.ptp(copy, axis=0) == pytest.approx([2, 2, 2], abs=1e-5) and copy[:, 1].mean() == pytest.approx(0.5)
    assert np.array_equal([box.matrix_world @ vertex.co for vertex in box.data.vertices][:8], source)


def test_a_duplicate_in_edit_mode_that_overlaps_its_source_goes_to_the_nearest_free_place() -> None:
    box = add_cube("Box", (1, 0, 0), scale=(2, 1, 1))
    outcome, copy = duplicate_in_edit_mode(box, (0, 1.5, 0.2))
    assert outcome.placed == ["Box"] and pairs() == set()
    assert copy.mean(axis=0) == pytest.approx([1, 2, 0.2], abs=0.02)
    assert np.ptp(copy, axis=0) == pytest.approx([4, 2, 2], abs=1e-5)


def test_a_duplicate_in_edit_mode_in_the_place_of_its_source_is_named_and_can_be_moved() -> None:
    add_wall()
    box = add_cube("Box", (-3, 0, 0))
    outcome, _ = duplicate_in_edit_mode(box, (0, 0, 0))
    assert not outcome.wrote and outcome.reason == "Box: the copy is in the place of its source; move it"
    edit_mode(box)
    outcome = guarded(lambda: bpy.ops.transform.translate(value=(6.5, 0.5, 0)))
    bpy.ops.object.mode_set(mode="OBJECT")
    assert outcome.corrected == ["Box"] and outcome.pairs == () and pairs() == set()
