# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects are obstacles as long as nothing that they depend on may change in an edit."""

from collections.abc import Callable, Collection
from typing import Any

import bpy
import pytest
from building import add, add_cube, add_modifier, edit_mode, select

from stiv.blender import EditSettings
from stiv.blender.scene import obstacle_choice
from stiv.blender.scene.obstacle_choice import find_obstacles


@pytest.fixture(autouse=True)
def every_scene_is_large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obstacle_choice, "MIN_FACES", 0)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)


def obstacles(*moving: Any, reshaped: Collection[str] = (), settings: EditSettings = EditSettings()) -> set[str]:  # noqa: B008 (frozen)
    bpy.context.view_layer.update()
    return set(find_obstacles(bpy.context, moving, reshaped, settings))


def read_location(owner: Any, path: str, target: Any, expression: str = "") -> Any:
    """A driver of a property that reads the location of an object."""
    driver = owner.driver_add(path, 0).driver if path == "location" else owner.driver_add(path).driver
    variable = driver.variables.new()
    variable.targets[0].id, variable.targets[0].data_path = target, "location.x"
    driver.type, driver.expression = ("SCRIPTED", expression) if expression else ("SUM", "")
    return driver


def nodes(ob: Any) -> Any:
    """The nodes of an object, which show it as it is."""
    tree = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    tree.links.new(tree.nodes.new("NodeGroupInput").outputs[0], tree.nodes.new("NodeGroupOutput").inputs[0])
    add_modifier(ob, "NODES", "Nodes").node_group = tree
    return tree


def in_nodes(ob: Any, used: Any) -> None:
    nodes(ob).nodes.new("GeometryNodeObjectInfo").inputs["Object"].default_value = used


def in_inner_nodes(ob: Any, used: Any) -> None:
    inner = bpy.data.node_groups.new("Inner", "GeometryNodeTree")
    inner.nodes.new("GeometryNodeObjectInfo").inputs["Object"].default_value = used
    nodes(ob).nodes.new("GeometryNodeGroup").node_tree = inner


def in_node_driver(ob: Any, used: Any) -> None:
    node = nodes(ob).nodes.new("GeometryNodeMeshCube")
    node.inputs["Size"].driver_add("default_value", 0).driver.variables.new().targets[0].id = used


def in_collection(ob: Any, used: Any) -> None:
    outer, inner = bpy.data.collections.new("Outer"), bpy.data.collections.new("Inner")
    outer.children.link(inner)
    inner.objects.link(used)
    ob.instance_type, ob.instance_collection = "COLLECTION", outer


def as_particles(ob: Any, used: Any) -> None:
    add_modifier(ob, "PARTICLE_SYSTEM")
    ob.particle_systems[0].settings.type = "HAIR"
    ob.particle_systems[0].settings.instance_object = used


def on_vertices(ob: Any, used: Any) -> None:
    child = add_cube("Child", parent=ob)
    child.constraints.new("COPY_ROTATION").target = used
    ob.instance_type = "VERTS"


