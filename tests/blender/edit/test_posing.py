# SPDX-License-Identifier: GPL-3.0-or-later
"""Pose bones as controls: they stop at contact within locks and limits, as Blender evaluates their meshes."""

from __future__ import annotations

import re
import warnings
from typing import Any

import bpy
import numpy as np
import pytest
from building import add_cube, add_modifier, evaluated, shift, stretch, turn
from oracles import rational

import stiv
from blend_fixtures.characters import make_character, select_bones
from stiv.blender import BlenderEdit, EditSettings, Motion, WriteReport, check_scene
from stiv.blender.edit import increments

SETTINGS = EditSettings(separation=0.01)
SHOULDER = (0.5, 0, 1.35)


def apply(kind: str, matrix: Any, settings: EditSettings = SETTINGS, **motion: Any) -> tuple[Any, WriteReport, Any]:
    """An edit by a matrix: the result, the report, and the edit."""
    edit = BlenderEdit.begin(bpy.context, settings, kind)
    result = edit.apply(Motion(matrix, motion.pop("pivot", np.zeros(3)), **motion))
    return result, edit.write(), edit


def triangles(ob: Any) -> np.ndarray:
    """Triangles of Blender's evaluation, (t, 3, 3)."""
    points = evaluated(ob)
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = shown.to_mesh()
    mesh.calc_loop_triangles()
    corners = np.array([list(each.vertices) for each in mesh.loop_triangles])
    shown.to_mesh_clear()
    return points[corners]


def intersecting(first: Any, second: Any) -> int:
    """Number of pairs of triangles of two objects that intersect, by exact rational arithmetic."""
    return pairs_of(triangles(first), triangles(second))


def pairs_of(a: np.ndarray, b: np.ndarray) -> int:
    """Number of pairs of triangles, (s, 3, 3) and (t, 3, 3), that intersect."""
    overlap = (a.min(1)[:, None] <= b.max(1)[None]).all(2) & (b.min(1)[None] <= a.max(1)[:, None]).all(2)
    pairs = np.argwhere(overlap).tolist()
    return sum(rational.triangles_intersect((0, 1, 2), (3, 4, 5), np.concatenate([a[i], b[j]])) for i, j in pairs)


def box_below_hand(voxel: float = 0.1, **properties: Any) -> tuple[Any, Any, Any]:
    """A character with a box below its left forearm: rig, body and box."""
    rig, body = make_character(voxel)
    box = add_cube("Box", (1.3, 0, 0.6), 0.3)
    bone = rig.pose.bones["Arm.L"]
    for name, value in properties.items():
        setattr(bone, name, value)
    select_bones(rig, "Arm.L")
    return rig, body, box


def lowest(body: Any) -> float:
    """Height of the left forearm above the box."""
    points = evaluated(body)
    return float(points[(points[:, 0] > 1.05) & (np.abs(points[:, 1]) < 0.3), 2].min()) - 0.9


@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ", "ZXY", "AXIS_ANGLE"])
def test_a_rotated_arm_stops_at_a_box_in_each_rotation_mode(mode: str) -> None:
    _, body, box = box_below_hand(rotation_mode=mode)
    result, report, _ = apply("rotate", turn(np.radians(60), "Y", SHOULDER))
    assert result.status == "corrected" and report.passed
    assert intersecting(body, box) == 0 and 0.005 < lowest(body) < 0.03
    back, report, _ = apply("rotate", turn(np.radians(-20), "Y", SHOULDER))
    assert back.status == "reached" and report.passed


def typed(most_still: int, monkeypatch: pytest.MonkeyPatch) -> tuple[np.ndarray, int]:
    """The body after a typed rotation onto the box, and the number of increments solved.

    most_still: increments in a row that may hold the arm still before the others are left out.
    """
    monkeypatch.setattr(increments, "MOST_STILL", most_still)
    _, body, _ = box_below_hand(rotation_mode="XYZ", lock_rotation=(False, True, True))
    edit = BlenderEdit.begin(bpy.context, SETTINGS, "rotate")
    count, drag_steps = 0, edit.drag_steps

    def counted(*given: Any) -> Any:
        nonlocal count
        count += 1
        return drag_steps(*given)

    monkeypatch.setattr(edit, "drag_steps", counted)
    edit.apply(Motion(turn(np.radians(150), "Y", SHOULDER), np.zeros(3)))
    assert edit.write().passed and 0.005 < lowest(body) < 0.03
    return evaluated(body), count


