# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples inside the extension: they open, and their steps lead to scenes without intersections."""

import pytest

bpy = pytest.importorskip("bpy")

from stiv_addon.getting_started import examples  # noqa: E402

NAMES = [identifier for identifier, _, _ in examples.EXAMPLES]
pytestmark = [
    pytest.mark.usefixtures("registered"),
    pytest.mark.skipif(not examples.is_available(), reason="the extension is not installed from its zip"),
]


@pytest.mark.parametrize("name", NAMES)
def test_an_example_opens_without_a_file_name_and_has_the_objects_of_its_steps(name):
    assert bpy.ops.stiv.open_example(example=name) == {"FINISHED"}
    assert bpy.data.filepath == ""
    steps = examples.steps_of(bpy.context.scene)
    assert steps
    assert {ob for step in steps for ob in step.objects} <= {ob.name for ob in bpy.context.view_layer.objects}
    assert bpy.context.active_object.name == steps[0].objects[0]
    assert bpy.context.active_object.select_get()


def test_two_steps_dress_the_figure():
    bpy.ops.stiv.open_example(example="dress_figure")
    assert pairs() > 100
    for step in range(2):
        assert bpy.ops.stiv.example_step(step=step) == {"FINISHED"}
    assert pairs() == 0


def test_the_plant_and_the_box_begin_without_intersections():
    for name in ("pot_plant", "pack_box", "morph_body"):
        bpy.ops.stiv.open_example(example=name)
        assert pairs() == 0


def test_a_step_selects_a_bone_in_pose_mode_and_the_next_one_another():
    bpy.ops.stiv.open_example(example="pose_arm")
    for step, name in enumerate(("Arm.L", "Forearm.L")):
        assert bpy.ops.stiv.example_step(step=step) == {"FINISHED"}
        assert bpy.context.mode == "POSE"
        assert [bone.name for bone in bpy.context.selected_pose_bones] == [name]


def test_the_shirt_of_the_example_makes_room():
    bpy.ops.stiv.open_example(example="morph_body")
    shirt = bpy.data.objects["Shirt"].data
    before = max(vertex.co.xy.length for vertex in shirt.vertices)
    assert bpy.ops.stiv.morph(keys=[{"name": "Heavier", "value": 1.0}]) == {"FINISHED"}
    assert bpy.data.shape_keys[0].key_blocks["Heavier"].value == 1.0
    assert pairs() == 0 and max(vertex.co.xy.length for vertex in shirt.vertices) > before + 0.05


def test_the_walk_cuts_itself_at_the_frame_of_the_example():
    bpy.ops.stiv.open_example(example="clean_walk")
    assert bpy.ops.stiv.example_step(step=0) == {"FINISHED"}
    assert "Body" in bpy.context.window_manager.stiv_check.summary and bpy.context.window_manager.stiv_check.intersects


def test_a_step_of_a_changed_example_is_refused():
    bpy.ops.stiv.open_example(example="pack_box")
    bpy.data.objects.remove(bpy.data.objects["Suzanne"])
    with pytest.raises(RuntimeError, match="The example has changed; open it again"):
        bpy.ops.stiv.example_step(step=0)


def pairs() -> int:
    """Intersecting pairs of triangles of different objects, by Blender's own search trees."""
    from mathutils.bvhtree import BVHTree

    graph = bpy.context.evaluated_depsgraph_get()
    trees = []
    for ob in bpy.context.view_layer.objects:
        if ob.type == "MESH" and ob.stiv.loop.object is None:
            mesh = ob.evaluated_get(graph).data
            mesh.calc_loop_triangles()
            points = [ob.matrix_world @ vertex.co for vertex in mesh.vertices]
            trees.append(BVHTree.FromPolygons(points, [t.vertices[:] for t in mesh.loop_triangles], all_triangles=True))
    return sum(len(first.overlap(second)) for k, first in enumerate(trees) for second in trees[k + 1 :])
