# SPDX-License-Identifier: GPL-3.0-or-later
"""Machines of stiff pieces that cut each other at their joints, in one mesh: joints turn, and the pieces collide."""

from __future__ import annotations

from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from building import add, add_modifier, evaluated, mesh, turn

import stiv
from blend_fixtures.characters import make_rig, select_bones
from stiv.blender import BlenderEdit, EditSettings, Motion

ELBOW = (0.0, 0.0, 2.0)
REACH = 0.8  # from the elbow, of the faces that may cut each other
ANTENNA = [(0.3, 0, 3.4), (0.3, 0, 3.7)]
BONES = {"Upper": ("", (0, 0, 0), ELBOW, 0.2, False), "Lower": ("Upper", ELBOW, (0, 0, 4), 0.2, True)}


def box(low: Any, high: Any) -> tuple[np.ndarray, np.ndarray]:
    """A box of 6 x 49 quads."""
    made = bmesh.new()
    bmesh.ops.create_cube(made, size=1)
    bmesh.ops.subdivide_edges(made, edges=made.edges, cuts=6, use_grid_fill=True)
    unit = np.array([vertex.co for vertex in made.verts]) + 0.5
    faces = np.array([[vertex.index for vertex in face.verts] for face in made.faces])
    made.free()
    return np.array(low) + unit * (np.array(high) - low), faces


def make_arm(with_antenna: bool = False) -> tuple[Any, Any]:
    """Two boxes that overlap at the elbow, each on a bone: the rig, in Pose Mode, and the mesh."""
    (upper, first), (lower, second) = box((-0.2, -0.2, 0), (0.2, 0.2, 2.15)), box((-0.15, -0.15, 1.9), (0.15, 0.15, 4))
    points, faces = np.concatenate([upper, lower]), np.concatenate([first, second + len(upper)])
    edges = []
    if with_antenna:
        edges, points = [(len(points), len(points) + 1)], np.concatenate([points, ANTENNA])
    rig = make_rig(bones=BONES)
    arm = add("Arm", mesh("Arm", points.tolist(), faces.tolist(), edges=edges))
    arm.vertex_groups.new(name="Upper").add(range(len(upper)), 1, "REPLACE")
    arm.vertex_groups.new(name="Lower").add(range(len(upper), len(points)), 1, "REPLACE")
    arm.parent = rig
    add_modifier(arm, "ARMATURE", object=rig)
    select_bones(rig, "Lower")
    return rig, arm


def bend(degrees: float, settings: EditSettings | None = None) -> tuple[Any, BlenderEdit]:
    edit = BlenderEdit.begin(bpy.context, settings or EditSettings(), "rotate")
    result = edit.apply(Motion(turn(np.radians(degrees), "X", ELBOW), np.zeros(3)))
    assert edit.write().passed
    return result, edit


def furthest_cut(arm: Any) -> float:
    """The largest distance from the elbow of a face that cuts another one in Blender's evaluation."""
    shown = arm.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    shown.calc_loop_triangles()
    corners, points = np.array([each.vertices for each in shown.loop_triangles], np.int32), evaluated(arm)
    cutting = np.unique(stiv.find_intersections(points, corners))
    return float(np.linalg.norm(points[corners[cutting]].mean(axis=1) - ELBOW, axis=1).max(initial=0))


def test_a_joint_of_two_pieces_turns() -> None:
    rig, arm = make_arm()
    assert 0 < furthest_cut(arm) < REACH
    result, edit = bend(60)
    assert result.status == "reached" and rig.pose.bones["Lower"].rotation_quaternion.angle == pytest.approx(np.pi / 3)
    assert any("Arm: " in note and "faces at joints may fold" in note for note in edit.start_notes)
    assert "faces at joints cut into each other" in edit.fold_note


@pytest.mark.parametrize("with_antenna", [False, True])
def test_pieces_collide_beyond_their_joint(with_antenna: bool) -> None:
    rig, arm = make_arm(with_antenna)
    _, edit = bend(175, EditSettings(interference=False))
    assert furthest_cut(arm) > REACH
    edit.restore()
    result, _ = bend(175)
    assert result.status in ("corrected", "blocked") and furthest_cut(arm) < REACH
    assert 1.5 < rig.pose.bones["Lower"].rotation_quaternion.angle < 3.0


def test_loose_edges_of_a_divided_mesh_stop_at_surfaces() -> None:
    """The antenna of the lower arm swings toward a wall, which the arm itself does not reach."""
    rig, arm = make_arm(with_antenna=True)
    bone = rig.pose.bones["Lower"]
    bone.rotation_mode, bone.lock_rotation = "XYZ", (False, True, True)  # it cannot turn the antenna around the wall
    height = 2 + 1.7 * np.cos(0.3)
    wall = add("Wall", mesh("Wall", *_quad(-1.7 * np.sin(0.3), height)))
    _, edit = bend(40, EditSettings(interference=False))
    assert _pierces(arm, wall)
    edit.restore()
    result, _ = bend(40)
    assert result.status in ("corrected", "blocked") and not _pierces(arm, wall)


def _quad(y: float, z: float) -> tuple[list[tuple[float, float, float]], list[tuple[int, ...]]]:
    """An upright quad beside the arm, in the way of the antenna."""
    return [(x, y, z + dz) for x, dz in ((0.25, -0.5), (0.5, -0.5), (0.5, 0.5), (0.25, 0.5))], [(0, 1, 2, 3)]


def _pierces(arm: Any, wall: Any) -> bool:
    """Does the antenna lie on the other side of the wall, or across it? It swings to negative y."""
    return bool(evaluated(arm)[-2:, 1].min() < evaluated(wall)[:, 1].min())
