# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that intersect themselves at the start are edited; no other pair of faces ever intersects."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import add_cube, add_grid, add_modifier, edit_mode, select, shift

import stiv
from stiv.blender import BlenderEdit, EditSettings, check_scene

DEFORM = EditSettings(object_response="deform")


def suzanne(levels: int = 0, location: Any = (0, 0, 0)) -> Any:
    """Blender's monkey, whose eyes cut its face."""
    bpy.ops.mesh.primitive_monkey_add(location=location)
    if levels:
        add_modifier(bpy.context.object, "SUBSURF", levels=levels, render_levels=levels)
    return bpy.context.object


def intersecting() -> set[frozenset[tuple[str, int]]]:
    """Pairs of faces that intersect now."""
    return {
        frozenset((each.object, each.number) for each in (pair.first, pair.second))
        for pair in check_scene(bpy.context).pairs
    }


@pytest.mark.shared
@pytest.mark.parametrize("levels", [0, 1])
@pytest.mark.parametrize("in_edit_mode", [False, True])
def test_a_mesh_that_intersects_itself_is_edited_and_no_other_faces_intersect(levels: int, in_edit_mode: bool) -> None:
    add_cube("Cube", (0, 0, -3.0))
    monkey = suzanne(levels)
    (edit_mode if in_edit_mode else select)(monkey)
    before = intersecting()
    faces = len(set().union(*before))
    edit = BlenderEdit.begin(bpy.context, DEFORM, "move")
    assert edit.keeps_intersections and edit.intersects_itself("Suzanne") and not edit.intersects_itself("Cube")
    assert edit.summary.warnings == (f"Suzanne intersects itself, {faces} faces, left as it is",)
    assert edit.apply(shift(x=0.2, z=-2.0)).status == "corrected"  # into the cube
    assert edit.write().passed
    assert intersecting() <= before
    assert len(check_scene(bpy.context).pairs) > 0  # a check still reports them
    edit.restore()
    for goal in (0.4, -0.3, 0.1):
        assert edit.drag(shift(y=goal)).status in ("reached", "corrected")
        assert edit.write().passed
        assert intersecting() <= before


def add_loose_part(ob: Any, kind: str) -> None:
    """A loose edge through a face, one between a corner of a face and another face, or a vertex in a face."""
    mesh = ob.data
    count = len(mesh.vertices)
    points = {"edge": [(0.1, 0.05, -0.5), (0.1, 0.05, 0.5)], "attached edge": [(0.1, 0.05, -0.5)]}
    points["vertex"] = [(0.1, 0.05, 0.0)]
    mesh.vertices.add(len(points[kind]))
    for vertex, place in zip(mesh.vertices[count:], points[kind], strict=True):
        vertex.co = place
    if kind == "attached edge":
        mesh.vertices[0].co.z = 0.5  # the edge passes through the face between its ends
        mesh.vertices[count].co = (0.4, 0.45, -0.5)
    if kind != "vertex":
        mesh.edges.add(1)
        mesh.edges[-1].vertices = (count, count + 1) if kind == "edge" else (0, count)


@pytest.mark.parametrize("kind", ["edge", "attached edge", "vertex"])
def test_loose_parts_that_cut_their_own_mesh_are_left_out_and_counted(kind: str) -> None:
    grid = add_grid("Sword", 4)
    add_loose_part(grid, kind)
    add_cube("Block", (0, 0, -2.0), 1.0)
    edit_mode(grid)
    before = len(check_scene(bpy.context).pairs)
    assert before > 0
    edit = BlenderEdit.begin(bpy.context, DEFORM, "move")
    assert edit.start_notes == ("Sword: 1 loose edge or vertex touches it and is not tested",)
    assert edit.apply(shift(z=-2.0)).status == "corrected"
    assert edit.write().passed
    assert not [pair for pair in check_scene(bpy.context).pairs if pair.first.kind == pair.second.kind == "face"]


