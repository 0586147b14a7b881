# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirrored editing in Edit Mode: as Blender mirrors, symmetric, and free on both sides."""

from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, add_modifier, edit_mode, evaluated, meet, shift, snapshot, stretch
from mathutils import Vector

import stiv
from stiv.blender import BlenderEdit, EditSettings, check_scene, compare, correct_after_tool, read_state
from stiv.blender.controls.motion import Influence, Motion

MOVE = (0.15, 0.1, -0.2)


def add_sheet(axes: str) -> Any:
    """A subdivided sheet, turned, symmetric in the XZ and YZ planes of its own frame, one vertex excepted."""
    sheet = add_grid("Shëet", 6, location=(1, 2, 3), rotation_euler=(0.3, -0.2, 0.8), scale=(1.2, 0.8, -1))
    add_modifier(sheet, "SUBSURF", levels=1)
    for vertex in sheet.data.vertices:
        vertex.co.z = 0.1 * (vertex.co.x**2 + vertex.co.y**2)
    sheet.data.vertices[0].co.x += 0.01
    for axis in axes:
        setattr(sheet.data, f"use_mirror_{axis.lower()}", True)
    return sheet


def choose(sheet: Any, chosen: str) -> None:
    """Select vertices of the edit mesh: on one side, on both sides unevenly, or on the plane."""
    edited = bmesh.from_edit_mesh(sheet.data)
    limits = {"one side": (0.1, 0.7), "other side": (-0.7, -0.1), "both": (-0.4, 0.7), "with plane": (-0.1, 0.7)}
    low, high = limits[chosen]
    for vertex in edited.verts:
        vertex.select = low < vertex.co.x < high and -0.4 < vertex.co.y < 0.7
    edited.select_flush_mode()
    bmesh.update_edit_mesh(sheet.data)


def local(sheet: Any) -> np.ndarray:
    return np.array([vertex.co for vertex in bmesh.from_edit_mesh(sheet.data).verts])


def begin(settings: EditSettings | None = None) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, settings or EditSettings(), "move")


@pytest.mark.parametrize("chosen", ["one side", "other side", "both", "with plane"])
@pytest.mark.parametrize("axes", ["X", "XY"])
def test_without_contact_all_vertices_end_where_blender_puts_them(axes: str, chosen: str) -> None:
    sheet = add_sheet(axes)
    edit_mode(sheet)
    choose(sheet, chosen)
    before, start = snapshot(), local(sheet)
    edit = begin()
    edit.apply(shift(*MOVE))
    assert edit.write().passed
    mine = local(sheet)
    edit.restore()
    assert snapshot() == before
    bpy.ops.transform.translate(value=MOVE, mirror=True)
    assert np.abs(local(sheet) - start).max() > 0.1
    assert mine == pytest.approx(local(sheet), abs=3e-5)  # Blender's distance of mirror images


def test_proportional_editing_and_scale_are_mirrored_as_in_blender() -> None:
    sheet = add_sheet("XY")
    edit_mode(sheet)
    choose(sheet, "one side")
    edit = begin()
    edit.apply(Motion(shift(*MOVE), np.zeros(3), influence=Influence(0.6)))
    assert edit.write().passed
    mine = local(sheet)
    edit.restore()
    options = {"use_proportional_edit": True, "proportional_edit_falloff": "SMOOTH", "proportional_size": 0.6}
    bpy.ops.transform.translate(value=MOVE, mirror=True, **options)
    assert mine == pytest.approx(local(sheet), abs=3e-5)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "scale")
    centre = np.array(sheet.matrix_world @ Vector((0.5, 0.3, 0)))
    edit.apply(stretch((1.3, 0.9, 1.2), centre))
    assert edit.write().passed
    mine = local(sheet)
    edit.restore()
    bpy.ops.transform.resize(value=(1.3, 0.9, 1.2), mirror=True, center_override=centre)
    assert mine == pytest.approx(local(sheet), abs=3e-5)


def add_floor(sheet: Any) -> None:
    """A floor below one side of the sheet alone, in the sheet's frame."""
    floor = add_grid("Floor", 1, 0.4)
    floor.matrix_world = sheet.matrix_world
    for vertex in floor.data.vertices:
        vertex.co += Vector((-0.45, 0.1, -0.3))
    assert max(vertex.co.x for vertex in floor.data.vertices) < 0
    bpy.context.view_layer.update()