def test_a_typed_pose_leaves_out_increments_that_contact_holds_still(monkeypatch: pytest.MonkeyPatch) -> None:
    whole, all_increments = typed(10**6, monkeypatch)
    bpy.ops.wm.read_homefile(use_empty=True)
    found, few = typed(4, monkeypatch)
    assert found == pytest.approx(whole, abs=1e-3)
    assert few < all_increments / 2


def test_goals_are_those_of_blender() -> None:
    """Without contact, bones end where Blender's own operators put them."""
    rig, _, box = box_below_hand()
    bpy.data.objects.remove(box)
    matrices: list[list[Any]] = []
    for own in (False, True):
        for bone in rig.pose.bones:
            bone.location, bone.rotation_quaternion, bone.scale = (0, 0, 0), (1, 0, 0, 0), (1, 1, 1)
        select_bones(rig, "Arm.L")
        head = np.array(rig.pose.bones["Arm.L"].head)
        found = []
        for kind, matrix in (
            ("move", shift(0.1, 0.05, 0.2)),
            ("rotate", turn(0.5, "Z", head + np.array([0.1, 0.05, 0.2]))),
            ("scale", stretch(1.2, head + np.array([0.1, 0.05, 0.2]))),
        ):
            bpy.context.view_layer.update()
            if own:
                apply(kind, matrix)
            elif kind == "move":
                bpy.ops.transform.translate(value=(0.1, 0.05, 0.2))
            elif kind == "rotate":
                sign = 1 if bpy.app.version >= (5, 0, 0) else -1  # without a view
                bpy.ops.transform.rotate(value=sign * 0.5, orient_axis="Z")
            else:
                bpy.ops.transform.resize(value=(1.2, 1.2, 1.2))
            bpy.context.view_layer.update()
            found.append(np.array(rig.pose.bones["Forearm.L"].matrix))
        matrices.append(found)
    for theirs, mine in zip(*matrices, strict=True):
        assert np.allclose(mine, theirs, atol=1e-5)


def test_locks_and_limits_of_inverse_kinematics_hold() -> None:
    rig, body, box = box_below_hand(rotation_mode="XYZ", lock_rotation=(False, True, False))
    bone = rig.pose.bones["Arm.L"]
    bone.use_ik_limit_z, bone.ik_min_z, bone.ik_max_z = True, -0.02, 0.02
    bone.lock_location = (True, True, True)
    apply("rotate", turn(np.radians(60), "Y", SHOULDER) @ turn(0.4, "Z", SHOULDER) @ turn(0.4, "X", SHOULDER))
    assert bone.rotation_euler[1] == 0 and tuple(bone.location) == (0, 0, 0)
    assert abs(bone.rotation_euler[2]) <= np.float32(0.02)
    assert abs(bone.rotation_euler[0]) > 0.1
    assert intersecting(body, box) == 0


def test_inverse_kinematics_and_constraints_act_as_blender_evaluates_them() -> None:
    """A target outside the body moves the hand by inverse kinematics; it stops above the box."""
    rig, body, box = box_below_hand()
    bpy.ops.object.mode_set(mode="EDIT")
    target = rig.data.edit_bones.new("Target")
    target.head, target.tail = (1.5, 0, 1.35), (1.7, 0, 1.35)
    bpy.ops.object.mode_set(mode="POSE")
    constraint = rig.pose.bones["Forearm.L"].constraints.new("IK")
    constraint.target, constraint.subtarget, constraint.chain_count = rig, "Target", 2
    select_bones(rig, "Target")
    result, report, _ = apply("move", shift(-0.1, 0, -0.7))
    assert result.status in ("corrected", "blocked") and report.passed
    assert rig.pose.bones["Target"].location.length > 0.2
    assert intersecting(body, box) == 0


