# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluations of Object Mode and the render, read in Edit Mode, against Blender in these states."""

from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, add_lattice, add_modifier, as_rendered, edit_mode, evaluated, select
from evaluation_reading import kept, read_both, read_evaluation

from stiv.blender.scene.dependencies import is_enabled
from stiv.blender.scene.evaluated_scene import read_scene


def stacks() -> dict[str, Any]:
    """Objects that the viewport, Edit Mode and the render show in different ways."""
    cubes = {name: add_cube(name, (4.0 * number, 0, 0)) for number, name in enumerate("ABCDEFGH")}
    add_modifier(cubes["A"], "SUBSURF", levels=1, render_levels=3)
    add_modifier(cubes["B"], "DISPLACE", strength=1.0, mid_level=0.0)
    add_modifier(cubes["C"], "DISPLACE", strength=0.3, mid_level=0.0, show_viewport=False)
    add_modifier(cubes["D"], "SUBSURF", levels=2, render_levels=2, show_in_editmode=False)
    cubes["E"].hide_render = True
    cubes["F"].hide_set(True)
    add_modifier(cubes["G"], "SHRINKWRAP", target=cubes["A"])
    lattice = add_lattice("Lattice", (2, 2, 2), (28, 0, 0), scale=(3, 3, 3))
    add_modifier(cubes["H"], "LATTICE", object=lattice)
    lattice.data.points[0].co_deform = (-1.0, -0.2, -0.1)
    return {**cubes, "Lattice": lattice}


def check_equal(found: dict[str, np.ndarray], names: Any) -> None:
    wanted = {ob.name: evaluated(ob) for ob in bpy.data.objects if ob.type == "MESH" and ob.visible_get()}
    assert set(found) == set(wanted) and set(names) <= set(found)
    for name, points in wanted.items():
        np.testing.assert_array_equal(found[name].astype(np.float32), points.astype(np.float32))


@pytest.mark.parametrize("edited", ["", "B", "ABCDG", "Lattice"])
@pytest.mark.parametrize("simplified", [False, True])
def test_both_evaluations_are_blenders(edited: str, simplified: bool) -> None:
    objects = stacks()
    bpy.context.scene.render.use_simplify = simplified
    bpy.context.scene.render.simplify_subdivision, bpy.context.scene.render.simplify_subdivision_render = 1, 2
    chosen = [ob for name, ob in objects.items() if name == edited or (len(name) == 1 and name in edited)]
    if edited == "Lattice":
        chosen = [objects["Lattice"]]
    viewport, render = read_both(*chosen)
    check_equal(viewport, "ABCDEGH")
    as_rendered()
    check_equal(render, "ABCDFGH")


@pytest.mark.parametrize("edited", ["", "Parent"])
def test_copies_keep_the_inverses_of_parents_and_hooks(edited: str) -> None:
    """Blender resets both if another object is assigned."""
    parent, child, hooked = (add_cube(name, (4.0 * number, 1, 0)) for number, name in enumerate(("Parent", "C", "H")))
    for ob in (parent, child):
        add_modifier(ob, "SUBSURF", levels=1, render_levels=2)
    bpy.context.view_layer.update()
    child.parent, child.matrix_parent_inverse = parent, parent.matrix_world.inverted()
    hook = add_modifier(hooked, "HOOK", object=parent)
    hook.vertex_indices_set((0, 1, 2))
    hook.matrix_inverse = parent.matrix_world.inverted() @ hooked.matrix_world
    parent.location = (0.5, 1.5, 2)
    bpy.context.view_layer.update()
    viewport, render = read_both(*([parent] if edited else []))
    check_equal(viewport, "CH")
    as_rendered()
    check_equal(render, "CH")


