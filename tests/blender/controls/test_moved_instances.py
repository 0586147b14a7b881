# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that show instances, and surfaces that Blender makes itself: moved as a whole, and as obstacles."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, add_modifier, edit_mode, evaluated, select, shift, turn
from mathutils import Vector
from oracles import rational

import stiv
from stiv.blender import BlenderEdit, EditSettings

SHOWN_TYPES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


def add_nodes(ob: Any, make: Any) -> None:
    """Geometry Nodes that show an instance on each vertex, and the mesh; `make` gives its socket."""
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    scatter, both = tree.nodes.new("GeometryNodeInstanceOnPoints"), tree.nodes.new("GeometryNodeJoinGeometry")
    tree.links.new(start.outputs[0], scatter.inputs["Points"])
    tree.links.new(make(tree), scatter.inputs["Instance"])
    for output in (scatter.outputs[0], start.outputs[0]):
        tree.links.new(output, both.inputs[0])
    tree.links.new(both.outputs[0], end.inputs[0])
    add_modifier(ob, "NODES", "Scatter").node_group = tree
    bpy.context.view_layer.update()


def small_cube(tree: Any) -> Any:
    node = tree.nodes.new("GeometryNodeMeshCube")
    node.inputs["Size"].default_value = (0.4, 0.4, 0.4)
    return node.outputs["Mesh"]


def other_object(tree: Any, space: str = "ORIGINAL") -> Any:
    node = tree.nodes.new("GeometryNodeObjectInfo")
    node.inputs["Object"].default_value = add_cube("Source", (30, 0, 0), 0.2)
    node.transform_space = space
    return node.outputs["Geometry"]


def other_collection(tree: Any) -> Any:
    node = tree.nodes.new("GeometryNodeCollectionInfo")
    node.inputs["Collection"].default_value = collection_of_props()
    return node.outputs[0]


def collection_of_props() -> Any:
    collection = bpy.data.collections.new("Props")
    source = bpy.data.objects.new("Prop", add_cube("Model", (50, 0, 0), 0.2).data)
    source.rotation_euler = (0.3, 0.4, 0.5)
    collection.objects.link(source)
    return collection


def show(collection: Any) -> Any:
    return add("Piece", None, (0, 0, 2), instance_type="COLLECTION", instance_collection=collection)


def nested_collection() -> Any:
    outer = bpy.data.collections.new("Outer")
    inner = bpy.data.objects.new("Inner", None)
    inner.instance_type, inner.instance_collection, inner.location = "COLLECTION", collection_of_props(), (0.2, 0, 0)
    outer.objects.link(inner)
    return show(outer)


def sheet() -> Any:
    return add_grid("Piece", 2, 1.0, (0, 0, 2))


def scattered(make: Any) -> Any:
    piece = sheet()
    add_nodes(piece, make)
    return piece


def parent(kind: str) -> Any:
    piece = sheet()
    add_cube("Child", (0, 0, 0), 0.2, parent=piece)
    piece.instance_type = kind
    bpy.context.view_layer.update()
    return piece


def particles() -> Any:
    piece, source = sheet(), add_cube("Source", (30, 0, 0), 0.3)
    piece.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = piece.particle_systems[0].settings
    settings.type, settings.count, settings.render_type, settings.instance_object = "HAIR", 10, "OBJECT", source
    bpy.context.view_layer.update()
    return piece


def text() -> Any:
    data = bpy.data.curves.new("Text", "FONT")
    data.body, data.extrude, data.size = "a", 0.1, 3
    return add("Piece", data, (-0.6, -0.6, 2))


def metaball() -> Any:
    data = bpy.data.metaballs.new("Piece")
    data.resolution, data.render_resolution = 0.3, 0.2
    data.elements.new()
    return add("Piece", data, (0, 0, 3))