def test_all_that_the_rig_moves_is_the_surface() -> None:
    """A child of a bone, a mesh with a driven shape key, and subdivision after the armature collide too."""
    rig, body, box = box_below_hand(0.14)
    add_modifier(body, "SUBSURF", levels=1, render_levels=1)
    club = add_cube("Club", (0, 0, 0), 0.05)
    club.parent, club.parent_type, club.parent_bone = rig, "BONE", "Forearm.L"
    club.matrix_world.translation = (1.3, 0, 1.1)
    bump = body.shape_key_add(name="Basis") and body.shape_key_add(name="Bump")
    for point in bump.data:
        if point.co[0] > 1.05:
            point.co[2] -= 0.15
    driver = bump.driver_add("value").driver
    driver.type = "SUM"
    variable = driver.variables.new()
    variable.type = "TRANSFORMS"
    variable.targets[0].id, variable.targets[0].bone_target = rig, "Arm.L"
    variable.targets[0].transform_type, variable.targets[0].transform_space = "ROT_Y", "LOCAL_SPACE"
    for axis in ("ROT_X", "ROT_Z"):
        variable = driver.variables.new()
        variable.name, variable.type = f"turn_{axis}", "TRANSFORMS"
        variable.targets[0].id, variable.targets[0].bone_target = rig, "Arm.L"
        variable.targets[0].transform_type, variable.targets[0].transform_space = axis, "LOCAL_SPACE"
    result, report, _ = apply("rotate", turn(np.radians(60), "Y", SHOULDER))
    assert result.status == "corrected" and report.passed, report.message
    assert intersecting(body, box) == intersecting(club, box) == 0
    assert evaluated(club)[:, 2].min() == pytest.approx(0.91, abs=0.03)


def test_individual_origins_curl_a_chain() -> None:
    rig, _, _ = box_below_hand()
    bpy.context.scene.tool_settings.transform_pivot_point = "INDIVIDUAL_ORIGINS"
    select_bones(rig, "Arm.L", "Forearm.L")
    result, report, _ = apply("rotate", turn(np.radians(-40), "Y"), individual=True)
    assert result.status == "reached" and report.passed
    for name in ("Arm.L", "Forearm.L"):
        assert rig.pose.bones[name].rotation_quaternion.angle == pytest.approx(np.radians(40), abs=1e-5)


@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ"])
def test_x_axis_mirror_moves_both_sides_which_stop_together(mode: str) -> None:
    """One box below one hand stops both arms, at mirror images of each other; a difference at the start stays."""
    rig, body, box = box_below_hand(rotation_mode=mode)
    left, right = rig.pose.bones["Arm.L"], rig.pose.bones["Arm.R"]
    right.rotation_mode = "ZXY"
    rig.pose.use_mirror_x = True
    rig.pose.bones["Forearm.R"].scale = (1.1, 1.1, 1.1)
    bpy.context.view_layer.update()
    result, report, edit = apply("rotate", turn(np.radians(60), "Y", SHOULDER))
    assert result.status == "corrected" and report.passed
    assert intersecting(body, box) == 0 and 0.005 < lowest(body) < 0.03
    bpy.context.view_layer.update()
    assert np.allclose(right.tail, np.array(left.tail) * (-1, 1, 1), atol=1e-5) and right.tail.z < 1.3
    bpy.context.scene.tool_settings.use_keyframe_insert_auto = True
    edit.insert_keyframes(bpy.context)
    paths = {curve.data_path for curve in curves_of(rig)}
    assert 'pose.bones["Arm.R"].rotation_euler' in paths and not any("Forearm" in path for path in paths)
    edit.restore()
    assert tuple(right.rotation_euler) == (0, 0, 0)
    select_bones(rig, "Arm.L", "Arm.R")  # both selected: each moves by itself
    result, report, _ = apply("rotate", turn(np.radians(-20), "Y", SHOULDER))
    assert report.passed and right.tail.z < left.tail.z


