# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams: vertices of one mesh in the same place. Faces that touch in them alone are one surface, and stay so."""

from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, add_lattice, add_modifier, edit_mode, evaluated, mesh, select, shift
from oracles import rational

from stiv.blender import (
    BlenderEdit,
    EditSettings,
    ExpansionSettings,
    check_scene,
    compare,
    contract_scene,
    correct_after_tool,
    expand_scene,
    read_state,
    repair_scene,
)
from stiv.blender.settings import WeightGroup


def unwelded(name: str, count: int, **properties: Any) -> Any:
    """A square grid of which every face has vertices of its own, as careless imports have them."""
    grid = add_grid(name, count).data
    places = [tuple(grid.vertices[index].co) for face in grid.polygons for index in face.vertices]
    faces = [tuple(face.loop_indices) for face in grid.polygons]
    bpy.data.objects.remove(bpy.data.objects[name])
    return add(name, mesh(name, places, faces), **properties)


def torn_in_half(name: str, count: int) -> Any:
    """A bumpy square grid cut along x = 0."""
    grid = add_grid(name, count)
    edited = bmesh.new()
    edited.from_mesh(grid.data)
    for vertex in edited.verts:
        vertex.co.z = 0.05 * np.sin(7 * vertex.co.x + 3 * vertex.co.y)
    bmesh.ops.split_edges(edited, edges=[e for e in edited.edges if all(abs(v.co.x) < 1e-6 for v in e.verts)])
    edited.to_mesh(grid.data)
    edited.free()
    return grid


def select_vertices(ob: Any, wanted: Any) -> None:
    edit_mode(ob)
    edited = bmesh.from_edit_mesh(ob.data)
    for vertex in edited.verts:
        vertex.select_set(wanted(vertex))
    bmesh.update_edit_mesh(ob.data)


def places(ob: Any) -> np.ndarray:
    return np.array([tuple(vertex.co) for vertex in ob.data.vertices])


def coincident(points: np.ndarray, same: np.ndarray) -> bool:
    """Are the copies of each point still exactly coincident?"""
    return all(len(np.unique(points[same == number], axis=0)) == 1 for number in np.unique(same))


def joined_pairs(ob: Any) -> set[tuple[int, int]]:
    """Triangles of an object that meet in rational arithmetic, once coincident vertices are one."""
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    shown.calc_loop_triangles()
    corners = np.array([tuple(triangle.vertices) for triangle in shown.loop_triangles])
    q, same = np.unique(evaluated(ob), axis=0, return_inverse=True)
    return rational.find_intersections(q, same.reshape(-1)[corners])


def add_clean_objects() -> None:
    """A text with depth, an Edge Split, a surface of two NURBS patches, a NURBS sphere and an unwelded import."""
    letters = bpy.data.curves.new("Text", "FONT")
    letters.body, letters.extrude = "Text", 0.1  # the filling of the t has vertices on its edges
    add("Text", letters, (0, 5, 0))
    ball = bmesh.new()
    bmesh.ops.create_icosphere(ball, subdivisions=3, radius=1)
    data = bpy.data.meshes.new("Split")
    ball.to_mesh(data)
    ball.free()
    add_modifier(add("Split", data, (5, 0, 0)), "EDGE_SPLIT", split_angle=0.0)
    bpy.ops.surface.primitive_nurbs_surface_surface_add(location=(-6, 0, 0))
    patches = bpy.context.object.data
    for spline in patches.splines:
        spline.use_endpoint_u = spline.use_endpoint_v = True
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curve.select_all(action="SELECT")
    bpy.ops.curve.duplicate()
    bpy.ops.object.mode_set(mode="OBJECT")
    for point in patches.splines[1].points:
        point.co.x += 3
    bpy.ops.surface.primitive_nurbs_surface_sphere_add(location=(0, -5, 0))
    unwelded("Import", 8)
    bpy.context.view_layer.update()