def multires() -> Any:
    """Two levels, of which the viewport shows one."""
    piece = sheet()
    modifier = add_modifier(piece, "MULTIRES")
    select(piece)
    for _ in range(2):
        bpy.ops.object.multires_subdivide(modifier=modifier.name)
    modifier.levels = 1
    bpy.context.view_layer.update()
    return piece


MOVERS = {
    "collection": lambda: show(collection_of_props()),
    "nested collection": nested_collection,
    "nodes alone": lambda: scattered(small_cube),
    "nodes with an object": lambda: scattered(other_object),
    "nodes with a collection": lambda: scattered(other_collection),
    "vertices": lambda: parent("VERTS"),
    "faces": lambda: parent("FACES"),
    "particles": particles,
    "text": text,
    "multires": multires,
}


def shown() -> dict[str, Any]:
    """World positions of all triangles that each object shows, instances included, (t, 3, 3)."""
    found: dict[str, list[Any]] = {}
    for each in bpy.context.evaluated_depsgraph_get().object_instances:
        if each.object.type in SHOWN_TYPES and (each.is_instance or each.show_self):
            owner = (each.parent if each.is_instance else each.object).original.name
            mesh = each.object.to_mesh()
            if mesh is not None:
                mesh.calc_loop_triangles()
                points = np.array([each.matrix_world @ vertex.co for vertex in mesh.vertices]).reshape(-1, 3)
                corners = np.array([list(t.vertices) for t in mesh.loop_triangles], int).reshape(-1, 3)
                found.setdefault(owner, []).append(points[corners])
                each.object.to_mesh_clear()
    return {name: np.concatenate(each) for name, each in found.items()}


def meet(first: str, second: str) -> bool:
    """Do any of their triangles meet, in exact arithmetic?"""
    bpy.context.view_layer.update()
    surfaces = shown()
    one, two = surfaces[first], surfaces[second]
    low, high = np.maximum(one.min(1)[:, None], two.min(1)), np.minimum(one.max(1)[:, None], two.max(1))
    near = np.argwhere((low <= high).all(axis=2))
    return any(rational.triangles_intersect((0, 1, 2), (3, 4, 5), np.vstack([one[a], two[b]])) for a, b in near)


def add_body() -> Any:
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, location=(0.2, 0.1, -0.3))
    bpy.context.object.name = "Body"
    return bpy.context.object


@pytest.mark.parametrize(("kind", "moved"), [*((kind, "Piece") for kind in MOVERS), *((k, "Body") for k in MOVERS)])
def test_it_moves_as_a_whole_and_is_an_obstacle(kind: str, moved: str) -> None:
    body, piece = add_body(), MOVERS[kind]()
    slide_against(body if moved == "Body" else piece, -1 if moved == "Piece" else 1)


def test_metaballs_are_obstacles() -> None:
    body = add_body()
    metaball()
    slide_against(body, 1)