def test_x_axis_mirror_moves_bones_as_blender_does() -> None:
    rig, _, box = box_below_hand()
    bpy.data.objects.remove(box)
    rig.pose.use_mirror_x = True
    rig.pose.bones["Arm.R"].rotation_mode = "ZXY"

    def matrices() -> np.ndarray:
        bpy.context.view_layer.update()
        return np.array([rig.pose.bones[name].matrix for name in ("Arm.L", "Arm.R", "Forearm.R")])

    bpy.context.scene.tool_settings.transform_pivot_point = "INDIVIDUAL_ORIGINS"
    bpy.ops.transform.rotate(value=0.35, orient_axis="Y", orient_type="GLOBAL")
    expected = matrices()
    for bone in rig.pose.bones:
        bone.rotation_quaternion, bone.rotation_euler = (1, 0, 0, 0), (0, 0, 0)
    bpy.context.view_layer.update()
    angle = -0.35 if expected[0, 2, 1] > 0 else 0.35  # the operator's sign differs between releases
    _, report, _ = apply("rotate", turn(angle, "Y", SHOULDER))
    assert report.passed and np.abs(matrices() - expected).max() < 1e-5


def curves_of(rig: Any) -> list[Any]:
    action = rig.animation_data.action
    if hasattr(action, "fcurves"):
        return list(action.fcurves)
    return [
        curve for layer in action.layers for strip in layer.strips for bag in strip.channelbags for curve in bag.fcurves
    ]


def test_other_bones_yield_if_asked() -> None:
    """The arm follows its goal exactly, and other bones turn away from the box."""
    rig, body, box = box_below_hand()
    settings = EditSettings(separation=0.01, responders="unselected")
    _, report, _ = apply("rotate", turn(np.radians(25), "Y", SHOULDER), settings)
    assert report.passed and intersecting(body, box) == 0
    assert rig.pose.bones["Arm.L"].rotation_quaternion.angle > np.radians(22)
    assert any(bone.rotation_quaternion.angle > 0.05 for bone in rig.pose.bones if bone.name != "Arm.L")


def limbs(body: Any) -> tuple[np.ndarray, np.ndarray]:
    """Triangles, (t, 3, 3), of the left arm, and of the body without arms; those at the shoulder are in neither.

    Where a pose has stretched the skin, the region of the shoulder reaches up to 0.45 from its head (0.5).
    """
    names = [group.name for group in body.vertex_groups]
    share = np.zeros(len(body.data.vertices))
    for vertex in body.data.vertices:
        share[vertex.index] = sum(each.weight for each in vertex.groups if names[each.group] in ("Arm.L", "Forearm.L"))
    body.data.calc_loop_triangles()
    corners = np.array([list(each.vertices) for each in body.data.loop_triangles])
    points, rest = evaluated(body), np.array([vertex.co for vertex in body.data.vertices])
    arm = (share[corners] == 1).all(1) & (rest[corners][:, :, 0] > 0.9).all(1)
    trunk = (share[corners] == 0).all(1) & (rest[corners][:, :, 0] > -0.45).all(1)
    return points[corners[arm]], points[corners[trunk]]


def turned(bone: Any) -> float:
    return float(np.degrees(bone.rotation_quaternion.angle))


def test_an_arm_collides_with_its_own_body() -> None:
    """Without collisions it would enter the chest; with them it stops there, and the shoulder folds."""
    rig, body, box = box_below_hand()
    bpy.data.objects.remove(box)
    _, _, edit = apply("rotate", turn(np.radians(100), "Y", SHOULDER), EditSettings(interference=False))
    assert pairs_of(*limbs(body)) > 0
    edit.restore()
    down = turn(np.radians(115), "Y", SHOULDER)
    result, report, edit = apply("rotate", down)
    assert result.status in ("corrected", "blocked") and report.passed
    assert 80 < turned(rig.pose.bones["Arm.L"]) < 105
    assert pairs_of(*limbs(body)) == 0
    assert any("Body: " in note and "faces at joints may fold" in note for note in edit.start_notes)


def faces_that_cut(ob: Any) -> int:
    """Number of faces of an object that intersect each other in Blender's evaluation."""
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    shown.calc_loop_triangles()
    corners = np.array([each.vertices for each in shown.loop_triangles], np.int32)
    faces = np.array([each.polygon_index for each in shown.loop_triangles])
    return len(np.unique(faces[stiv.find_intersections(evaluated(ob), corners)]))


