# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits of meshes with shape keys: the visible positions move, keys propagate as in Blender, and all stays free."""

from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from building import add_grid, add_modifier, edit_mode, evaluated, moved, select, shift, snapshot, turn

import stiv
from stiv.blender import (
    BlenderEdit,
    EditSettings,
    Handles,
    check_scene,
    compare,
    correct_after_tool,
    read_state,
    repair_scene,
    revert,
)

DEFORM = EditSettings(object_response="deform")
LIMITED = "Limited"


def add_face(active: str, value: float = 0.5, **properties: Any) -> Any:
    """A subdivided grid above a floor, with keys of every kind: relative to others, limited, muted and at 0."""
    rng = np.random.default_rng(3)
    add_grid("Floor", 3, 6.0, (0, 0, -3))
    face = add_grid("Fäce", 4, location=(0, 0, 0.5), scale=(1, -1.5, 1), **properties)
    add_modifier(face, "SUBSURF", levels=1, render_levels=1)
    group = face.vertex_groups.new(name="Left")
    group.add([k for k in range(25) if k % 5 < 2], 0.5, "REPLACE")
    names = ("Basis", "Smile", "Wide", LIMITED, "Muted", "Zero")
    for name in names:
        key = face.shape_key_add(name=name)
        key.value = value if name == active else 0.3
        if name != "Basis":
            for point in key.data:
                point.co = np.array(point.co) + rng.normal(0, 0.05, 3)
    blocks = face.data.shape_keys.key_blocks
    blocks["Wide"].relative_key = blocks["Smile"]
    blocks[LIMITED].vertex_group = "Left"
    blocks["Muted"].mute, blocks["Zero"].value = True, 0.0
    face.active_shape_key_index = names.index(active)
    bpy.context.view_layer.update()
    return face


def keys_of(ob: Any) -> dict[str, np.ndarray]:
    return {
        key.name: np.array([point.co for point in key.data], np.float32) for key in ob.data.shape_keys.key_blocks
    } | {"mesh": np.array([vertex.co for vertex in ob.data.vertices], np.float32)}


def begin(settings: EditSettings | None = None) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, settings or DEFORM, "move")


@pytest.mark.parametrize("pinned", [False, True], ids=["key", "mix"])
@pytest.mark.parametrize("active", ["Basis", "Smile", "Wide"])
def test_edit_mode_writes_what_blender_writes(active: str, pinned: bool) -> None:
    """Without contact, all keys equal those after Blender's own Move, and the shown vertices move by as much."""
    face = add_face(active, use_shape_key_edit_mode=pinned)
    edit_mode(face)
    bpy.ops.mesh.select_all(action="DESELECT")
    edited = bmesh.from_edit_mesh(face.data)
    edited.verts.ensure_lookup_table()
    for index in (6, 7, 11, 12):
        edited.verts[index].select_set(True)
    edited.select_flush_mode()
    edit_mode_snapshot = snapshot()
    edit = begin()
    edit.apply(shift(0.1, 0.2, 0.3))
    assert edit.write().passed
    bpy.ops.object.mode_set(mode="OBJECT")
    mine = keys_of(face)
    bpy.ops.object.mode_set(mode="EDIT")
    edit.restore()
    assert snapshot() == edit_mode_snapshot
    edited = bmesh.from_edit_mesh(face.data)
    value = 0.5 if pinned and active != "Basis" else 1.0  # Blender's Move divides by the value of a key in the mix
    inverse = np.array(face.matrix_world.inverted().to_3x3())
    for vertex in edited.verts:
        if vertex.select:
            vertex.co = np.array(vertex.co) + inverse @ (0.1, 0.2, 0.3) / value
    bmesh.update_edit_mesh(face.data)
    bpy.ops.object.mode_set(mode="OBJECT")
    theirs = keys_of(face)
    for name, points in mine.items():
        assert points == pytest.approx(theirs[name], abs=3e-6), name


@pytest.mark.parametrize("active", ["Basis", "Smile", LIMITED])
def test_object_mode_moves_the_mix(active: str) -> None:
    face = add_face(active)
    select(face)
    before, start = snapshot(), evaluated(face)
    edit = begin()
    assert snapshot() == before
    transform = turn(0.3, "Y") @ shift(z=0.2)
    assert edit.apply(transform).status == "reached"
    assert edit.write().passed
    shown = evaluated(face)
    if active == LIMITED:
        assert shown[24] == pytest.approx(start[24], abs=1e-6)
        assert np.abs(shown - start).max() > 0.1
    else:
        assert shown == pytest.approx(moved(transform, start), abs=2e-6)
    edit.restore()
    assert snapshot() == before


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT", "MIX"])
@pytest.mark.parametrize("active", ["Basis", "Smile", "Wide", LIMITED])
def test_the_mix_and_the_key_stay_free(active: str, mode: str) -> None:
    """Pressed into the floor, neither the edited key nor the mix that Object Mode and render show meets it."""
    face = add_face(active, 0.7, use_shape_key_edit_mode=mode == "MIX")
    select(face) if mode == "OBJECT" else edit_mode(face)
    start = evaluated(face)
    edit = begin()
    edit.apply(shift(0.3, 0, -5))
    assert edit.write().passed
    assert np.abs(evaluated(face) - start).max() > 1
    assert evaluated(face)[:, 2].min() > -3
    for settings in (DEFORM, EditSettings(guard="render")):
        assert check_scene(bpy.context, settings).pairs == ()
    if mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    assert evaluated(face)[:, 2].min() > -3
    assert check_scene(bpy.context, DEFORM).pairs == ()


