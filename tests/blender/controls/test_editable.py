# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that cannot be edited: the messages of refusals, which leave the scene unchanged."""

from pathlib import Path
from typing import Any

import bpy
import pytest
from building import add, add_cube, add_grid, add_lattice, add_modifier, edit_mode, mesh, select, snapshot

import stiv
from stiv.blender import BlenderEdit, EditSettings, check_scene

RIGID, DEFORM = EditSettings(), EditSettings(object_response="deform")


def refused(pattern: str, settings: EditSettings = RIGID, kind: str = "move") -> None:
    before = snapshot()
    with pytest.raises(stiv.InputError, match=pattern) as raised:
        BlenderEdit.begin(bpy.context, settings, kind)
    assert len(str(raised.value)) <= 80
    assert snapshot() == before


def accepted(settings: EditSettings = RIGID, kind: str = "move") -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, settings, kind)


def test_nothing_selected() -> None:
    add_cube("Cube")
    select()
    refused("nothing movable is selected")


def test_nothing_selected_in_edit_mode() -> None:
    edit_mode(add_cube("Cube"))
    bpy.ops.mesh.select_all(action="DESELECT")
    refused("nothing movable is selected")


def test_lights_have_no_surface() -> None:
    select(add("Light", bpy.data.lights.new("Light", "POINT")))
    refused("Light: no surface; also select an object that has one")


def test_modes_without_controls() -> None:
    select(add_cube("Cube"))
    bpy.ops.object.mode_set(mode="SCULPT")
    refused("mode Sculpt is not supported")


def test_text_and_curves_without_a_surface_have_no_controls() -> None:
    text, curve = add("Text", bpy.data.curves.new("Text", "FONT")), add("Curve", bpy.data.curves.new("Curve", "CURVE"))
    select(text, curve, add_cube("Cube"))
    refused("Text: a text has no controls", EditSettings(roles={"Text": "controls"}))
    refused("Curve: has no surface that deforms", EditSettings(roles={"Curve": "controls"}))


def test_unknown_names_in_settings() -> None:
    select(add_cube("Cube"))
    refused("Nobody: ", EditSettings(roles={"Nobody": "rigid"}))
    refused("Nobody: ", EditSettings(ignored_pairs=(("Cube", "Nobody"),)))


@pytest.mark.parametrize("choice", [{"responders": "x"}, {"object_response": "x"}, {"roles": {"a": "x"}}])
def test_unknown_choices(choice: dict[str, Any]) -> None:
    with pytest.raises(stiv.InputError, match="'x' is none of"):
        EditSettings(**choice)


def test_unknown_kind() -> None:
    select(add_cube("Cube"))
    refused("kind", kind="shear")


def test_keyed_placement() -> None:
    """It may move as with Blender's own tools, and the render shows the keyframes. It does not yield."""
    cube, other = add_cube("Cube"), add_cube("Other", (3, 0, 0))
    cube.keyframe_insert("location", frame=1)
    select(cube)
    accepted()
    accepted(DEFORM)
    select(other)
    refused("Cube: its transform is animated; clear the animation", EditSettings(roles={"Cube": "rigid"}))


def test_driven_placement() -> None:
    cube = add_cube("Cube")
    cube.driver_add("rotation_euler", 2)
    select(cube)
    refused("Cube: its transform is driven; delete the drivers")


def test_animation_of_other_properties_is_accepted() -> None:
    cube = add_cube("Cube")
    cube.keyframe_insert("hide_render", frame=1)
    select(cube)
    accepted()


def test_constraint() -> None:
    cube = add_cube("Cube")
    constraint = cube.constraints.new("LIMIT_LOCATION")
    constraint.name = "Hold"
    select(cube)
    refused('Cube: constraint "Hold" determines its transform; disable it')
    constraint.mute = True
    accepted()


def test_constraint_of_a_child() -> None:
    cube = add_cube("Cube")
    add_cube("Child", (3, 0, 0), parent=cube).constraints.new("LIMIT_LOCATION")
    select(cube)
    refused("Child: constraint")