def test_an_edit_says_how_many_faces_at_joints_cut_into_each_other() -> None:
    """They are not tested; all others are free. Those of the start do not count."""
    rig, body, box = box_below_hand()
    bpy.data.objects.remove(box)
    select_bones(rig, "Forearm.L")
    _, report, edit = apply("rotate", turn(np.radians(-20), "Z", (1, 0, 1.35)))
    assert report.passed and edit.fold_note == "" and faces_that_cut(body) == 0
    _, report, edit = apply("rotate", turn(np.radians(-120), "Z", (1, 0, 1.35)))
    assert report.passed
    found = re.fullmatch(r"Body: (\d+) faces at joints cut into each other", edit.fold_note)
    assert found and 0 < int(found[1]) == pytest.approx(faces_that_cut(body), abs=4)  # Blender may flip diagonals
    again = BlenderEdit.begin(bpy.context, SETTINGS, "rotate")
    assert again.fold_note == ""


@pytest.mark.shared
def test_folds_of_the_viewport_and_of_the_render_are_found_apart() -> None:
    """Both have faces and vertices with the same numbers. Without folds in either, none are named."""
    _, body, _ = box_below_hand(0.14)
    add_modifier(body, "SUBSURF", levels=1, render_levels=2)
    _, report, edit = apply("rotate", turn(np.radians(60), "Y", SHOULDER))
    assert report.passed and edit.guard.choice == "both"
    assert check_scene(bpy.context).pairs == () and edit.fold_note == ""


@pytest.mark.shared
def test_the_region_of_a_joint_is_adjustable() -> None:
    angles = []
    for region in (0.0, 1.2, 2.0):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        rig, _, box = box_below_hand()
        bpy.data.objects.remove(box)
        select_bones(rig, "Forearm.L")
        settings = EditSettings(separation=0.01, joint_region=region)
        apply("rotate", turn(np.radians(-150), "Z", (1, 0, 1.35)), settings)
        angles.append(turned(rig.pose.bones["Forearm.L"]))
    assert angles[0] < angles[1] < angles[2] and angles[2] > 110, angles
    with pytest.raises(stiv.InputError, match=r"joint_region: -1\.0 must be a finite number of at least 0"):
        EditSettings(joint_region=-1.0)


def test_limbs_that_cut_at_the_start_do_not_get_worse() -> None:
    _, body, box = box_below_hand()
    bpy.data.objects.remove(box)
    apply("rotate", turn(np.radians(100), "Y", SHOULDER), EditSettings(interference=False))
    before = pairs_of(*limbs(body))
    assert before > 0
    _, report, edit = apply("rotate", turn(np.radians(15), "Y", SHOULDER))
    assert report.passed and pairs_of(*limbs(body)) <= before
    assert any("Body intersects itself" in note for note in edit.start_notes)
    result, report, _ = apply("rotate", turn(np.radians(-40), "Y", SHOULDER))
    assert result.status == "reached" and report.passed and pairs_of(*limbs(body)) == 0


def test_an_animated_rig_that_renders_finer_is_guarded_in_the_viewport() -> None:
    """Its render would show the keyframes, and not the pose without keyframes."""
    rig, body, box = box_below_hand(0.14)
    add_modifier(body, "SUBSURF", levels=0, render_levels=1)
    for expected in ("both", "viewport"):
        result, report, edit = apply("rotate", turn(np.radians(60), "Y", SHOULDER))
        assert (result.status, report.passed, edit.guard.choice) == ("corrected", True, expected), report.message
        assert intersecting(body, box) == 0
        edit.restore()
        rig.pose.bones["Arm.L"].keyframe_insert("rotation_quaternion")
        rig.pose.bones["Arm.L"].rotation_quaternion = (0.99, 0, 0, 0.1)


