# SPDX-License-Identifier: GPL-3.0-or-later
"""Machines and figures of stiff pieces that cut each other at their joints: joints turn, and the pieces collide."""

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
BOXES = {"Upper": ((-0.2, -0.2, 0), (0.2, 0.2, 2.15)), "Lower": ((-0.15, -0.15, 1.9), (0.15, 0.15, 4))}
KINDS = ["one mesh", "two meshes", "children of bones"]


def box(low: Any, high: Any) -> tuple[np.ndarray, np.ndarray]:
    """A box of 6 x 49 quads."""
    made = bmesh.new()
    bmesh.ops.create_cube(made, size=1)
    bmesh.ops.subdivide_edges(made, edges=made.edges, cuts=6, use_grid_fill=True)
    unit = np.array([vertex.co for vertex in made.verts]) + 0.5
    faces = np.array([[vertex.index for vertex in face.verts] for face in made.faces])
    made.free()
    return np.array(low) + unit * (np.array(high) - low), faces


def add_piece(rig: Any, name: str, points: np.ndarray, faces: np.ndarray, edges: Any, groups: dict[str, Any]) -> Any:
    """A mesh with an Armature modifier: vertices of each bone."""
    piece = add(name, mesh(name, points.tolist(), faces.tolist(), edges=edges))
    for bone, rows in groups.items():
        piece.vertex_groups.new(name=bone).add(rows, 1, "REPLACE")
    piece.parent = rig
    add_modifier(piece, "ARMATURE", object=rig)
    return piece


def make_arm(kind: str = "one mesh", antenna: bool = False) -> tuple[Any, list[Any]]:
    """Two boxes that overlap at the elbow, each on a bone: the rig, in Pose Mode, and the meshes."""
    rig, boxes = make_rig(bones=BONES), {bone: box(*ends) for bone, ends in BOXES.items()}
    if kind == "one mesh":
        (upper, first), (lower, second) = boxes.values()
        points, faces = np.concatenate([upper, lower]), np.concatenate([first, second + len(upper)])
        edges = [(len(points), len(points) + 1)] if antenna else []
        points = np.concatenate([points, ANTENNA]) if antenna else points
        groups = {"Upper": range(len(upper)), "Lower": range(len(upper), len(points))}
        pieces = [add_piece(rig, "Arm", points, faces, edges, groups)]
    elif kind == "two meshes":
        pieces = [add_piece(rig, bone, *each, [], {bone: range(len(each[0]))}) for bone, each in boxes.items()]
    else:
        pieces = [add(bone, mesh(bone, each[0].tolist(), each[1].tolist())) for bone, each in boxes.items()]
        for piece in pieces:
            piece.parent, piece.parent_type, piece.parent_bone = rig, "BONE", piece.name
            bpy.context.view_layer.update()
            piece.matrix_world = np.eye(4)
    select_bones(rig, "Lower")
    return rig, pieces


def bend(degrees: float, settings: EditSettings | None = None) -> tuple[Any, BlenderEdit]:
    edit = BlenderEdit.begin(bpy.context, settings or EditSettings(), "rotate")
    result = edit.apply(Motion(turn(np.radians(degrees), "X", ELBOW), np.zeros(3)))
    assert edit.write().passed
    return result, edit


def turned(rig: Any, bone: str = "Lower") -> float:
    return float(rig.pose.bones[bone].rotation_quaternion.angle)


def furthest_cut(pieces: list[Any]) -> float:
    """The largest distance from the elbow of a face that cuts another one in Blender's evaluation."""
    points, corners, count = [], [], 0
    for piece in pieces:
        shown = piece.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
        shown.calc_loop_triangles()
        corners.append(np.array([each.vertices for each in shown.loop_triangles], np.int32) + count)
        points.append(evaluated(piece))
        count += len(points[-1])
    triangles = np.concatenate(points)[np.concatenate(corners)]
    cutting = np.unique(stiv.find_intersections(np.concatenate(points), np.concatenate(corners).astype(np.int32)))
    return float(np.linalg.norm(triangles[cutting].mean(axis=1) - ELBOW, axis=1).max(initial=0))


@pytest.mark.parametrize("kind", KINDS)
def test_a_joint_of_two_pieces_turns(kind: str) -> None:
    rig, pieces = make_arm(kind)
    assert 0 < furthest_cut(pieces) < REACH
    result, edit = bend(60)
    assert result.status == "reached" and turned(rig) == pytest.approx(np.pi / 3)
    assert any("faces at joints may fold" in note for note in edit.start_notes)
    assert "faces at joints cut into each other" in edit.fold_note


@pytest.mark.shared
@pytest.mark.parametrize(("kind", "antenna"), [*((kind, False) for kind in KINDS), (KINDS[0], True)])
def test_pieces_collide_beyond_their_joint(kind: str, antenna: bool) -> None:
    rig, pieces = make_arm(kind, antenna)
    _, edit = bend(175, EditSettings(interference=False))
    assert furthest_cut(pieces) > REACH
    edit.restore()
    result, _ = bend(175)
    assert result.status in ("corrected", "blocked") and furthest_cut(pieces) < REACH
    assert 1.5 < turned(rig) < 3.0


@pytest.mark.parametrize("kind", KINDS)
def test_pieces_that_cut_each_other_turn_together(kind: str) -> None:
    """At each angle, Blender rounds them in another way, which does not count as deeper."""
    rig, pieces = make_arm(kind)
    select_bones(rig, "Upper")
    for degrees in (20, 33, -70, 5):
        before = turned(rig, "Upper")
        result, edit = bend(degrees)
        assert result.status == "reached" and edit.fold_note == ""
        assert turned(rig, "Upper") != before
    assert furthest_cut(pieces) > 0


def test_loose_edges_of_a_divided_mesh_stop_at_surfaces() -> None:
    """The antenna of the lower arm swings toward a wall, which the arm itself does not reach."""
    rig, (arm,) = make_arm(antenna=True)
    bone = rig.pose.bones["Lower"]
    bone.rotation_mode, bone.lock_rotation = "XYZ", (False, True, True)  # it cannot turn the antenna around the wall
    y, z = -1.7 * np.sin(0.3), 2 + 1.7 * np.cos(0.3)
    corners = [(x, y, z + dz) for x, dz in ((0.25, -0.5), (0.5, -0.5), (0.5, 0.5), (0.25, 0.5))]
    add("Wall", mesh("Wall", corners, [(0, 1, 2, 3)]))
    _, edit = bend(40, EditSettings(interference=False))
    assert evaluated(arm)[-2:, 1].min() < y
    edit.restore()
    result, _ = bend(40)
    assert result.status in ("corrected", "blocked") and evaluated(arm)[-2:, 1].min() > y