@pytest.mark.parametrize("settings", [RIGID, DEFORM], ids=["rigid", "deform"])
def test_zero_scale(settings: EditSettings) -> None:
    select(add_cube("Cube", scale=(1, 0, 1)))
    refused("Cube: its scale is zero; change it", settings)


def test_shared_lattice() -> None:
    lattice = add_lattice("Lattice", (2, 2, 2))
    add("Twin", lattice.data, (5, 0, 0))
    add_modifier(add_cube("Cube"), "LATTICE", object=lattice)
    select(lattice)
    refused('Lattice: its lattice is shared with "Twin"; make it single user', DEFORM)


def test_linked_and_overridden_data(tmp_path: Path) -> None:
    cube = add_cube("Linked")
    path = str(tmp_path / "library ü.blend")
    bpy.data.libraries.write(path, {cube})
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.objects = ["Linked"]
    (linked,) = wanted.objects
    bpy.context.collection.objects.link(linked)
    select(linked)
    refused("Linked: it is linked; make a library override of it")
    refused("Linked: its mesh is linked from another file", DEFORM)
    select(add_cube("Own", (5, 0, 0)))
    assert [each.role for each in accepted().summary.participants if each.name == "Linked"] == ["obstacle"]
    override = linked.override_create()
    bpy.context.collection.objects.link(override)
    bpy.context.collection.objects.unlink(linked)
    select(override)
    accepted()
    refused("Linked: its mesh is linked from another file; make it local", DEFORM)


def test_metaballs() -> None:
    ball = bpy.data.metaballs.new("Ball")
    ball.elements.new()
    select(add("Ball", ball))
    refused("Ball: metaballs cannot move; convert it to a mesh")


def test_lattice_that_deforms_nothing() -> None:
    select(add_lattice("Lattice", (2, 2, 2)))
    refused("Lattice: the lattice deforms no visible mesh; show one", DEFORM)


def test_lattice_with_shape_keys_or_modifiers() -> None:
    lattice = add_lattice("Lattice", (2, 2, 2))
    add_modifier(add_cube("Cube"), "LATTICE", object=lattice)
    select(lattice)
    add_modifier(lattice, "CAST", "Ball")
    refused('Lattice: .* "Ball" deforms the lattice; apply it', DEFORM)
    lattice.modifiers.clear()
    lattice.shape_key_add(name="Basis")
    refused("Lattice: its shape keys", DEFORM)


def test_lattice_moved_away_from_its_mesh() -> None:
    cube, lattice = add_cube("Cube"), add_lattice("Lattice", (2, 2, 2))
    add_modifier(cube, "LATTICE", "Bend", object=lattice)
    select(cube)
    accepted()
    accepted(kind="rotate")
    select(lattice)
    accepted()
    select(cube, lattice)
    accepted()
    refused('Cube: moves, and so does its lattice "Lattice"; deselect one', DEFORM)


def test_objects_that_modifiers_refer_to() -> None:
    cube, other = add_cube("Cube"), add_cube("Other", (5, 0, 0))
    add_modifier(other, "BOOLEAN", "Cut", object=cube)
    select(cube)
    accepted()
    refused('Other: Boolean "Cut" depends on "Cube"; disable it', DEFORM)
    other.modifiers[0].show_viewport = False
    refused('Other: Boolean "Cut" depends on "Cube"; disable in renders', DEFORM)
    other.modifiers[0].show_render = False
    accepted()
    accepted(DEFORM)


def test_a_projection_names_a_way_out_for_either_object() -> None:
    target, wrapped = add_cube("Target"), add_cube("Wrapped", (5, 0, 0))
    wrap = add_modifier(wrapped, "SHRINKWRAP", "Wrap", target=target)
    select(wrapped)
    refused('Wrapped: Shrinkwrap "Wrap" projects onto "Target"; edit that', DEFORM)
    select(target)
    accepted()
    bpy.ops.object.mode_set(mode="EDIT")
    refused('Wrapped: Shrinkwrap "Wrap" depends on "Target"; disable it')
    wrap.show_viewport = wrap.show_render = False
    accepted()