def test_skin_finer_than_the_minimum_distance_does_not_hold_itself() -> None:
    rig, body, box = box_below_hand()
    bpy.data.objects.remove(box)
    result, report, edit = apply("rotate", turn(np.radians(-30), "Y", SHOULDER), EditSettings(separation=0.06))
    assert result.status == "reached" and report.passed
    assert turned(rig.pose.bones["Arm.L"]) == pytest.approx(30, abs=1e-3)
    assert len(edit.assembly.meshes) == 5 and pairs_of(*limbs(body)) == 0


def among_boxes() -> tuple[Any, Any, list[Any]]:
    """The character among seven boxes: rig, body and boxes."""
    rig, body, box = box_below_hand()
    places = [
        (-1.2, 0.1, 0.95), (0.25, -0.45, -1.2), (0.2, 0.75, 1.2), (1.3, 0.5, 1.4), (-1.3, -0.5, 1.4), (0, -0.8, 0.7)
    ]  # fmt: skip
    return rig, body, [box, *(add_cube(f"Box {place}", place, 0.2) for place in places)]


def pose_at_random(random: np.random.Generator, rig: Any) -> tuple[str, str]:
    """Rotate a random bone; the status, and why the pose could not be written."""
    head, axis, angle = random_rotation(random, rig)
    result, report, _ = apply("rotate", turn(angle, axis, head))
    return result.status, "" if report.passed else report.message


def random_rotation(random: np.random.Generator, rig: Any) -> tuple[np.ndarray, str, float]:
    """Select a random bone: its head, an axis and an angle."""
    bones = ["Arm.L", "Forearm.L", "Arm.R", "Forearm.R", "Thigh.L", "Shin.L", "Chest", "Spine"]
    name, axis = str(random.choice(bones)), str(random.choice(list("XYZ")))
    select_bones(rig, name)
    return np.array(rig.pose.bones[name].head), axis, random.uniform(-1.2, 1.2)


def count_intersections(body: Any, obstacles: list[Any]) -> int:
    """Intersecting pairs of triangles: of the body with the boxes, and of the left arm with the trunk."""
    return sum(intersecting(body, each) for each in obstacles) + pairs_of(*limbs(body))


@pytest.mark.shared
def test_random_poses_never_intersect() -> None:
    """Random rotations of random bones among obstacles: after each, the exact test finds nothing."""
    random, statuses = np.random.default_rng(7), []
    rig, body, obstacles = among_boxes()
    for _ in range(25):
        status, message = pose_at_random(random, rig)
        statuses.append(status)
        assert not message
        assert count_intersections(body, obstacles) == 0
    assert 5 < statuses.count("reached") < 20 and statuses.count("blocked") < 8, statuses


def test_cancelling_restores_the_pose_to_the_last_bit() -> None:
    rig, _, _ = box_below_hand(rotation_quaternion=(0.9, 0.1, 0.02, 0.3))
    bone = rig.pose.bones["Arm.L"]
    before = [*bone.rotation_quaternion, *bone.location]
    _, _, edit = apply("rotate", turn(0.5, "Z", SHOULDER))
    assert [*bone.rotation_quaternion, *bone.location] != before
    edit.restore()
    assert [*bone.rotation_quaternion, *bone.location] == before
    assert "STIV Evaluation" not in bpy.data.scenes


def test_an_empty_mesh_on_the_rig_does_not_matter() -> None:
    rig, _, _ = box_below_hand()
    empty = add_cube("Empty")
    empty.data.clear_geometry()
    add_modifier(empty, "ARMATURE", object=rig)
    empty.parent = rig
    _, report, _ = apply("rotate", turn(0.1, "Y", SHOULDER))
    assert report.passed


def test_there_is_no_surface_at_channels_that_blender_cannot_store() -> None:
    """Diverging rounds tried such: NumPy warned, and the pose became infinite."""
    box_below_hand()
    edit = BlenderEdit.begin(bpy.context, SETTINGS, kind="rotate")
    (posed,) = (each.posed for each in edit.control_sets if each.posed is not None)
    values = edit.controls.copy()
    assert np.isfinite(posed.deformation.surface(values)).all()
    values[0, 0] = 1e39
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(stiv.InfeasibleError):
            posed.deformation.surface(values)
