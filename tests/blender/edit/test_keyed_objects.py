# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects whose transform has keyframes move as with Blender's own tools: until the frame changes, or keyed."""

from itertools import pairwise
from typing import Any

import bpy
import numpy as np
import pytest
from building import add_cube, add_lattice, add_modifier, cube_above_floor, edit_mode, evaluated, select, shift, turn

import stiv
from stiv.blender import BlenderEdit, EditSettings, check_scene, drop, separate


def keyed_cube() -> Any:
    """A cube above a floor, with keyframes at frames 1 and 20, at frame 1."""
    cube = cube_above_floor()
    cube.keyframe_insert("location", frame=20)
    cube.keyframe_insert("location", frame=1)
    bpy.context.scene.frame_set(1)
    select(cube)
    return cube


def lowered() -> BlenderEdit:
    """An edit that lowers the selection through the floor."""
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert edit.drag(shift(z=-3.0)).status == "corrected"
    report = edit.write()
    assert report.passed, report.message
    return edit


def posed_rig() -> tuple[Any, Any]:
    """A keyed rig of two bones that bends a cube, in a pose that is not keyed yet; the rig and the cube."""
    bpy.ops.object.armature_add()
    rig = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    other = rig.data.edit_bones.new("Other")
    other.head, other.tail = (0, 0, 1), (0, 0, 2)
    bpy.ops.object.mode_set(mode="OBJECT")
    cube = add_cube("Cube")
    for name, vertices in zip(("Bone", "Other"), ((0, 2, 4, 6), (1, 3, 5, 7)), strict=True):
        cube.vertex_groups.new(name=name).add(vertices, 1.0, "REPLACE")
    add_modifier(cube, "ARMATURE", object=rig)
    cube.parent = rig
    for bone in rig.pose.bones:
        bone.rotation_mode = "XYZ"
        bone.keyframe_insert("rotation_euler", frame=1)
        bone.rotation_euler.x = 0.4
    bpy.context.view_layer.update()
    return rig, cube


def pose_of(rig: Any) -> list[float]:
    return [bone.rotation_euler.x for bone in rig.pose.bones]


@pytest.mark.parametrize("kind", ["vertices", "object", "rig"])
def test_a_pose_that_is_not_keyed_yet_stays(kind: str) -> None:
    """Blender evaluates copies with the keyframes, and resets animated objects on which these depend."""
    rig, cube = posed_rig()
    pose, shape = pose_of(rig), evaluated(cube)
    select(rig if kind == "rig" else cube)
    if kind == "vertices":
        edit_mode(cube)
        bpy.ops.mesh.select_all(action="SELECT")
    if kind == "rig":
        bpy.ops.object.mode_set(mode="POSE")
        rig.data.bones.active = rig.data.bones["Other"]
        chosen = rig.pose.bones["Other"]
        (chosen if bpy.app.version >= (5, 0, 0) else chosen.bone).select = True
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "rotate" if kind == "rig" else "move")
    goal = turn(0.1, "Y", rig.pose.bones["Other"].head) if kind == "rig" else shift(z=0.2)
    assert edit.apply(goal).status == "reached" and edit.write().passed
    bpy.context.view_layer.update()
    assert pose_of(rig)[0] == pose[0] and pose_of(rig)[1] == (pose[1] if kind != "rig" else pytest.approx(0.4, abs=0.1))
    edit.restore()
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()
    np.testing.assert_allclose(evaluated(cube), shape, atol=1e-6)
    assert pose_of(rig) == pose


def test_a_value_of_a_shape_key_that_is_not_keyed_yet_stays() -> None:
    """A lattice bends a cube, and its shape key has a keyframe and another value."""
    lattice, cube = add_lattice("Lattice", (2, 2, 2), scale=(3, 3, 3)), add_cube("Cube")
    lattice.shape_key_add(name="Basis")
    key = lattice.shape_key_add(name="Taller")
    for point in key.data:
        point.co.z *= 2
    key.keyframe_insert("value", frame=1)
    key.value = 0.5
    add_modifier(cube, "LATTICE", object=lattice)
    add_modifier(cube, "CAST", factor=0.2)
    bpy.context.view_layer.update()
    before = evaluated(cube)
    select(cube)
    edit_mode(cube)
    bpy.ops.mesh.select_all(action="SELECT")
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert edit.apply(shift(z=0.1)).status == "reached" and edit.write().passed
    assert key.value == 0.5
    edit.restore()
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()
    np.testing.assert_allclose(evaluated(cube), before, atol=1e-6)


@pytest.mark.parametrize("guard", ["auto", "both"])
def test_the_cage_of_an_object_with_an_unkeyed_place_is_guarded_there(guard: str) -> None:
    cube = keyed_cube()
    add_modifier(cube, "SUBSURF", levels=0, render_levels=1)
    cube.location.z += 1
    bpy.context.view_layer.update()
    edit_mode(cube)
    bpy.ops.mesh.select_all(action="SELECT")
    edit = BlenderEdit.begin(bpy.context, EditSettings(guard=guard), "move")
    assert edit.guard.choice == "both" and edit.apply(shift(z=-5.0)).status != "reached" and edit.write().passed
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()
    assert 0 < lowest(cube) < 0.1 and cube.location.z == 3


