# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that show instances, moved as a whole: the instances move along and stay free."""

from typing import Any

import bpy
import pytest
from building import add, add_cube, add_grid, add_modifier, evaluated, select, shift

import stiv
from stiv.blender import BlenderEdit, EditSettings, check_scene


def add_nodes(ob: Any, source: Any, space: str = "ORIGINAL") -> None:
    """Geometry Nodes that show an object on each vertex, or a small cube."""
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    scatter = tree.nodes.new("GeometryNodeInstanceOnPoints")
    if source is None:
        shown = tree.nodes.new("GeometryNodeMeshCube")
        shown.inputs["Size"].default_value = (0.4, 0.4, 0.4)
    else:
        shown = tree.nodes.new("GeometryNodeObjectInfo")
        shown.inputs["Object"].default_value = source
        shown.transform_space = space
    tree.links.new(start.outputs[0], scatter.inputs["Points"])
    tree.links.new(shown.outputs["Mesh" if source is None else "Geometry"], scatter.inputs["Instance"])
    tree.links.new(scatter.outputs[0], end.inputs[0])
    add_modifier(ob, "NODES", "Scatter").node_group = tree
    bpy.context.view_layer.update()


def collection_instance() -> Any:
    collection = bpy.data.collections.new("Props")
    source = bpy.data.objects.new("Prop", add_cube("Model", (50, 0, 0), 0.2).data)
    collection.objects.link(source)
    return add("Instancer", None, (0, 0, 3), instance_type="COLLECTION", instance_collection=collection)


def nodes_alone() -> Any:
    grid = add_grid("Grid", 2, 1.0, (0, 0, 3))
    add_nodes(grid, None)
    return grid


def nodes_with_an_object() -> Any:
    grid = add_grid("Grid", 2, 1.0, (0, 0, 3))
    add_nodes(grid, add_cube("Source", (30, 0, 0), 0.2))
    return grid


def faces_of_a_parent() -> Any:
    parent = add_grid("Parent", 2, 1.0, (0, 0, 3))
    add_cube("Child", (0, 0, 0), 0.2, parent=parent)
    parent.instance_type = "FACES"
    parent.show_instancer_for_viewport = parent.show_instancer_for_render = False
    bpy.context.view_layer.update()
    return parent


@pytest.mark.parametrize("make", [collection_instance, nodes_alone, nodes_with_an_object, faces_of_a_parent])
def test_what_shows_instances_moves_as_a_whole(make: Any) -> None:
    """The instances end above the floor, and not a minimum distance of their size above it."""
    add_grid("Floor", 3, 9.0)
    ob = make()
    select(ob)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.apply(shift(0.1, 0, -5))
    assert edit.write().passed
    assert 0.2 < ob.location.z < 0.22
    assert check_scene(bpy.context).pairs == ()
    ob.location.z -= 0.05
    bpy.context.view_layer.update()
    assert check_scene(bpy.context).pairs


def test_nodes_that_do_not_move_along_are_refused_by_name() -> None:
    grid = add_grid("Grid", 2)
    add_nodes(grid, add_cube("Source", (30, 0, 0), 0.2), "RELATIVE")
    select(grid)
    start = evaluated(grid)
    with pytest.raises(stiv.InputError, match='Grid: modifier "Scatter" depends on "Source"; select both'):
        BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert (evaluated(grid) == start).all()
    assert [scene.name for scene in bpy.data.scenes] == ["Scene"]