def slide_against(ob: Any, direction: int) -> None:
    """Move an object past the other one: it keeps its shape and slides along. Without the edit, they would meet."""
    select(ob)
    start, scenes, way = (
        shown()[ob.name],
        bpy.data.scenes.keys(),
        [(0.1 * k, 0.05 * k, direction * k) for k in (1, 2, 3)],
    )
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    for step in way:
        edit.drag(shift(*step))
        assert edit.write().passed
        assert not meet("Piece", "Body")
    change = shown()[ob.name] - start
    assert np.ptp(change, axis=(0, 1)).max() < 1e-4
    assert np.abs(change[..., 2]).max() > 0.3
    assert bpy.data.scenes.keys() == scenes
    edit.restore()
    place = ob.location.copy()
    found = []
    for step in way:
        ob.location = place + Vector(step)
        found.append(meet("Piece", "Body"))
    assert any(found)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_multires_deforms_at_the_level_shown_and_that_of_the_render(mode: str) -> None:
    piece = multires()
    add_body()
    select(piece) if mode == "OBJECT" else edit_mode(piece)
    if mode == "EDIT":
        bpy.ops.mesh.select_all(action="SELECT")
    start = np.array([vertex.co for vertex in piece.data.vertices])
    edit = BlenderEdit.begin(bpy.context, EditSettings(object_response="deform"), "move")
    edit.apply(shift(0.1, 0, -2))
    assert edit.write().passed
    bpy.ops.object.mode_set(mode="OBJECT")
    change = np.array([vertex.co for vertex in piece.data.vertices]) - start
    assert change[:, 2].min() < -1 and np.ptp(change[:, 2]) > 0.1
    for levels in (1, 2):
        piece.modifiers[0].levels = levels
        assert len(evaluated(piece)) == (4 * 2**levels // 2 + 1) ** 2
        assert not meet("Piece", "Body")


def test_vertices_that_carry_instances_are_refused_until_the_nodes_realize_them() -> None:
    """Realized, the instances deform with the sheet."""
    piece = scattered(other_object)
    add_body()
    select(piece)
    deform = EditSettings(object_response="deform")
    with pytest.raises(stiv.InputError, match='" shows instances; realize them'):
        BlenderEdit.begin(bpy.context, deform, "move")
    tree = piece.modifiers[0].node_group
    realize, scatter, both = tree.nodes.new("GeometryNodeRealizeInstances"), *tree.nodes[2:4]
    tree.links.remove(scatter.outputs[0].links[0])
    tree.links.new(scatter.outputs[0], realize.inputs[0])
    tree.links.new(realize.outputs[0], both.inputs[0])
    bpy.context.view_layer.update()
    count = len(evaluated(piece))
    edit = BlenderEdit.begin(bpy.context, deform, "move")
    edit.apply(shift(0.1, 0, -2))
    assert edit.write().passed
    assert count == len(evaluated(piece)) == 9 + 9 * 8
    assert not meet("Piece", "Body")


def test_nodes_that_do_not_move_along_are_refused_by_name() -> None:
    grid = add_grid("Grid", 2)
    add_nodes(grid, lambda tree: other_object(tree, "RELATIVE"))
    select(grid)
    start = evaluated(grid)
    with pytest.raises(stiv.InputError, match='Grid: Geometry Nodes "Scatter" depends on "Source"; select both'):
        BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert (evaluated(grid) == start).all()
    assert [scene.name for scene in bpy.data.scenes] == ["Scene"]


def self_reading(what: str) -> Any:
    """A sheet with Geometry Nodes that read the location or the scale of their own object."""
    piece = sheet()
    tree = bpy.data.node_groups.new("Own", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    own, info, place = (tree.nodes.new(f"GeometryNode{kind}") for kind in ("SelfObject", "ObjectInfo", "SetPosition"))
    tree.links.new(own.outputs[0], info.inputs["Object"])
    tree.links.new(start.outputs[0], place.inputs["Geometry"])
    tree.links.new(info.outputs[what], place.inputs["Offset"])
    tree.links.new(place.outputs[0], end.inputs[0])
    add_modifier(piece, "NODES", "Own").node_group = tree
    select(piece)
    return piece


@pytest.mark.parametrize(("kind", "reads"), [("scale", "Scale"), ("move", "Location")])
def test_nodes_that_read_the_own_transform_are_refused_at_the_start(kind: str, reads: str) -> None:
    self_reading(reads)
    with pytest.raises(stiv.InputError) as refused:
        BlenderEdit.begin(bpy.context, EditSettings(), kind)
    assert str(refused.value) == 'Piece: Geometry Nodes "Own" depends on its transform; apply it'
    assert "STIV Evaluation" not in bpy.data.scenes


@pytest.mark.parametrize(("kind", "reads"), [("move", "Scale"), ("rotate", "Scale"), ("rotate", "Location")])
def test_nodes_that_read_another_property_do_not_hinder_an_edit(kind: str, reads: str) -> None:
    self_reading(reads)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), kind)
    motion = shift(z=1) if kind == "move" else turn(0.3, "Z", (0, 0, 2))
    assert edit.apply(motion).status == "reached" and edit.write().passed