@pytest.mark.parametrize("driven", ["shape key", "material"])
def test_an_object_that_drivers_read_keeps_a_place_that_is_not_keyed_yet(driven: str) -> None:
    cube, other = keyed_cube(), add_cube("Other", (9, 0, 0))
    other.shape_key_add(name="Basis")
    key, material = other.shape_key_add(name="Same"), bpy.data.materials.new("Material")
    other.data.materials.append(material)
    owner, path = (key, "value") if driven == "shape key" else (material, "roughness")
    driver = owner.driver_add(path).driver
    variable = driver.variables.new()
    variable.type, driver.expression = "TRANSFORMS", variable.name
    variable.targets[0].id = cube
    for ob in (cube, other):
        add_modifier(ob, "SUBSURF", levels=0, render_levels=1)
    cube.location = (1, 0.2, 3)
    bpy.context.view_layer.update()
    edited = cube if driven == "shape key" else other  # so that the other one shares its data with its copy
    select(edited)
    edit_mode(edited)
    bpy.ops.mesh.select_all(action="SELECT")
    edit = BlenderEdit.begin(bpy.context, EditSettings(guard="both"), "move")
    assert edit.apply(shift(z=0.1)).status == "reached" and edit.write().passed
    edit.restore()
    np.testing.assert_allclose(cube.location, (1, 0.2, 3), atol=1e-6)


@pytest.mark.parametrize("guard", ["viewport", "both"])
def test_values_of_materials_and_nodes_that_are_not_keyed_yet_stay(guard: str) -> None:
    cube, material = add_cube("Cube"), bpy.data.materials.new("Material")
    cube.data.materials.append(material)
    tree = bpy.data.node_groups.new("Lift", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    nodes = [tree.nodes.new(kind) for kind in ("NodeGroupInput", "GeometryNodeSetPosition", "NodeGroupOutput")]
    for first, second in pairwise(nodes):
        tree.links.new(first.outputs[0], second.inputs[0])
    offset = nodes[1].inputs["Offset"]
    for name, value, other in (('A "name"', 0.0, 0.3), ("Three", (0.0, 0.0, 0.0), (1.0, 2.0, 3.0)), ("Whole", 1, 7)):
        material[name] = value
        material.keyframe_insert(f'["{bpy.utils.escape_identifier(name)}"]', frame=1)
        material[name] = other
    for owner, name, value in ((material, "roughness", 0.9), (offset, "default_value", (0, 0, 0.5))):
        owner.keyframe_insert(name, frame=1)
        setattr(owner, name, value)
    add_modifier(cube, "NODES", node_group=tree)
    add_modifier(cube, "SUBSURF", levels=0, render_levels=1)
    select(cube)
    edit_mode(cube)
    bpy.ops.mesh.select_all(action="SELECT")
    edit = BlenderEdit.begin(bpy.context, EditSettings(guard=guard), "move")
    assert edit.apply(shift(z=0.1)).status == "reached" and edit.write().passed
    edit.restore()
    assert material.roughness == pytest.approx(0.9) and tuple(offset.default_value) == (0, 0, 0.5)
    assert material['A "name"'] == 0.3 and tuple(material["Three"]) == (1.0, 2.0, 3.0) and material["Whole"] == 7
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()
    assert evaluated(cube)[:, 2].max() == pytest.approx(1.5)


def lowest(cube: Any) -> float:
    return float(evaluated(cube)[:, 2].min())


@pytest.mark.parametrize("keyed", [False, True])
def test_a_keyed_object_stops_at_contact_and_keeps_its_place_if_keyed(keyed: bool) -> None:
    cube = keyed_cube()
    edit = lowered()
    place = np.array(cube.location)
    assert 0 < lowest(cube) < 0.1 and check_scene(bpy.context).pairs == ()
    assert edit.reset_note == "Cübe A: the next frame resets it to its keyframes; key it"
    if keyed:
        edit.insert_keyframes(bpy.context)
    for frame in (20, 1):
        bpy.context.scene.frame_set(frame)
    np.testing.assert_allclose(cube.location, place if keyed else (0.3, 0, 2), atol=1e-6)
    assert check_scene(bpy.context).pairs == ()


def test_only_changed_properties_are_keyed() -> None:
    cube = keyed_cube()
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "rotate")
    assert edit.drag(turn(0.3, "Z", (0.3, 0, 2))).status == "reached" and edit.write().passed
    edit.insert_keyframes(bpy.context)
    bpy.context.scene.frame_set(20)
    assert cube.rotation_euler.z == pytest.approx(0.3, abs=1e-6)
    np.testing.assert_allclose(cube.location, (0.3, 0, 2), atol=1e-6)
    edit.restore()
    assert tuple(cube.rotation_euler) == (0, 0, 0)


def test_a_keyed_object_that_renders_finer_is_guarded_in_the_viewport() -> None:
    """Its render would show the keyframes, and not what has changed since."""
    cube = keyed_cube()
    add_modifier(cube, "SUBSURF", levels=0, render_levels=1)
    assert lowered().guard.choice == "viewport"


@pytest.mark.parametrize("tool", [drop, lambda context: separate(context, EditSettings())])
def test_tools_that_place_objects_for_good_refuse_keyframes(tool: Any) -> None:
    cube = keyed_cube()
    with pytest.raises(stiv.InputError, match="Cübe A: its transform is animated; clear the animation"):
        tool(bpy.context)
    assert tuple(cube.location) == pytest.approx((0.3, 0, 2))
