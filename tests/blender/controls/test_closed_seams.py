# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams in Pose Mode and in Morph: edits of a split mesh end as those of the mesh without copies of its vertices."""

from __future__ import annotations

from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, add_modifier, edit_mode, evaluated, mesh, select, turn
from torn_sheets import CROSSING, PARTING, add_key, cutting_faces, named, torn_sheet

import stiv
from blend_fixtures.characters import make_character, select_bones
from stiv.blender import (
    AcceptedScene,
    BlenderEdit,
    EditSettings,
    Motion,
    Task,
    check_scene,
    find_intersections,
    guard_result,
    morph,
)
from stiv.blender.controls.closed_seams import MergedRows
from stiv.blender.edit.snapshot import find_moving_vertices
from stiv.seams import Seams
from tests.stepping import take_steps

SETTINGS = EditSettings(separation=0.01)
SHOULDER = (0.5, 0, 1.35)


def split(ob: Any) -> None:
    """Give every face vertices of its own."""
    edited = bmesh.new()
    edited.from_mesh(ob.data)
    bmesh.ops.split_edges(edited, edges=edited.edges)
    edited.to_mesh(ob.data)
    edited.free()


def self_intersections(ob: Any) -> int:
    """Number of pairs of triangles that Blender shows intersecting, once vertices in the same place are one."""
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    shown.calc_loop_triangles()
    corners = np.array([tuple(triangle.vertices) for triangle in shown.loop_triangles])
    points, same = np.unique(np.round(evaluated(ob), 5), axis=0, return_inverse=True)
    joined = same.reshape(-1)[corners].astype(np.int32)
    return len(stiv.find_intersections(points, joined[(joined != np.roll(joined, 1, axis=1)).all(axis=1)]))


def widest_gap(ob: Any, start: np.ndarray) -> float:
    """Largest distance of vertices now that coincided at the start, (n, 3)."""
    same = np.unique(np.round(start, 5), axis=0, return_inverse=True)[1].reshape(-1)
    points, first = evaluated(ob), np.unique(same, return_index=True)[1]
    return float(np.abs(points - points[first[same]]).max())


