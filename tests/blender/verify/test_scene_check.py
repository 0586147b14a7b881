# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact test of a scene, with names and numbers of faces."""

import json
from pathlib import Path

import bpy
import numpy as np
from building import add, add_cube, add_grid, add_modifier, mesh

import stiv
from stiv.blender import EditSettings, check_scene, read_surface
from stiv.blender.scene.elements import Element, FacePair
from stiv.blender.scripts.blend_files import save_blend
from stiv.command_line import program


def test_a_free_scene() -> None:
    add_cube("One")
    add_cube("Two", (5, 0, 0))
    found = check_scene(bpy.context)
    assert (found.pairs, found.triangles, found.hidden) == ((), 24, 0)


def test_obstacles_against_each_other_and_within_themselves() -> None:
    add_grid("Flöor 1", 1)
    add("Spike", mesh("Spike", [(0.2, 0.1, -1), (0.3, 0.1, -1), (0.25, 0.1, 1)], [(0, 1, 2)]))
    crossed = [(5, -1, -1), (5, 1, -1), (5, 0, 1), (4.5, 0, 0), (5.5, 0.3, 0), (5.5, -0.3, 0)]
    add("Crossed", mesh("Crossed", crossed, [(0, 1, 2), (3, 4, 5)]))
    pairs = {(pair.first.object, pair.second.object) for pair in check_scene(bpy.context).pairs}
    assert pairs == {("Crossed", "Crossed"), ("Flöor 1", "Spike")}
    assert check_scene(bpy.context, objects=["Spike"]).pairs == ()


def test_faces_and_loose_parts_are_numbered_as_in_the_evaluated_mesh() -> None:
    grid = add_grid("Grid", 3, 1.5)
    add("Wire", mesh("Wire", [(0, 0, 9), (0.2, 0.1, -1), (0.2, 0.1, 1)], [], [(0, 2), (1, 2)]))
    assert check_scene(bpy.context).pairs == (FacePair(Element("Wire", "edge", 1), Element("Grid", "face", 4)),)
    add_modifier(grid, "SUBSURF", levels=1, render_levels=1, subdivision_type="SIMPLE")
    (pair,) = check_scene(bpy.context).pairs
    shown = grid.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    corners = np.array([shown.vertices[index].co for index in shown.polygons[pair.second.number].vertices])
    assert (corners[:, :2].min(axis=0) <= [0.2, 0.1]).all() and (corners[:, :2].max(axis=0) >= [0.2, 0.1]).all()


def test_a_loose_vertex_on_a_face() -> None:
    add_grid("Grid", 3, 1.5)
    add("Point", mesh("Point", [(7, 7, 7), (0.25, 0.125, 0)], []))
    assert check_scene(bpy.context).pairs == (FacePair(Element("Point", "vertex", 1), Element("Grid", "face", 4)),)


def test_ignored_objects_and_pairs_are_left_out() -> None:
    add_cube("One")
    add_cube("Two", (0.5, 0.4, 0.3))
    assert check_scene(bpy.context).pairs
    assert check_scene(bpy.context, EditSettings(roles={"Two": "ignored"})).pairs == ()
    assert check_scene(bpy.context, EditSettings(ignored_pairs=(("Two", "One"),))).pairs == ()


def test_read_surface_knows_its_objects() -> None:
    add_cube("One", (1, 2, 3), scale=(2, 2, 2))
    add_grid("Two", 2)
    assembly = read_surface(bpy.context)
    assert assembly.positions.shape == (17, 3)
    assert [body.name for body in assembly.surface.bodies] == ["One", "Two"]
    assert assembly.face(12) == Element("Two", "face", 0)
    assert assembly.positions[:8].mean(axis=0).tolist() == [1, 2, 3]


def test_each_pair_of_faces_is_listed_once_with_its_pairs_of_triangles() -> None:
    add_cube("One")
    add_cube("Two", (0.5, 0.4, 0.3))
    assembly, found = read_surface(bpy.context), check_scene(bpy.context)
    triangles = stiv.find_intersections(assembly.positions, assembly.surface)
    faces = {frozenset((assembly.face(a), assembly.face(b))) for a, b in triangles.tolist()}
    assert len(found.pairs) == len(faces) < len(triangles) == found.triangle_pairs
    assert {frozenset((pair.first, pair.second)) for pair in found.pairs} == faces


def test_both_counts_are_in_the_operators_summary_the_report_and_the_baseline(tmp_path: Path, capsys) -> None:
    add_cube("One")
    add_cube("Two", (0.5, 0.4, 0.3))
    found = check_scene(bpy.context)
    scene, report, baseline = (str(tmp_path / name) for name in ("scene.blend", "report.json", "known.json"))
    save_blend(Path(scene))
    assert program.run(["check", scene, "--json", report]) == 4
    count = f"{len(found.pairs)} intersecting pairs, {found.triangle_pairs} of triangles"
    assert f"scene.blend: {count} (" in capsys.readouterr().out
    (file,) = json.loads(Path(report).read_text())["files"]
    assert (file["intersections"], file["triangle_pairs"]) == (len(found.pairs), found.triangle_pairs)
    assert sum(pair["triangle_pairs"] for pair in file["pairs"]) == found.triangle_pairs
    known = {"file": "scene.blend", "objects": ["One", "Two"], "kind": "intersection", "pairs": found.triangle_pairs}
    Path(baseline).write_text(json.dumps({"schema": "stiv-baseline", "version": 1, "accepted": [known]}))
    assert program.run(["check", scene, "--baseline", baseline]) == 0  # of 0.1.0, which counted pairs of triangles