def test_clean_objects_with_seams_are_free() -> None:
    add_clean_objects()
    found = check_scene(bpy.context)
    assert found.pairs == ()
    assert found.objects == 5
    assert found.seams > 4000


def test_faces_that_overlap_at_a_seam_still_intersect() -> None:
    doubled = add_grid("Doubled", 2)
    edited = bmesh.new()
    edited.from_mesh(doubled.data)
    bmesh.ops.duplicate(edited, geom=edited.faces[:1])
    edited.to_mesh(doubled.data)
    add("Folded", mesh("Folded", [(5, 0, 0), (6, 0, 0), (5, 1, 0), (5, 0, 0), (6, 0, 0), (5.2, 0.5, 0)],
                       [(0, 1, 2), (3, 4, 5)]))  # fmt: skip
    assert {(pair.first.object, pair.second.object) for pair in check_scene(bpy.context).pairs} == {
        ("Doubled", "Doubled"), ("Folded", "Folded")
    }  # fmt: skip
    select_vertices(doubled, lambda vertex: True)
    notes = BlenderEdit.begin(bpy.context, EditSettings(), "move").start_notes
    assert any(note.startswith("Doubled intersects itself") for note in notes)


def test_objects_that_touch_each_other_still_intersect() -> None:
    add_cube("One", (0, 0, 0))
    add_cube("Two", (2, 2, 2))
    assert len(check_scene(bpy.context).pairs) > 0


@pytest.mark.parametrize("way", ["vertices", "arap", "laplacian"])
@pytest.mark.parametrize("levels", [0, 1])
def test_a_seam_stays_closed_where_one_side_of_it_is_moved(way: str, levels: int) -> None:
    ob = unwelded("Import", 6)
    add_cube("Wall", (0, 0, 2.5))
    if levels:
        add_modifier(ob, "SUBSURF", levels=levels)
    same = np.unique(places(ob), axis=0, return_inverse=True)[1].reshape(-1)
    shown = np.unique(evaluated(ob), axis=0, return_inverse=True)[1].reshape(-1)
    held = len(np.unique(same)) < len(same) if levels == 0 or way != "vertices" else False
    centre = next(v.index for v in ob.data.vertices if v.co.length < 1e-6)
    select_vertices(ob, lambda vertex: vertex.index == centre or (abs(vertex.co.x) > 0.99 and way != "vertices"))
    edit = BlenderEdit.begin(bpy.context, EditSettings(deformations={ob.name: way}), "move")
    note = any("on its seams" in text for text in edit.summary.warnings)
    assert note == held
    result = edit.apply(shift(z=3))
    assert edit.write().passed
    bpy.ops.object.mode_set(mode="OBJECT")
    assert result.status == "corrected" or not held
    assert places(ob)[:, 2].max() > 1.2
    assert coincident(places(ob), same) == held
    assert coincident(evaluated(ob), shown)
    assert joined_pairs(ob) == set()
    assert check_scene(bpy.context).pairs == ()


def test_a_cut_below_a_subdivision_surface_stays_closed() -> None:
    ob = torn_in_half("Grid", 6)
    add_cube("Wall", (0, 0, 2.5))
    same = np.unique(places(ob), axis=0, return_inverse=True)[1].reshape(-1)
    add_modifier(ob, "SUBSURF", levels=2)
    assert check_scene(bpy.context).pairs == ()
    left = [face.index for face in ob.data.polygons if face.center.x < 0]
    rim = {index for face in left for index in ob.data.polygons[face].vertices}
    select_vertices(ob, lambda vertex: vertex.index in rim and vertex.co.x > -0.4 and abs(vertex.co.y) < 0.4)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert edit.apply(shift(z=3)).status == "corrected"
    assert edit.write().passed
    bpy.ops.object.mode_set(mode="OBJECT")
    assert coincident(places(ob), same)
    assert check_scene(bpy.context).pairs == ()