def posed(is_split: bool, kind: str = "rotate", **settings: Any) -> tuple[Any, BlenderEdit, stiv.EditResult, float]:
    """A character whose left arm turns down, until a box or its own body stops it: body, edit, result and angle."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    rig, body = make_character(0.1)
    if is_split:
        split(body)
    if not settings.pop("without_box", False):
        add_cube("Box", (1.3, 0, 0.6), 0.3)
    select_bones(rig, "Arm.L")
    edit = BlenderEdit.begin(bpy.context, EditSettings(separation=0.01, **settings), kind)
    result = edit.apply(Motion(turn(np.radians(115), "Y", SHOULDER), np.zeros(3)))
    assert edit.write().passed
    return body, edit, result, float(rig.pose.bones["Arm.L"].rotation_quaternion.angle)


@pytest.mark.shared
@pytest.mark.parametrize("without_box", [False, True])
def test_a_split_character_is_posed_like_the_whole_one(without_box: bool) -> None:
    """Not even the number of the faces at joints differs, which are not tested."""
    _, whole, expected, angle = posed(False, without_box=without_box)
    body, edit, result, found = posed(True, without_box=without_box)
    assert result.status == expected.status == "corrected"
    assert found == pytest.approx(angle, abs=1e-3)
    assert edit.start_notes == whole.start_notes and "faces at joints may fold" in edit.start_notes[0]
    assert edit.torn_seam_note == "" and not edit.keeps_intersections
    assert edit.fold_note == whole.fold_note
    assert len(body.data.vertices) > 3 * edit.assembly.surface.vertex_count
    assert widest_gap(body, np.array([vertex.co for vertex in body.data.vertices])) < 1e-5


def test_a_split_shirt_that_yields_to_a_pose_stays_closed() -> None:
    found = []
    for is_split in (False, True):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        rig, _ = make_character(0.14)
        plate = add_grid("Plate", 6, 0.5, (1.3, 0, 0.9))
        start = evaluated(plate)
        if is_split:
            split(plate)
            start = evaluated(plate)
        select_bones(rig, "Arm.L")
        settings = EditSettings(separation=0.01, responders="unselected", deformations={"Plate": "vertices"})
        edit = BlenderEdit.begin(bpy.context, settings, "rotate")
        edit.apply(Motion(turn(np.radians(25), "Y", SHOULDER), np.zeros(3)))
        assert edit.write().passed and edit.torn_seam_note == ""
        assert not edit.keeps_intersections
        assert widest_gap(plate, start) < 1e-6
        assert check_scene(bpy.context, objects=["Plate"]).pairs == ()
        found.append(evaluated(plate)[:, 2].min())
    assert found[0] < 0.88 and found[1] == pytest.approx(found[0], abs=0.01)


@pytest.mark.parametrize("is_split", [False, True])
def test_faces_beside_a_seam_stop_a_morph_as_neighbours_do(is_split: bool) -> None:
    """The right half of a sheet falls on the left one at two thirds of the key."""
    places = [(x, y, max(x, 0)) for x in (-1, 0, 1) for y in (0, 1)]
    corners = [(0, 2, 3, 1), (2, 4, 5, 3)]
    sheet = add("Sheet", mesh("Sheet", places, corners))
    if is_split:
        split(sheet)
    sheet.shape_key_add(name="Basis")
    for point in sheet.shape_key_add(name="Close").data:
        if point.co.x > 0.5:
            point.co = (-1, point.co.y, -0.5)
    close = sheet.data.shape_keys.key_blocks["Close"]
    close.value = 0
    report = morph(bpy.context, {"Sheet": {"Close": 1.0}}, EditSettings(separation=0.001))
    assert report.status in ("blocked", "corrected") and 0.6 < close.value < 2 / 3
    assert report.start_notes == () and report.torn_seam_note == ""
    assert self_intersections(sheet) == 0
    close.value = 2 / 3
    assert self_intersections(sheet) > 0


def test_a_split_sheet_that_yields_to_a_morph_stays_closed() -> None:
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1, segments=16, ring_count=9)
    ball = bpy.context.object
    ball.shape_key_add(name="Basis")
    for point in ball.shape_key_add(name="Tall").data:
        point.co.z *= 1.5
    ball.data.shape_keys.key_blocks["Tall"].value = 0
    sheet = add_grid("Sheet", 8, 2.0, (0, 0, 1.2))
    split(sheet)
    start = evaluated(sheet)
    settings = EditSettings(separation=0.01, responders="unselected", deformations={"Sheet": "vertices"})
    report = morph(bpy.context, {ball.name: {"Tall": 1.0}}, settings)
    assert report.values[ball.name, "Tall"] == 1.0 and report.start_notes == ()
    assert evaluated(sheet)[:, 2].max() > 1.5 and widest_gap(sheet, start) < 1e-6
    assert check_scene(bpy.context).pairs == ()


def test_a_seam_that_opens_far_from_the_start_is_not_merged() -> None:
    """A driver moves one side of the seam once the bone has turned by 20 degrees, which the start does not show."""
    rig, body = make_character(0.14)
    split(body)
    body.shape_key_add(name="Basis")
    key = body.shape_key_add(name="Open")
    for point in list(key.data)[::2]:
        point.co.z += 0.01
    driver = key.driver_add("value").driver
    variable = driver.variables.new()
    variable.name, variable.type = "w", "TRANSFORMS"
    variable.targets[0].id, variable.targets[0].bone_target = rig, "Arm.L"
    variable.targets[0].transform_type, variable.targets[0].transform_space = "ROT_Y", "LOCAL_SPACE"
    driver.expression = "max(0, abs(w) - 0.35)"
    rig.pose.bones["Arm.L"].rotation_mode = "XYZ"
    select_bones(rig, "Arm.L")
    edit = BlenderEdit.begin(bpy.context, SETTINGS, "rotate")
    assert edit.keeps_intersections
    assert any("Body intersects itself" in note for note in edit.start_notes)


def test_an_evaluation_in_which_a_seam_has_opened_is_refused() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 0], [1, 0, 0], [5, 5, 5]])
    places = [np.array([0, 1, 2, 3], np.int32), np.array([4], np.int32)]
    vertices = MergedRows.of(places, [Seams.of(np.array([0, 1, 0, 1], np.int32)), None], points)
    assert vertices.rows.tolist() == [0, 1, 4]
    assert np.array_equal(vertices.merged(2 * points), 2 * points[[0, 1, 4]])
    points[3, 1] += 1e-3
    assert vertices.merged(points) is None


OPENS_AT = 0.8  # radians that the bone has turned


def sheet_that_opens(moved: dict[int, Any]) -> tuple[Any, Any]:
    """A sheet with a seam that a driver opens late, when its bone has turned far: the sheet and the bone."""
    sheet = torn_sheet()
    key = add_key(sheet, "Open", moved)
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.collection.objects.link(rig)
    select(rig)
    edit_mode(rig)
    made = rig.data.edit_bones.new("Bone")
    made.head, made.tail = (0, 0, 0), (0, 1, 0)
    bpy.ops.object.mode_set(mode="POSE")
    sheet.vertex_groups.new(name="Bone").add(list(range(8)), 1.0, "REPLACE")
    add_modifier(sheet, "ARMATURE", object=rig)
    driver = key.driver_add("value").driver
    variable = driver.variables.new()
    variable.name, variable.type = "turn", "TRANSFORMS"
    target = variable.targets[0]
    target.id, target.bone_target, target.transform_type, target.transform_space = rig, "Bone", "ROT_X", "LOCAL_SPACE"
    driver.expression = f"min(max(0, 5 * (turn - {OPENS_AT})), 1)"
    bone = rig.pose.bones["Bone"]
    bone.rotation_mode = "XYZ"
    select_bones(rig, "Bone")
    bpy.context.view_layer.update()
    return sheet, bone


def apply_turn(edit: BlenderEdit, angle: float) -> stiv.EditResult:
    return edit.apply(Motion(turn(angle, "X", (0, 0, 0)), np.zeros(3)))


def drag_turn(edit: BlenderEdit, angle: float) -> stiv.EditResult:
    """As with the mouse: in calls within a time budget, repeated at the goal."""
    for goal in (*np.linspace(0.1, angle, 12), *[angle] * 20):
        result = edit.drag(Motion(turn(goal, "X", (0, 0, 0)), np.zeros(3)), time_budget=0.2)
    return result


@pytest.mark.parametrize("move", [apply_turn, drag_turn])
def test_a_pose_continues_where_a_seam_opens_late(move: Any) -> None:
    """Its faces are then apart, as those of seams that open at once; Esc restores the start."""
    for moved, count in ((PARTING, 0), (CROSSING, 2)):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        sheet, bone = sheet_that_opens(moved)
        start = evaluated(sheet)
        edit = BlenderEdit.begin(bpy.context, EditSettings(separation=0.001), "rotate")
        assert len(edit.surface) == 6 and not edit.keeps_intersections
        assert move(edit, 1.2).status in ("reached", "unchanged") and edit.write().passed
        assert bone.rotation_euler.x == pytest.approx(1.2, abs=1e-4)
        assert len(edit.surface) == 8 and widest_gap(sheet, start) > 0.1
        assert np.array_equal(edit._moving_vertices, find_moving_vertices(edit.assembly, edit.control_sets))
        assert cutting_faces(sheet) == count
        assert [named(note) for note in edit.untested_notes] == ([count] if count else [])
        edit.restore()
        bpy.context.view_layer.update()
        assert bone.rotation_euler.x == 0 and np.array_equal(evaluated(sheet), start)


def test_a_drag_that_is_cancelled_where_a_seam_opens_keeps_the_shown_state() -> None:
    """At each of its steps, also while a session with open seams is made."""
    for before in range(100):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        _, bone = sheet_that_opens(PARTING)
        edit = BlenderEdit.begin(bpy.context, EditSettings(separation=0.001), "rotate")
        drag_turn(edit, 0.1)
        assert edit.write().passed
        task = Task(edit.drag_steps(Motion(turn(1.2, "X", (0, 0, 0)), np.zeros(3))))
        is_done = take_steps(task, before)
        task.cancel()
        while not task.advance(1.0):
            pass
        begins_again = len(edit.surface) == 8  # from the start
        assert bone.rotation_euler.x == pytest.approx(0.0 if begins_again else 0.1, abs=1e-4)
        assert edit.write().passed and drag_turn(edit, 0.2).status in ("reached", "unchanged")
        if is_done:
            break
    assert before > 3


def test_collisions_stay_on_where_an_edit_that_began_without_them_opens_a_seam() -> None:
    """Its start may intersect, so it does not begin again there."""
    sheet_that_opens(PARTING)
    edit = BlenderEdit.begin(bpy.context, EditSettings(separation=0.001, interference=False), "rotate")
    edit.drag(Motion(turn(0.1, "X", (0, 0, 0)), np.zeros(3)))
    assert edit.write().passed and edit.set_interference(True) == ""
    assert drag_turn(edit, 1.2).status != "unguarded"
    assert edit.interference and edit.write().passed


def test_an_edit_that_continues_with_an_open_seam_still_stops_at_obstacles() -> None:
    _, bone = sheet_that_opens(PARTING)
    add_cube("Box", (0, 0.2, 1.1), 0.2)
    edit = BlenderEdit.begin(bpy.context, EditSettings(separation=0.001), "rotate")
    assert apply_turn(edit, 1.5).status in ("blocked", "corrected") and edit.write().passed
    assert OPENS_AT + 0.2 < bone.rotation_euler.x < 1.2  # where the edge of the sheet meets the box
    assert not [each for each in check_scene(bpy.context).pairs if "Box" in (each.first.object, each.second.object)]


def test_the_guard_continues_where_a_seam_opens_late() -> None:
    settings = EditSettings(separation=0.001)
    sheet, bone = sheet_that_opens(CROSSING)
    accepted = AcceptedScene.read(bpy.context, find_intersections(bpy.context, settings))
    bone.rotation_euler.x = 1.2
    bpy.context.view_layer.update()
    outcome = guard_result(bpy.context, settings, accepted)
    assert not outcome.cut and bone.rotation_euler.x == pytest.approx(1.2, abs=1e-4)
    assert [named(note) for note in outcome.notes] == [cutting_faces(sheet)] == [2]
