# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams that an edit tears: faces beside them are not tested, and are named if they cut each other at its end."""

from __future__ import annotations

import bpy
import numpy as np
from building import shift, turn
from torn_sheets import CROSSING, LEFT, PARTING, RIGHT, add_key, cutting_faces, named, rig_halves, torn_sheet

from blend_fixtures.characters import select_bones
from stiv.blender import BlenderEdit, EditSettings, MorphEdit, Motion, check_scene, morph
from stiv.blender.scene.torn_seams import self_cuts

SETTINGS = EditSettings(separation=0.001)


def test_a_morph_names_faces_that_cut_at_a_seam_it_tears() -> None:
    sheet = torn_sheet()
    add_key(sheet, "Cross", CROSSING)
    add_key(sheet, "Part", PARTING)
    report = morph(bpy.context, {"Sheet": {"Part": 1.0}}, SETTINGS)
    assert (report.status, report.torn_seam_note, cutting_faces(sheet)) == ("reached", "", 0)
    sheet.data.shape_keys.key_blocks["Part"].value = 0
    bpy.context.view_layer.update()
    report = morph(bpy.context, {"Sheet": {"Cross": 1.0}}, SETTINGS)
    assert report.values["Sheet", "Cross"] > 0.99
    assert named(report.torn_seam_note) == cutting_faces(sheet) == 2
    assert len(check_scene(bpy.context).pairs) > 0


def test_a_drag_of_a_key_names_them_at_each_value() -> None:
    sheet = torn_sheet()
    add_key(sheet, "Cross", CROSSING)
    edit = MorphEdit.begin(bpy.context, {"Sheet": {"Cross": 0.0}}, SETTINGS)
    for goal in (0.0, 0.6, 1.0):
        edit.advance(np.array([goal]))
        edit.show()
        assert cutting_faces(sheet) == (2 if goal else 0)
        assert named(edit.torn_seam_note) == 2 if goal else edit.torn_seam_note == ""
    edit.restore()
    assert cutting_faces(sheet) == 0


def test_a_pose_names_faces_that_cut_at_a_seam_it_tears() -> None:
    sheet = torn_sheet()
    rig = rig_halves(sheet)
    bpy.ops.object.mode_set(mode="POSE")
    select_bones(rig, "B")
    for along, count in ((0.3, 0), (-0.3, 2)):
        edit = BlenderEdit.begin(bpy.context, SETTINGS, "rotate")
        assert any(note.startswith("Sheet intersects itself") for note in edit.start_notes)
        assert edit.torn_seam_note == ""
        edit.apply(Motion(shift(along) @ turn(np.radians(40), "X", (0, 0.5, 0)), np.zeros(3)))
        assert edit.write().passed and cutting_faces(sheet) == count
        assert named(edit.torn_seam_note) == 2 if count else edit.torn_seam_note == ""
        edit.restore()


def test_faces_that_cut_at_the_start_are_not_named() -> None:
    sheet = torn_sheet()
    add_key(sheet, "Cross", CROSSING).value = 0.5
    bpy.context.view_layer.update()
    assert cutting_faces(sheet) == 2
    report = morph(bpy.context, {"Sheet": {"Cross": 1.0}}, SETTINGS)
    assert report.torn_seam_note == "" and report.start_notes == ("Sheet intersects itself, 2 faces, left as it is",)


def test_pairs_of_faces_are_those_of_checks() -> None:
    """Copies count as one vertex; triangles that lose a corner by that are left out."""
    points = np.array([*LEFT, *RIGHT, (-0.5, 0.5, -1), (-0.5, 0.5, 1), (-0.6, 0.4, 1), (0, 0, 0)], float)
    corners = np.array([(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7), (8, 9, 10), (1, 11, 2)], np.int32)
    assert self_cuts(points, corners, np.array([0, 0, 1, 1, 2, 3])) == {frozenset((0, 2))}
    assert self_cuts(points, corners[:4], np.array([0, 0, 1, 1])) == set()


def test_the_message_on_a_long_name_fits_the_status_bar() -> None:
    sheet = torn_sheet()
    sheet.name = "N" * 60
    add_key(sheet, "Cross", CROSSING)
    note = morph(bpy.context, {sheet.name: {"Cross": 1.0}}, SETTINGS).torn_seam_note
    assert len(note) == 80 and note.startswith("NNN") and "…: 2 faces at torn seams" in note