def test_an_only_shown_key_is_edited_alone() -> None:
    face = add_face("Smile", show_only_shape_key=True)
    face.data.shape_keys.key_blocks["Smile"].value = 0
    select(face)
    start = evaluated(face)
    edit = begin()
    edit.apply(shift(z=1))
    assert edit.write().passed
    assert evaluated(face) == pytest.approx(moved(shift(z=1), start), abs=1e-6)


def test_edit_mode_accepts_a_key_without_value() -> None:
    """Edit Mode shows the key itself; Object Mode shows nothing of it."""
    face = add_face("Smile", 0.0)
    select(face)
    mix = evaluated(face)
    edit_mode(face)
    start = evaluated(face)
    edit = begin()
    edit.apply(shift(z=-6))
    assert edit.write().passed
    assert 2 < np.abs(evaluated(face) - start).max() < 3.6
    bpy.ops.object.mode_set(mode="OBJECT")
    assert evaluated(face) == pytest.approx(mix, abs=1e-6)  # a key that follows is rounded


def test_keys_without_effect_are_refused() -> None:
    face = add_face("Smile", 0.0)
    key = face.data.shape_keys.key_blocks["Smile"]
    select(face)
    before = snapshot()
    refused('Fäce: shape key "Smile" has value 0; raise it')
    key.value, key.mute = 0.5, True
    refused('Fäce: shape key "Smile" is muted; unmute it')
    key.mute, key.vertex_group = False, "Empty"
    face.vertex_groups.new(name="Empty")
    refused('Fäce: shape key "Smile" has no effect; change its vertex group')
    key.vertex_group, key.lock_shape = "", True
    refused('Fäce: shape key "Smile" is locked; unlock it')
    key.lock_shape, face.data.shape_keys.use_relative = False, False
    refused("Fäce: its shape keys are absolute; turn on Relative")
    face.data.shape_keys.use_relative, key.value = True, 0.0
    assert snapshot() == before
    begin(EditSettings())


def refused(message: str) -> None:
    assert len(message) <= 80
    with pytest.raises(stiv.InputError, match=message):
        begin()


def test_another_active_key_ends_the_edit() -> None:
    face = add_face("Smile")
    select(face)
    edit = begin()
    edit.drag(shift(z=0.1))
    face.active_shape_key_index = 2
    with pytest.raises(stiv.blender.SceneChangedError, match="Fäce has another active shape key"):
        edit.write()


def test_handles_deform_the_mix() -> None:
    face = add_face("Smile")
    group = face.vertex_groups.new(name="Handle")
    group.add([0, 1, 2, 3, 4], 1.0, "REPLACE")
    select(face)
    start = evaluated(face)
    edit = begin(EditSettings(deformations={"Fäce": "arap"}, handles={"Fäce": Handles(groups=("Handle",))}))
    edit.apply(shift(z=-5))
    assert edit.write().passed
    assert evaluated(face)[:, 2].min() > -3
    assert np.abs(evaluated(face) - start).max() > 1


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("active", ["Basis", "Smile"])
def test_the_live_guard_corrects_and_reverts_keys(active: str, mode: str) -> None:
    """As a brush or a tool in Edit Mode would, the key is pushed through the floor."""
    face = add_face(active)
    select(face) if mode == "OBJECT" else edit_mode(face)
    accepted, before = read_state(bpy.context), snapshot()
    push(face, -8.0)
    correction = correct_after_tool(bpy.context, DEFORM, accepted, compare(accepted, read_state(bpy.context)))
    assert correction.corrected
    assert evaluated(face)[:, 2].min() > -3
    assert evaluated(face)[:, 2].min() < -2
    assert check_scene(bpy.context, DEFORM).pairs == ()
    revert(bpy.context, accepted)
    assert snapshot() == before


def push(face: Any, z: float) -> None:
    """Move the active key and those relative to it, as Blender's brushes do."""
    if face.mode == "EDIT":
        edited = bmesh.from_edit_mesh(face.data)
        for vertex in edited.verts:
            vertex.co.z += z
        bmesh.update_edit_mesh(face.data)
        return
    names = ("Smile", "Wide") if face.active_shape_key_index else face.data.shape_keys.key_blocks.keys()
    for name in names:
        for point in face.data.shape_keys.key_blocks[name].data:
            point.co.z += z
    face.data.update()


def test_repair_changes_the_mix() -> None:
    """The mix folds through itself; repair edits the active key until Blender shows no intersection."""
    face = add_face("Smile", 1.0)
    for key in face.data.shape_keys.key_blocks:
        key.value = float(key.name == "Smile")
    bpy.data.objects.remove(bpy.data.objects["Floor"])
    smile = face.data.shape_keys.key_blocks["Smile"]
    smile.data[12].co = np.array(smile.data[12].co) + (1.2, 0.3, 0.0)
    smile.data[7].co = np.array(smile.data[7].co) + (1.2, 0.3, 0.3)
    basis = keys_of(face)["Basis"]
    select(face)
    bpy.context.view_layer.update()
    assert len(check_scene(bpy.context, DEFORM).pairs) > 0
    report = repair_scene(bpy.context)
    assert report.status == "repaired", report
    assert check_scene(bpy.context, DEFORM).pairs == ()
    assert np.array_equal(keys_of(face)["Basis"], basis)
