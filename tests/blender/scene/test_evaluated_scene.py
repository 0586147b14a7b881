# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading of scenes against a plain loop over Blender's evaluated objects."""

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, add_modifier, edit_mode, evaluated, mesh

import stiv
from stiv.blender.scene.evaluated_scene import read_positions_of, read_scene
from stiv.blender.scene.open_evaluations import OpenEvaluations


def owners() -> list[str]:
    return [mesh.owner.name for mesh in read_scene(bpy.context).meshes]


def only(name: str) -> object:
    (found,) = [mesh for mesh in read_scene(bpy.context).meshes if mesh.owner.name == name]
    return found


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("levels", [0, 2])
def test_positions_are_blenders(mode: str, levels: int) -> None:
    parent = add("Parent", None, (1, 2, 3), rotation_euler=(0.1, 0.2, 0.3), scale=(1, -2, 0.5))
    ob = add_grid("Grid with ü", 3, parent=parent, rotation_euler=(1, 0, 0))
    if levels:
        add_modifier(ob, "SUBSURF", levels=levels)
    if mode == "EDIT":
        edit_mode(ob)
    read = only("Grid with ü")
    assert np.abs(read.world() - evaluated(ob)).max() < 1e-6
    assert len(read.triangles) == 2 * 9 * 4**levels
    assert sorted(set(read.faces.tolist())) == list(range(9 * 4**levels))


def test_loose_edges_keep_their_numbers() -> None:
    add("Wire", mesh("Wire", [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 5), (9, 9, 9)], [(0, 1, 2)], [(2, 3)]))
    read = only("Wire")
    assert read.loose_edges.tolist() == [[2, 3]]
    data = bpy.data.meshes["Wire"]
    assert sorted(data.edges[int(read.loose_numbers[0])].vertices) == [2, 3]
    assert len(read.local) == 5


def test_curves_text_surfaces_and_metaballs_come_as_meshes() -> None:
    curve = bpy.data.curves.new("Curve", "CURVE")
    curve.bevel_depth = 0.1
    curve.splines.new("POLY").points.add(2)
    for index, point in enumerate(curve.splines[0].points):
        point.co = (index, 0, 0, 1)
    add("Curve", curve)
    text = bpy.data.curves.new("Text", "FONT")
    text.body = "ab"
    add("Text", text)
    ball = bpy.data.metaballs.new("Ball")
    ball.elements.new()
    add("Ball", ball)
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    read = {mesh.owner.name: mesh for mesh in read_scene(bpy.context).meshes}
    assert sorted(read) == ["Ball", "Curve", "SurfSphere", "Text"]
    assert all(len(mesh.triangles) and not mesh.is_instance for mesh in read.values())


def test_collection_instances_are_placed_as_shown() -> None:
    collection = bpy.data.collections.new("Inner")
    inner = bpy.data.objects.new("Inner", mesh("Inner", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]))
    inner.location = (0, 0, 1)
    collection.objects.link(inner)
    for x in (10, 20):
        add(f"Instancer {x}", None, (x, 0, 0), instance_type="COLLECTION", instance_collection=collection)
    read = read_scene(bpy.context).meshes
    assert [(mesh.owner.name, mesh.source, mesh.is_instance) for mesh in read] == [
        ("Instancer 10", "Inner", True),
        ("Instancer 20", "Inner", True),
    ]
    assert read[1].world()[0] == pytest.approx([20, 0, 1])


def test_vertex_instances_hide_or_show_their_instancer() -> None:
    carrier = add_grid("Carrier", 1, instance_type="VERTS")
    add_cube("Seed", size=0.1, parent=carrier)
    carrier.show_instancer_for_viewport = False
    bpy.context.view_layer.update()
    names = owners()
    assert names.count("Carrier") == 4
    carrier.show_instancer_for_viewport = True
    bpy.context.view_layer.update()
    assert owners().count("Carrier") == 5


def test_hidden_and_excluded_objects_are_counted_not_read() -> None:
    add_cube("Shown")
    add_cube("Hidden").hide_set(True)
    add_cube("Disabled").hide_viewport = True
    away = bpy.data.collections.new("Away")
    bpy.context.scene.collection.children.link(away)
    away.objects.link(bpy.data.objects.new("Excluded", bpy.data.meshes["Shown"]))
    bpy.context.view_layer.layer_collection.children["Away"].exclude = True
    bpy.context.view_layer.update()
    scene = read_scene(bpy.context)
    assert [mesh.owner.name for mesh in scene.meshes] == ["Shown"]
    assert scene.hidden == 3


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_coordinates_that_are_not_finite_are_named(value: float) -> None:
    points = add_cube("Böx 1").data.vertices
    values = np.array([tuple(point.co) for point in points], np.float32)
    values[5, 1] = value
    points.foreach_set("co", values.ravel())
    bpy.data.meshes["Böx 1"].update()
    bpy.context.view_layer.update()
    with pytest.raises(stiv.InputError, match="Böx 1: vertex 5 has a coordinate that is not finite; delete it"):
        read_scene(bpy.context)


def test_positions_alone_come_in_the_same_order() -> None:
    add_cube("B", (3, 0, 0))
    add_grid("A", 2)
    scene = read_scene(bpy.context)
    placed = read_positions_of(frozenset(mesh.owner.session_uid for mesh in scene.meshes), OpenEvaluations(bpy.context))
    assert [each.owner for each in placed] == [mesh.owner for mesh in scene.meshes]
    for one, other in zip(placed, scene.meshes, strict=True):
        assert np.array_equal(one.world(), other.world())