@pytest.mark.parametrize("axes", ["X", "XY"])
def test_contact_on_one_side_deflects_both(axes: str) -> None:
    """Nothing is below the selected side; the floor holds its mirror image, and so both sides, in their middle."""
    sheet = add_sheet(axes)
    for vertex in sheet.data.vertices[:1]:
        vertex.co.x -= 0.01
    add_floor(sheet)
    edit_mode(sheet)
    choose(sheet, "one side")
    edit = begin()
    down = np.array(sheet.matrix_world.to_3x3()) @ (0, 0, -0.9)
    edit.apply(shift(*down))
    assert edit.write().passed
    points = local(sheet)
    mirrored = points * (-1, 1, 1)
    assert np.abs(points[:, None] - mirrored[None]).sum(axis=2).min(axis=1).max() < 1e-5
    middle = points[np.abs(points[:, 1]) < 0.1, 2]
    assert -0.6 < middle.min() < -0.1
    assert check_scene(bpy.context).pairs == ()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert check_scene(bpy.context).pairs == ()


def add_twin(sheet: Any) -> None:
    add("Twin", sheet.data, (8, 0, 0), rotation_euler=(0.4, 0.9, -0.3))


def open_and_twist(sheet: Any) -> None:
    """A modifier that Blender evaluates, and an open seam that it leaves closed."""
    edited = bmesh.new()
    edited.from_mesh(sheet.data)
    bmesh.ops.split_edges(edited, edges=[edge for edge in edited.edges if all(abs(v.co.y) < 1e-3 for v in edge.verts)])
    edited.to_mesh(sheet.data)
    edited.free()
    assert len(sheet.data.vertices) == 7 * 7 + 7
    sheet.modifiers.clear()
    add_modifier(sheet, "SIMPLE_DEFORM", deform_method="TWIST", angle=0.2)


STACKS = {
    "along normals": lambda sheet: add_modifier(sheet, "DISPLACE", strength=0.05),
    "with a seam": open_and_twist,
    "shared": add_twin,
}


@pytest.mark.parametrize("stack", STACKS)
def test_modifiers_that_blender_evaluates_are_mirrored_too(stack: str) -> None:
    sheet = add_sheet("X")
    sheet.data.vertices[0].co.x -= 0.01
    STACKS[stack](sheet)
    add_floor(sheet)
    edit_mode(sheet)
    choose(sheet, "one side")
    edit = begin()
    edit.apply(shift(*np.array(sheet.matrix_world.to_3x3()) @ (0, 0, -0.9)))
    assert edit.write().passed
    points = local(sheet)
    assert np.abs(points[:, None] - (points * (-1, 1, 1))[None]).sum(axis=2).min(axis=1).max() < 1e-5
    middle = points[np.abs(points[:, 1]) < 0.1, 2]
    assert -0.6 < middle.min() < -0.1
    bpy.ops.object.mode_set(mode="OBJECT")
    assert meet(sheet.name, "Floor") == 0
    assert check_scene(bpy.context).pairs == ()


def test_the_live_guard_keeps_the_symmetry() -> None:
    sheet = add_sheet("X")
    sheet.data.vertices[0].co.x -= 0.01
    add_floor(sheet)
    edit_mode(sheet)
    choose(sheet, "one side")
    accepted = read_state(bpy.context)
    bpy.ops.transform.translate(value=np.array(sheet.matrix_world.to_3x3()) @ (0, 0, -0.9), mirror=True)
    changes = compare(accepted, read_state(bpy.context))
    assert correct_after_tool(bpy.context, EditSettings(), accepted, changes).corrected
    points = local(sheet)
    assert np.abs(points[:, None] - (points * (-1, 1, 1))[None]).sum(axis=2).min(axis=1).max() < 1e-5
    assert check_scene(bpy.context).pairs == ()


def test_object_mode_and_asymmetric_meshes_are_not_mirrored() -> None:
    cube = add_cube("Cube", location=(5, 0, 0))
    cube.data.use_mirror_x = True
    for vertex in cube.data.vertices:
        vertex.co.x += 3
    edit_mode(cube)
    start = evaluated(cube)
    edit = begin()
    edit.apply(shift(0.5, 0, 0))
    assert edit.write().passed
    assert evaluated(cube) == pytest.approx(start + (0.5, 0, 0), abs=1e-6)


def test_topology_mirror_is_refused_by_name() -> None:
    sheet = add_sheet("X")
    sheet.data.use_mirror_topology = True
    edit_mode(sheet)
    before = snapshot()
    with pytest.raises(stiv.InputError, match="Shëet: Topology Mirror is not supported; turn it off"):
        begin()
    assert snapshot() == before