def test_a_posed_armature_counts_in_edit_mode() -> None:
    arm = add("Arm", bpy.data.armatures.new("Arm"))
    select(arm)
    bpy.ops.object.mode_set(mode="EDIT")
    bone = arm.data.edit_bones.new("Bone")
    bone.head, bone.tail = (0, 0, 0), (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    arm.pose.bones["Bone"].location = (0.5, 0.25, 0.125)
    cube = add_cube("Cube")
    cube.vertex_groups.new(name="Bone").add(range(8), 1.0, "REPLACE")
    add_modifier(cube, "ARMATURE", object=arm)
    wanted = evaluated(cube)
    edit_mode(cube)
    assert np.abs(wanted - read_evaluation("shown")["Cube"]).max() > 0.4
    np.testing.assert_array_equal(read_evaluation("viewport")["Cube"].astype(np.float32), wanted.astype(np.float32))


def test_instances_of_objects_with_another_render() -> None:
    cube, other = add_cube("Cube"), add_cube("Other", (0, 3, 0))
    add_modifier(cube, "SUBSURF", levels=1, render_levels=2)
    collection = bpy.data.collections.new("Shown")
    for ob in (cube, other):
        bpy.context.collection.objects.unlink(ob)
        collection.objects.link(ob)
    add("Empty", None, (5, 0, 0), instance_type="COLLECTION", instance_collection=collection)
    meshes = read_scene(bpy.context, evaluations=("render",)).meshes
    assert {(mesh.owner.name, mesh.source, len(mesh.local)) for mesh in meshes} == {
        ("Empty", "Cube", 98), ("Empty", "Other", 8)
    }  # fmt: skip


def test_render_resolution_of_curves() -> None:
    data = bpy.data.curves.new("Curve", "CURVE")
    data.dimensions, data.bevel_depth, data.render_resolution_u = "3D", 0.1, 4
    spline = data.splines.new("BEZIER")
    spline.bezier_points.add(1)
    spline.bezier_points[1].co = (1, 0, 0)
    curve = add("Curve", data)
    shown, rendered = read_evaluation("viewport")["Curve"], read_evaluation("render")["Curve"]
    data.splines[0].resolution_u = 4
    assert len(shown) != len(rendered) == len(evaluated(curve))


def test_nothing_is_copied_if_nothing_differs(monkeypatch: Any) -> None:
    cube = add_cube("Cube")
    add_modifier(cube, "SUBSURF", levels=2, render_levels=2)
    add_grid("Grid", 2)
    monkeypatch.setattr("stiv.blender.scene.open_evaluations.open_copies", None)
    for mode in (select, edit_mode):
        mode(cube)
        meshes = read_scene(bpy.context, evaluations=("shown", "viewport", "render")).meshes
        assert {(mesh.owner.name, len(mesh.shown_in)) for mesh in meshes} == {("Cube", 3), ("Grid", 3)}


def test_copies_are_removed_after_an_error() -> None:
    cube = add_cube("Cube")
    add_modifier(cube, "SUBSURF", levels=1, render_levels=2)
    before = kept()

    def accept(name: str) -> bool:
        raise RuntimeError(name)

    with pytest.raises(RuntimeError, match="Cube"):
        read_scene(bpy.context, accept, evaluations=("render",))
    assert kept() == before


def test_metaballs_are_rendered_in_their_own_families() -> None:
    """A copy whose name got a number would show no surface, or join another family."""
    balls = [bpy.data.metaballs.new("Ball") for _ in range(2)]
    for number, data in enumerate(balls):
        data.elements.new()
        data.resolution, data.render_resolution = 0.5, 0.2
        add(("Ball", "Ball.001")[number], data, (1.5 * number, 0, 0))
    found = [mesh.local for mesh in read_scene(bpy.context, evaluations=("render",)).meshes]
    for data in balls:
        data.resolution = data.render_resolution
    bpy.context.view_layer.update()
    instances = bpy.context.evaluated_depsgraph_get().object_instances
    wanted = [len(instance.object.data.vertices) for instance in instances if instance.object.type == "MESH"]
    assert [len(local) for local in found] == wanted == [max(wanted)]


def test_copies_are_at_the_frame_of_the_scene() -> None:
    """Also below zero, where a preference forbids to go, and with the value that the render shows there."""
    cube = add_cube("Cube")
    add_modifier(cube, "SUBSURF", levels=0, render_levels=1)
    for frame, height in ((-20, 0.0), (0, 2.0)):
        cube.location.z = height
        cube.keyframe_insert("location", frame=frame)
    editing = bpy.context.preferences.edit
    before = editing.use_negative_frames
    try:
        editing.use_negative_frames = True
        bpy.context.scene.frame_set(-10)
        editing.use_negative_frames = False
        viewport, render = read_both()
        assert not editing.use_negative_frames and bpy.context.scene.frame_current == -10
    finally:
        editing.use_negative_frames = before
    check_equal(viewport, ["Cube"])
    as_rendered()
    check_equal(render, ["Cube"])


def test_constraints_of_an_unknown_type_are_not_enabled() -> None:
    """Blender gives those of a newer version no properties."""
    assert not is_enabled(SimpleNamespace(name="Newer"))  # type: ignore[arg-type]
    assert [is_enabled(SimpleNamespace(mute=mute)) for mute in (False, True)] == [True, False]  # type: ignore[arg-type]


def test_a_reference_image_that_modifiers_use_is_copied_too() -> None:
    """Images are the only data of objects without animation data."""
    image, parent, cube = add("Image", None, (0.5, 0, 0)), add_cube("Parent", (0, 3, 0)), add_cube("Cube", (2, 0, 0))
    image.empty_display_type = "IMAGE"
    image.data = bpy.data.images.new("Reference", 4, 4)
    image.parent, parent.location.z = parent, 1
    parent.keyframe_insert("location", frame=1)
    add_modifier(cube, "MIRROR", mirror_object=image)
    add_modifier(cube, "SUBSURF", levels=0, render_levels=1)
    bpy.context.view_layer.update()
    viewport, render = read_both()
    check_equal(viewport, ["Cube", "Parent"])
    as_rendered()
    check_equal(render, ["Cube", "Parent"])