def test_the_guard_closes_a_seam_that_a_tool_tears() -> None:
    ob = unwelded("Import", 6)
    add_cube("Wall", (0, 0, 2.5))
    same = np.unique(places(ob), axis=0, return_inverse=True)[1].reshape(-1)
    accepted = read_state(bpy.context)
    moved = next(vertex.index for vertex in ob.data.vertices if vertex.co.length < 1e-6)
    ob.data.vertices[moved].co.z = 3
    ob.data.update()
    bpy.context.view_layer.update()
    changes = compare(accepted, read_state(bpy.context))
    outcome = correct_after_tool(bpy.context, EditSettings(), accepted, changes)
    assert outcome.corrected
    assert "3 vertices follow" in outcome.message
    assert 1.2 < ob.data.vertices[moved].co.z < 1.5
    assert coincident(places(ob), same)
    assert joined_pairs(ob) == set()
    assert check_scene(bpy.context).pairs == ()


def test_a_mesh_with_seams_is_repaired_contracted_and_expanded() -> None:
    ob = unwelded("Import", 8)
    same = np.unique(places(ob), axis=0, return_inverse=True)[1].reshape(-1)
    flat = places(ob)
    bent = flat.copy()
    bent[:, 2] = 0.3 * np.exp(-4 * (flat[:, 0] ** 2 + flat[:, 1] ** 2))
    ob.data.vertices.foreach_set("co", bent.ravel())
    ob.data.update()
    add_grid("Plate", 4, 0.6, (0.03, 0.02, 0.2))
    select(ob)
    assert check_scene(bpy.context).pairs
    report = repair_scene(bpy.context)
    assert (report.status, report.changed) == ("repaired", True)
    assert check_scene(bpy.context).pairs == ()
    assert coincident(places(ob), same)
    contract_scene(bpy.context)
    assert coincident(places(ob), same)
    expand_scene(bpy.context, ExpansionSettings(target=""))
    assert coincident(places(ob), same)


def test_a_seam_with_a_pinned_vertex_is_pinned() -> None:
    ob = unwelded("Import", 2)
    centre = [vertex.index for vertex in ob.data.vertices if vertex.co.length < 1e-6]
    group = ob.vertex_groups.new(name="Free")
    group.add([vertex.index for vertex in ob.data.vertices if vertex.index != centre[0]], 1.0, "REPLACE")
    start = places(ob)
    select_vertices(ob, lambda vertex: True)
    edit = BlenderEdit.begin(bpy.context, EditSettings(weights={ob.name: WeightGroup("Free")}), "move")
    edit.apply(shift(z=0.5))
    assert edit.write().passed
    bpy.ops.object.mode_set(mode="OBJECT")
    assert np.array_equal(places(ob)[centre], start[centre])
    assert places(ob)[:, 2].max() == pytest.approx(0.5)


def test_a_lattice_moves_the_copies_of_a_seam_alike_and_others_apart() -> None:
    ob = unwelded("Import", 4)
    lattice = add_lattice("Cage", (3, 3, 3), scale=(4, 4, 4))
    add_modifier(ob, "LATTICE", object=lattice)
    add_cube("Wall", (0, 0, 2.5))
    shown = np.unique(evaluated(ob), axis=0, return_inverse=True)[1].reshape(-1)
    select(lattice)
    edit = BlenderEdit.begin(bpy.context, EditSettings(object_response="deform"), "move")
    assert edit.apply(shift(z=3)).status == "corrected"
    assert edit.write().passed
    assert coincident(evaluated(ob), shown)
    assert check_scene(bpy.context).pairs == ()
    edit.restore()
    half = ob.vertex_groups.new(name="Half")
    half.add([vertex.index for vertex in ob.data.vertices if vertex.index < 32], 0.5, "REPLACE")
    ob.modifiers[0].vertex_group = "Half"
    bpy.context.view_layer.update()
    # Along the border of the group nothing keeps the seam closed.
    edit = BlenderEdit.begin(bpy.context, EditSettings(object_response="deform"), "move")
    assert any(note.startswith("Import intersects itself") for note in edit.start_notes)