def test_objects_inside_geometry_nodes() -> None:
    cube, other = add_cube("Cube"), add_cube("Other", (5, 0, 0))
    tree = bpy.data.node_groups.new("Tree", "GeometryNodeTree")
    node = tree.nodes.new("GeometryNodeObjectInfo")
    node.inputs["Object"].default_value = cube
    add_modifier(other, "NODES", "Look").node_group = tree
    select(cube)
    refused('Other: Geometry Nodes "Look" depends on "Cube"')


def test_inputs_of_geometry_nodes() -> None:
    cube, other = add_cube("Cube"), add_cube("Other", (5, 0, 0))
    tree = bpy.data.node_groups.new("Tree", "GeometryNodeTree")
    socket = tree.interface.new_socket("Object", in_out="INPUT", socket_type="NodeSocketObject")
    modifier = add_modifier(other, "NODES", "Look")
    modifier.node_group = tree
    give(modifier, socket.identifier, cube)
    select(cube)
    refused('Other: Geometry Nodes "Look" depends on "Cube"')


def give(modifier: Any, socket: str, value: Any) -> None:
    """Set an input of geometry nodes, which is a property of the modifier's interface since Blender 5.2."""
    if bpy.app.version >= (5, 2):
        getattr(modifier.properties.inputs, socket).value = value
    else:
        modifier[socket] = value


def test_instanced_objects() -> None:
    cube = add_cube("Cube")
    collection = bpy.data.collections.new("Shared")
    collection.objects.link(cube)
    add("Instancer", None, (9, 0, 0), instance_type="COLLECTION", instance_collection=collection)
    select(cube)
    for settings in (RIGID, DEFORM):
        refused('Cube: "Instancer" instances it', settings)


def test_children_on_vertices() -> None:
    grid = add_grid("Grid", 2)
    add_cube("Rider", (0, 0, 3), 0.1, parent=grid, parent_type="VERTEX")
    select(grid)
    refused('Rider: is parented to vertices of "Grid"', DEFORM)
    accepted()


def test_children_of_moving_objects() -> None:
    parent, child = add_cube("Parent"), add_cube("Child", (5, 0, 0))
    child.parent = parent
    select(parent)
    refused("Child: is deformed, and its parent moves", EditSettings(roles={"Child": "controls"}))
    refused('Child: its parent "Parent" moves too', EditSettings(roles={"Child": "rigid"}))


def test_rotation_below_an_uneven_parent() -> None:
    parent = add("Parent", None, scale=(1, 3, 1))
    child = add_cube("Child", (5, 0, 0), parent=parent, rotation_euler=(0.5, 0.2, 0.1))
    select(child)
    refused("Child: its parent is scaled unevenly", kind="rotate")
    refused("Child: its parent shears it", kind="scale")
    accepted()


def test_obstacles_may_be_anything() -> None:
    select(add_cube("Cube", (0, 0, 9)))
    sheared = add("Parent", None, scale=(1, 3, 1))
    wild = add_cube("Wild", parent=sheared, rotation_euler=(1, 1, 1))
    add_modifier(wild, "BEVEL")
    wild.keyframe_insert("location", frame=1)
    wild.shape_key_add(name="Basis")
    wild.shape_key_add(name="Key")
    flat = add_cube("Flat", (20, 0, 0), scale=(1, 1, 0))
    assert flat.name in {each.name for each in accepted().summary.participants}
    assert check_scene(bpy.context, objects=["Wild"]).pairs == ()


def test_triangles_without_area_are_counted() -> None:
    select(add("Sliver", mesh("Sliver", [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])))
    assert "1 triangle has no area" in accepted().summary.warnings