def through_armature(ob: Any, used: Any) -> None:
    rig = add("Rig", bpy.data.armatures.new("Rig"))
    select(rig)
    bpy.ops.object.mode_set(mode="EDIT")
    rig.data.edit_bones.new("Bone").tail = (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    rig.pose.bones["Bone"].constraints.new("COPY_LOCATION").target = used
    add_modifier(ob, "ARMATURE").object = rig


def through_targets(ob: Any, used: Any) -> None:
    rig = add("Rig", bpy.data.armatures.new("Rig"), parent=used)
    ob.constraints.new("ARMATURE").targets.new().target = rig


def through_texture(ob: Any, used: Any) -> None:
    texture = bpy.data.textures.new("Texture", "BLEND")
    modifier = add_modifier(ob, "DISPLACE", texture=texture, texture_coords="OBJECT")
    modifier.texture_coords_object = used


def through_shape_key(ob: Any, used: Any) -> None:
    ob.shape_key_add(name="Basis")
    read_location(ob.shape_key_add(name="Key"), "value", used)


def through_custom_property(ob: Any, used: Any) -> None:
    """One driver writes a property of an empty, and another one reads it."""
    between = add("Between", None)
    between["value"] = 0.0
    read_location(between, '["value"]', used)
    variable = ob.driver_add("location", 0).driver.variables.new()
    variable.targets[0].id, variable.targets[0].data_path = between, '["value"]'


TIES: dict[str, Callable[[Any, Any], Any]] = {
    "parent": lambda ob, used: setattr(ob, "parent", used),
    "constraint": lambda ob, used: setattr(ob.constraints.new("COPY_ROTATION"), "target", used),
    "targets": through_targets,
    "mirror": lambda ob, used: add_modifier(ob, "MIRROR", mirror_object=used),
    "array": lambda ob, used: add_modifier(ob, "ARRAY", use_object_offset=True, offset_object=used),
    "driver": lambda ob, used: read_location(ob, "location", used),
    "nodes": in_nodes,
    "inner nodes": in_inner_nodes,
    "driver of a node": in_node_driver,
    "collection": in_collection,
    "particles": as_particles,
    "vertices": on_vertices,
    "bone": through_armature,
    "texture": through_texture,
    "shape key": through_shape_key,
    "custom property": through_custom_property,
}


def add_prop(tie: str) -> Any:
    """A cube, or an empty for a collection."""
    return add("Prop", None) if tie == "collection" else add_cube("Prop")


@pytest.mark.parametrize("tie", TIES)
@pytest.mark.parametrize("links", [0, 1, 2])
def test_an_object_is_an_obstacle_unless_something_that_it_depends_on_moves(tie: str, links: int) -> None:
    """Through any number of parents and constraints."""
    mover, first, prop = add("Mover", None), add("First", None), add_prop(tie)
    TIES[tie](prop, first)
    last = first
    for number in range(links):
        last.parent = add(f"Parent {number}", None)
        last = add(f"Target {number}", None)
        first.parent.constraints.new("COPY_LOCATION").target = last
        first = last
    assert "Prop" in obstacles(mover)
    last.parent = mover
    assert "Prop" not in obstacles(mover)
    assert "Prop" in obstacles(add("Other", None))


@pytest.mark.parametrize("tie", ["collection", "nodes", "vertices"])
def test_instancers_are_obstacles_unless_what_they_show_moves(tie: str) -> None:
    source, ob, mover = add_cube("Source"), add_prop(tie), add_cube("Mover")
    TIES[tie](ob, source)
    children = {"Child"} if tie == "vertices" else set()
    assert obstacles(mover) == {"Prop", "Source"} | children
    assert obstacles(source) == {"Mover"}


def test_instances_on_particles_belong_to_the_surface() -> None:
    source, ob, mover = add_cube("Source"), add_cube("Prop"), add_cube("Mover")
    as_particles(ob, source)
    assert obstacles(mover) == {"Prop", "Source"}
    ob.particle_systems[0].settings.render_type = "OBJECT"
    assert obstacles(mover) == {"Source"}


def script(ob: Any) -> None:
    ob.driver_add("location", 0).driver.expression = "bpy.data.objects['Mover'].location.x"


def script_of_parent(ob: Any) -> None:
    ob.parent = add("Parent", None)
    script(ob.parent)


def scene_driver(ob: Any) -> None:
    target = ob.driver_add("location", 0).driver.variables.new().targets[0]
    target.id_type = "SCENE"
    target.id = bpy.context.scene


def active_camera(ob: Any) -> None:
    nodes(ob).nodes.new("GeometryNodeInputActiveCamera")


def simulation(ob: Any) -> None:
    nodes(ob).nodes.new("GeometryNodeSimulationInput")


def emitter(ob: Any) -> None:
    add_modifier(ob, "PARTICLE_SYSTEM")


def paint(ob: Any) -> None:
    select(ob)
    bpy.ops.object.mode_set(mode="WEIGHT_PAINT")


def metaball_in_collection(ob: Any) -> None:
    ball = bpy.data.objects.new("Meta", bpy.data.metaballs.new("Meta"))
    empty = add("Instances", None)
    in_collection(empty, ball)
    ob.parent = empty


@pytest.mark.parametrize(
    "spoil",
    [
        *(script, script_of_parent, scene_driver, active_camera, simulation, emitter, paint, metaball_in_collection),
        lambda ob: add_modifier(ob, "CLOTH"),
        lambda ob: add_modifier(ob, "SOFT_BODY"),
        lambda ob: ob.constraints.new("FOLLOW_TRACK"),
        lambda ob: edit_mode(ob),
    ],
)
def test_an_object_that_may_change_without_a_reference_belongs_to_the_surface(spoil: Callable[[Any], Any]) -> None:
    mover, prop = add_cube("Mover"), add_cube("Prop")
    assert obstacles(mover) == {"Prop"}
    spoil(prop)
    assert obstacles(mover) == set()


def test_simple_expressions_are_not_scripts() -> None:
    mover, prop, used = add_cube("Mover"), add_cube("Prop"), add("Used", None)
    read_location(prop, "location", used, "var * 2 + frame")
    assert obstacles(mover) == {"Prop"}
    assert obstacles(used) == {"Mover"}


def test_objects_that_share_a_mesh_change_only_if_it_is_reshaped() -> None:
    mover = add_cube("Mover")
    add("Copy", mover.data, (5, 0, 0))
    assert obstacles(mover) == {"Copy"}
    assert obstacles(mover, reshaped={"Mover"}) == set()


def test_objects_that_share_keyframes_belong_to_the_surface() -> None:
    mover, prop = add_cube("Mover"), add_cube("Prop")
    mover.keyframe_insert("location")
    assert obstacles(mover) == {"Prop"}
    prop.animation_data_create().action = mover.animation_data.action
    assert obstacles(mover) == set()


def test_instances_count_as_faces(monkeypatch: pytest.MonkeyPatch) -> None:
    mover = add_cube("Mover")
    source = bpy.data.objects.new("Source", mover.data)
    monkeypatch.setattr(obstacle_choice, "MIN_FACES", 6 * 20)
    ob = add("Instances", None)
    in_collection(ob, source)
    for number in range(18):
        add(f"Instances {number}", None, instance_type="COLLECTION", instance_collection=ob.instance_collection)
    assert obstacles(mover) == set()
    add("One more", None, instance_type="COLLECTION", instance_collection=ob.instance_collection)
    assert len(obstacles(mover)) == 20


def test_an_object_that_a_guarded_render_may_show_differently_belongs_to_the_surface() -> None:
    mover, source = add_cube("Mover"), bpy.data.objects.new("Source", bpy.data.meshes.new("Source"))
    ob, mirrored = add("Instances", None), add_cube("Mirrored")
    in_collection(ob, source)
    centre = add("Centre", None)
    add_modifier(mirrored, "MIRROR", mirror_object=centre)
    both, viewport = EditSettings(guard="both"), EditSettings(guard="viewport")
    all_of_them = {"Instances", "Mirrored"}
    assert obstacles(mover, settings=both) == all_of_them
    centre.hide_render = True  # it is an empty
    assert obstacles(mover, settings=both) == all_of_them
    source.hide_render = True
    assert obstacles(mover, settings=both) == {"Mirrored"}
    assert obstacles(mover, settings=viewport) == all_of_them
    source.hide_render = False
    bpy.data.collections["Inner"].hide_render = True
    assert obstacles(mover, settings=both) == {"Mirrored"}
    bpy.data.collections["Inner"].hide_render = False
    assert obstacles(mover, settings=both) == all_of_them
    modifier = add_modifier(source, "SUBSURF", levels=0, render_levels=1)
    assert obstacles(mover, settings=both) == {"Mirrored"}
    source.modifiers.remove(modifier)
    centre.parent = source
    assert obstacles(mover, settings=both) == all_of_them
