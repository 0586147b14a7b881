# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of other tools are goals: the correction is free of intersections, and close to the result."""

from typing import Any

import bmesh
import bpy
import pytest
from building import add_cube, add_grid, add_lattice, add_modifier, edit_mode, evaluated, select, snapshot

from stiv.blender import EditSettings, check_scene, compare, correct_after_tool, read_state

WALL = 3.0  # where its face is, along x


def add_wall() -> Any:
    return add_cube("Wall", (WALL + 0.5, 0, 0), 1.0, scale=(0.5, 4, 4))


def corrected(change: Any, **settings: Any) -> Any:
    """Read the scene, change it, follow; the result must be free."""
    accepted = read_state(bpy.context)
    change()
    changes = compare(accepted, read_state(bpy.context))
    assert changes and not changes.unsupported, changes.unsupported
    outcome = correct_after_tool(bpy.context, EditSettings(**settings), accepted, changes)
    assert check_scene(bpy.context).pairs == ()
    return outcome


def test_an_object_moved_through_a_wall_stops_there() -> None:
    add_wall()
    box = add_cube("Box")
    outcome = corrected(lambda: setattr(box, "location", (9, 0.5, 0)))
    assert outcome.corrected and outcome.names == ("Box",)
    assert outcome.blocking in ((), ("Wall",))
    assert box.location.x == pytest.approx(WALL - 1, abs=0.02)
    assert box.location.y == pytest.approx(0.5, abs=0.02)


def test_a_free_result_is_left_exactly() -> None:
    add_wall()
    box = add_cube("Box", location=(0.1, 0, 0), rotation_euler=(0.3, 0, 0))

    def change() -> None:
        box.location = (1 / 3, -0.7, 0.1)
        box.rotation_euler.z = 0.77

    change()
    bpy.context.view_layer.update()
    expected = snapshot()
    box.location, box.rotation_euler.z = (0.1, 0, 0), 0
    outcome = corrected(change)
    assert not outcome.corrected
    assert snapshot() == expected


def test_an_object_turned_and_scaled_at_once_is_corrected() -> None:
    add_wall()
    box = add_cube("Box", (1, 0, 0))

    def change() -> None:
        box.rotation_euler.z = 0.6
        box.scale = (4, 1, 1)

    assert corrected(change).corrected
    assert box.rotation_euler.z == pytest.approx(0.6, abs=1e-3)
    assert box.scale.x > 1.1
    assert evaluated(box)[:, 0].max() < WALL


def test_vertices_moved_in_edit_mode_stop_at_the_wall_and_others_stay() -> None:
    add_wall()
    box = add_cube("Box")
    add_modifier(box, "SUBSURF", levels=2)
    edit_mode(box)

    def change() -> None:
        content = bmesh.from_edit_mesh(box.data)
        for vertex in content.verts:
            vertex.co.x += 6.0 if vertex.co.x > 0 else 0.0
        bmesh.update_edit_mesh(box.data)

    assert corrected(change).corrected
    box.update_from_editmode()
    assert all(vertex.co.x == -1 for vertex in box.data.vertices if vertex.co.x < 0)
    assert WALL - 0.1 < evaluated(box)[:, 0].max() < WALL


def test_points_of_a_lattice_stop_at_the_wall() -> None:
    add_wall()
    box, lattice = add_cube("Box"), add_lattice("Lattice", (2, 2, 2), scale=(2.5, 2.5, 2.5))
    add_modifier(box, "LATTICE", object=lattice)

    def change() -> None:
        for point in lattice.data.points:
            point.co_deform.x += 2.0
        lattice.data.update_tag()

    assert corrected(change).corrected
    assert WALL - 0.1 < evaluated(box)[:, 0].max() < WALL


def test_a_parent_and_its_child_are_both_corrected() -> None:
    add_wall()
    parent = add_cube("Parent")
    child = add_cube("Child", (0, 3, 0), 0.5, parent=parent)

    def change() -> None:
        parent.location.x = 0.5
        child.location.x = 7.0

    assert corrected(change).corrected
    assert parent.location.x == pytest.approx(0.5, abs=1e-5)
    assert evaluated(child)[:, 0].max() == pytest.approx(WALL, abs=0.05)


def test_objects_with_a_role_yield() -> None:
    box, other = add_cube("Box"), add_cube("Other", (3, 0, 0))
    outcome = corrected(lambda: setattr(box, "location", (2, 0, 0)), roles={"Other": "rigid"}, responders="unselected")
    assert outcome.corrected
    assert box.location.x == pytest.approx(2.0, abs=1e-5)
    assert other.location.x > 3.9


def test_a_refusal_leaves_the_tools_result() -> None:
    add_wall()
    box = add_cube("Box")
    box.constraints.new("LIMIT_LOCATION")
    accepted = read_state(bpy.context)
    box.location.x = 9.0
    changes = compare(accepted, read_state(bpy.context))
    with pytest.raises(ValueError, match="constraint"):
        correct_after_tool(bpy.context, EditSettings(), accepted, changes)
    assert box.location.x == 9.0


def test_cameras_are_ignored() -> None:
    add_wall()
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    bpy.context.collection.objects.link(camera)
    outcome = corrected(lambda: setattr(camera, "location", (3.5, 0, 0)))
    assert not outcome.corrected and outcome.names == ()
    assert tuple(camera.location) == (3.5, 0, 0)


@pytest.mark.parametrize("what", ["added", "removed", "structure", "both"])
def test_changes_that_no_motion_reproduces_are_named(what: str) -> None:
    box = add_grid("Box", 2)
    accepted = read_state(bpy.context)
    if what == "added":
        add_cube("New", (5, 0, 0))
    elif what == "removed":
        bpy.data.objects.remove(box)
    elif what == "structure":
        select(box)
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.subdivide()
        bpy.ops.object.mode_set(mode="OBJECT")
    else:
        box.location.x = 1.0
        box.data.vertices[0].co.z = 1.0
    obstacle = compare(accepted, read_state(bpy.context)).unsupported
    words = {"added": "added", "removed": "removed", "structure": "structure", "both": "at once"}
    assert words[what] in obstacle and ("New" if what == "added" else "Box") in obstacle


def test_selecting_changes_nothing() -> None:
    box = add_cube("Box")
    accepted = read_state(bpy.context)
    select(box)
    edit_mode(box)
    assert not compare(accepted, read_state(bpy.context))
