# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of other tools are goals: the correction is free of intersections, and close to the result."""

import math
import time
from dataclasses import replace
from typing import Any

import bmesh
import bpy
import pytest
from building import add, add_cube, add_grid, add_lattice, add_modifier, edit_mode, evaluated, mesh, select, snapshot

from stiv.blender import BlenderEdit, EditSettings, check_scene, compare, correct_after_tool, read_state
from stiv.blender.edit.solver import EditSolver

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


@pytest.mark.parametrize("keying", [True, False])
def test_keyframes_of_objects_follow_the_correction_with_auto_keying(keying: bool) -> None:
    """Without it, a message says that they will undo the correction."""
    add_wall()
    box = add_cube("Box")
    box.keyframe_insert("location")
    bpy.context.scene.tool_settings.use_keyframe_insert_auto = keying

    def move() -> None:
        box.location = (9, 0.5, 0)
        if keying:
            box.keyframe_insert("location")

    outcome = corrected(move)
    assert outcome.corrected and box.location.x == pytest.approx(WALL - 1, abs=0.02)
    bpy.context.scene.frame_set(bpy.context.scene.frame_current)
    assert box.location.x == pytest.approx(WALL - 1 if keying else 0, abs=0.02) and check_scene(bpy.context).pairs == ()
    assert outcome.message == ("" if keying else "Box: the next frame resets it to its keyframes; key it")


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


def test_each_solve_of_a_correction_has_only_the_time_that_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where Blender flips a quad into a post, so that the path is solved again, and where solves never settle."""
    limit, budgets, solve = 2.0, [], EditSolver.solve

    def recorded(solver: EditSolver, goal: Any, **limits: Any) -> Any:
        budgets.append((time.monotonic(), limits.get("time_budget") or solver._settings.time_budget))
        result = yield from solve(solver, goal, **limits)
        return replace(result, status="budget") if goal is None else result

    monkeypatch.setattr(EditSolver, "solve", recorded)
    quad = add("Quad", mesh("Quad", [(-1, 0, 0), (0, -1, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2, 3)]))
    add_cube("Post", (0, 0, 3.3), 1, scale=(0.02, 0.02, 3))
    bpy.context.view_layer.update()

    def raise_wings() -> None:
        for number in (1, 3):
            quad.data.vertices[number].co.z = 2
        quad.data.update()

    begin = time.monotonic()
    outcome = corrected(raise_wings, time_budget=limit)
    assert outcome.corrected and evaluated(quad)[[1, 3], 2].min() > 0.2
    assert sum(started < begin + limit for started, _ in budgets) > 3
    assert all(0 < budget <= max(begin + limit - started + 0.1, 0.5) for started, budget in budgets)


def rotate_z(ob: Any, angle: float, pivot: tuple[float, float] = (0.0, 0.0)) -> None:
    """As Blender's R about the z axis and a pivot."""
    x, y = ob.location.x - pivot[0], ob.location.y - pivot[1]
    ob.rotation_euler.z += angle
    ob.location.x = pivot[0] + x * math.cos(angle) - y * math.sin(angle)
    ob.location.y = pivot[1] + x * math.sin(angle) + y * math.cos(angle)


@pytest.mark.parametrize("pivot", [(0.0, 0.0), (0.5, -1.0)])
def test_a_corrected_rotation_turns_about_its_pivot_only(pivot: tuple[float, float]) -> None:
    add_wall()
    bar = add_cube("Bar", scale=(0.3, 3.2, 0.3))
    start = (bar.location.x - pivot[0], bar.location.y - pivot[1])
    assert corrected(lambda: rotate_z(bar, -1.4, pivot)).corrected
    angle = bar.rotation_euler.z
    assert -1.39 < angle < -0.2 and tuple(bar.rotation_euler[:2]) == (0, 0)
    assert evaluated(bar)[:, 0].max() == pytest.approx(WALL, abs=0.05)
    turned = (
        pivot[0] + start[0] * math.cos(angle) - start[1] * math.sin(angle),
        pivot[1] + start[0] * math.sin(angle) + start[1] * math.cos(angle),
    )
    assert tuple(bar.location) == pytest.approx((*turned, 0.0), abs=2e-6)
    assert pivot != (0.0, 0.0) or tuple(bar.location) == (0, 0, 0)


@pytest.mark.parametrize("place", [(0.0, 0.0, 0.0), (0.25, -0.5, 0.0)])
def test_a_corrected_uniform_scale_stays_uniform(place: tuple[float, float, float]) -> None:
    """Between two walls, whatever the pivot: it stops, or slides, and never squeezes."""
    add_wall()
    add_cube("Left", (-WALL - 0.5, 0, 0), scale=(0.5, 4, 4))
    box = add_cube("Box", rotation_euler=(0, 0, 0.4))

    def change() -> None:
        box.scale = (6, 6, 6)
        box.location = place

    assert corrected(change).corrected
    assert box.scale.x == box.scale.y == box.scale.z > 1.5
    assert box.rotation_euler.z == pytest.approx(0.4, abs=1e-7)


def test_a_corrected_scale_along_one_axis_keeps_the_other_factors() -> None:
    add_wall()
    box = add_cube("Box")
    assert corrected(lambda: setattr(box, "scale", (9, 1, 1))).corrected
    assert 2.9 < box.scale.x < 9 and tuple(box.scale[1:]) == (1, 1)
    assert tuple(box.location[1:]) == (0, 0) and evaluated(box)[:, 0].max() < WALL


def test_a_corrected_move_does_not_turn_not_even_beside_a_rotation() -> None:
    add_cube("Wall", (WALL + 0.5, 2.6, 0), 1.0, scale=(0.5, 2, 4))  # hit off the centre
    bar, other = add_cube("Bar", scale=(0.3, 1.5, 0.3)), add_cube("Other", (-6, 0, 0))

    def change() -> None:
        bar.location.x = 9
        other.rotation_euler.z = 0.5

    outcome = corrected(change)
    assert outcome.corrected and tuple(bar.rotation_euler) == (0, 0, 0)
    assert bar.location.x < WALL + 4.5
    assert other.rotation_euler.z == pytest.approx(0.5, abs=1e-6) and tuple(other.location) == (-6, 0, 0)


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


def test_a_shared_mesh_is_edited_once_for_a_parent_and_its_child(monkeypatch: pytest.MonkeyPatch) -> None:
    add_wall()
    box = add_cube("Box")
    child = bpy.data.objects.new("Child", box.data)
    child.parent, child.location = box, (-5, 0, 0)
    bpy.context.collection.objects.link(child)
    bpy.context.view_layer.update()
    started = []
    begin = BlenderEdit.begin_with_steps
    monkeypatch.setattr(
        BlenderEdit, "begin_with_steps", lambda *given, **options: started.append(given) or begin(*given, **options)
    )

    def pull() -> None:
        for vertex in box.data.vertices:
            vertex.co.x += 4 * (vertex.co.x > 0)
        box.data.update()

    outcome = corrected(pull)
    assert outcome.names == ("Box", "Child") and len(started) == 1
    assert evaluated(box)[:, 0].max() == pytest.approx(WALL, abs=0.02)


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