def test_loose_edges_in_the_plane_of_a_face_do_not_block_their_mesh() -> None:
    """After each motion, rounding decides again whether they cut it."""
    grid = add_grid("Decal", 4)
    grid.rotation_euler = (0.3, 0.5, 0.7)
    for number, place in enumerate(np.random.default_rng(3).uniform(-0.4, 0.4, (12, 2))):
        count = len(grid.data.vertices)
        grid.data.vertices.add(2)
        grid.data.vertices[count].co = (*place, 1e-8)
        grid.data.vertices[count + 1].co = (*(place + 0.01), -1e-8 if number % 2 else 1e-8)
        grid.data.edges.add(1)
        grid.data.edges[-1].vertices = (count, count + 1)
    select(grid)
    edit = BlenderEdit.begin(bpy.context, DEFORM, "move")
    assert edit.start_notes == ("Decal: 12 loose edges or vertices touch it and are not tested",)
    assert edit.apply(shift(x=0.37, y=0.21, z=0.5)).status == "reached"
    assert edit.write().passed


def test_loose_parts_that_cut_another_object_are_refused_by_name() -> None:
    grid = add_grid("Sword", 4)
    add_loose_part(grid, "edge")
    add_cube("Block", (0.1, 0.05, 0.5), 0.2)
    edit_mode(grid)
    with pytest.raises(stiv.StartIntersectsError) as refused:
        BlenderEdit.begin(bpy.context, DEFORM, "move")
    assert str(refused.value) == "Sword: loose geometry cuts Block; use Mesh > Clean Up > Delete Loose"


def test_the_note_has_at_most_80_characters() -> None:
    monkey = suzanne()
    monkey.name = "M" * 63
    select(monkey)
    (note,) = BlenderEdit.begin(bpy.context, DEFORM, "move").start_notes
    assert len(note) == 80 and note.startswith("MMM") and note.endswith("… intersects itself, 52 faces, left as it is")


def test_other_objects_that_intersect_still_need_a_decision() -> None:
    add_grid("Floor", 4, 2.0)
    select(suzanne())
    with pytest.raises(stiv.StartIntersectsError, match="Floor") as refused:
        BlenderEdit.begin(bpy.context, DEFORM, "move")
    assert not any("Suzanne" in line and "Floor" not in line for line in str(refused.value).split(";")[1:2])


@pytest.mark.shared
def test_obstacles_that_intersect_each_other_do_not_block() -> None:
    add_cube("One", (3, 0, 0))
    add_cube("Other", (3.5, 0.2, 0.1))
    select(suzanne())
    edit = BlenderEdit.begin(bpy.context, DEFORM, "move")
    before = intersecting()
    edit.apply(shift(x=3.0))
    assert edit.write().passed
    assert intersecting() <= before


def test_an_intersection_may_pass_an_edge_that_it_touches() -> None:
    """An edge pierces a face at 2**-22 from its border, and single precision cannot keep it on that side."""
    near = 2.0**-22
    mesh = bpy.data.meshes.new("Wedge")
    sheet = [(-1, 0, 0), (1, 0, 0), (0, 1, 0), (0, -1, 0)]
    wedge = [(0, -1, near - 1), (0, 1, near + 1), (0.8, -0.3, 0.3), (-0.8, 0.3, -0.3)]
    mesh.from_pydata([*sheet, *wedge], [], [(0, 1, 2), (1, 0, 3), (4, 5, 6), (5, 4, 7)])
    ob = bpy.data.objects.new("Wedge", mesh)
    bpy.context.collection.objects.link(ob)
    for vertex in mesh.vertices:
        vertex.select = vertex.index > 3
    edit_mode(ob)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert edit.start_notes == ("Wedge intersects itself, 4 faces, left as it is",)
    assert edit.apply(shift(y=0.05)).status == "reached"
    assert edit.write().passed
    assert len(intersecting()) == 3
