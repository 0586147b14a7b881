# SPDX-License-Identifier: GPL-3.0-or-later
"""Random scenes of static objects that depend on each other: edits with obstacles, and with a surface of everything.

Each object depends on earlier ones alone, so that there are no cycles.
"""

import random
from collections.abc import Iterator, Sequence
from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_modifier, select, shift

from stiv import InputError, StartIntersectsError
from stiv.blender import BlenderEdit, EditSettings, check_scene
from stiv.blender.controls.participants import find_participants
from stiv.blender.scene import obstacle_choice
from stiv.blender.scene.static_reading import forget_static_meshes

SCENES, SEEDS = 5, 8  # in each


@pytest.fixture(autouse=True)
def every_scene_is_large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obstacle_choice, "MIN_FACES", 0)
    forget_static_meshes()


def vector(size: float) -> tuple[float, ...]:
    return tuple(random.uniform(-size, size) for _ in range(3))


def nodes_that_show(source: Any) -> Any:
    """Nodes that show an instance of an object on each vertex."""
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    scatter, shown = tree.nodes.new("GeometryNodeInstanceOnPoints"), tree.nodes.new("GeometryNodeObjectInfo")
    shown.inputs["Object"].default_value = source
    shown.inputs["As Instance"].default_value = random.random() < 0.5
    scatter.inputs["Scale"].default_value = (0.3, 0.4, 0.5)
    tree.links.new(start.outputs[0], scatter.inputs["Points"])
    tree.links.new(shown.outputs["Geometry"], scatter.inputs["Instance"])
    tree.links.new(scatter.outputs[0], end.inputs[0])
    return tree


def add_prop(name: str, meshes: Sequence[Any], collection: Any) -> Any:
    """A cube, or an instancer of other objects."""
    kind = random.choice(["cube", "cube", "cube", "collection", "nodes", "vertices"])
    if kind == "collection":
        return add(name, None, vector(9), instance_type="COLLECTION", instance_collection=collection)
    ob = add_cube(name, vector(9), random.uniform(0.2, 0.8), rotation_euler=vector(2))
    if kind == "nodes" and meshes:
        add_modifier(ob, "NODES").node_group = nodes_that_show(random.choice(meshes))
    if kind == "vertices":
        add_cube(f"Child of {name}", vector(1), 0.2, parent=ob)
        ob.instance_type = "VERTS"
    return ob


def relate(ob: Any, before: Sequence[Any]) -> None:
    """A parent, a constraint, a driver, and modifiers that refer to objects."""
    if random.random() < 0.5:
        ob.parent = random.choice([each for each in before if each.instance_type != "VERTS"])  # it shows its children
    if random.random() < 0.3:
        constraint = ob.constraints.new(random.choice(["COPY_ROTATION", "COPY_LOCATION", "TRACK_TO", "CHILD_OF"]))
        constraint.target, constraint.influence = random.choice(before), 0.4
    if random.random() < 0.2:
        variable = ob.driver_add("rotation_euler", 0).driver.variables.new()
        variable.targets[0].id, variable.targets[0].data_path = random.choice(before), "location.y"
        ob.animation_data.drivers[0].driver.type = "SUM"
    if ob.type == "MESH" and random.random() < 0.3:
        add_modifier(ob, "MIRROR", mirror_object=random.choice(before))
    if ob.type == "MESH" and random.random() < 0.2:
        add_modifier(
            ob, "ARRAY", use_relative_offset=False, use_object_offset=True, offset_object=random.choice(before)
        )


def build(seed: int, may_be_followed: bool = True) -> tuple[Any, list[Any]]:
    """The object to be moved, and all others."""
    random.seed(seed)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    collection = bpy.data.collections.new("Shown")
    member = add_cube("Member", vector(9), 0.5)
    collection.objects.link(member)
    mover = add_cube("Mover", (0, 0, 0), 0.4)
    objects = [add("Root", None, vector(1)), add("Centre", None, vector(2)), member]
    random.shuffle(objects)
    if may_be_followed and random.random() < 0.6:
        objects.insert(random.randint(0, 3), mover)
    for number in range(10):
        meshes = [ob for ob in objects if ob.type == "MESH" and not ob.modifiers]
        ob = add_prop(f"Prop {number}", meshes, collection)
        relate(ob, objects)
        objects.append(ob)
    select(mover)
    bpy.context.view_layer.update()
    return mover, [ob for ob in objects if ob != mover]


def placed() -> dict[str, list[np.ndarray]]:
    """World positions of the meshes that each object shows, as Blender evaluates them."""
    found: dict[str, list[np.ndarray]] = {}
    bpy.context.view_layer.update()
    for instance in bpy.context.evaluated_depsgraph_get().object_instances:
        if instance.object.type == "MESH" and (instance.show_self or instance.is_instance):
            owner = instance.parent if instance.is_instance else instance.object
            matrix = np.array(instance.matrix_world)
            points = np.array([vertex.co[:] for vertex in instance.object.data.vertices]).reshape(-1, 3)
            found.setdefault(owner.name, []).append(points @ matrix[:3, :3].T + matrix[:3, 3])
    return found


def chosen(mover: Any) -> frozenset[str]:
    return obstacle_choice.find_obstacles(bpy.context, [mover], (), EditSettings())


@pytest.mark.shared
@pytest.mark.parametrize("first", range(0, SCENES * SEEDS, SEEDS))
def test_obstacles_stay_as_they_are_when_the_object_moves(first: int) -> None:
    kept, left = 0, 0
    for seed in range(first, first + SEEDS):
        mover, others = build(seed)
        names, before = chosen(mover), placed()
        mover.location, mover.rotation_euler, mover.scale = vector(5), vector(3), (1.5, 0.7, 1.2)
        after = placed()
        for name in names & before.keys():
            for ours, theirs in zip(before[name], after[name], strict=True):
                np.testing.assert_array_equal(ours, theirs, err_msg=f"seed {seed}, {name}")
        kept, left = kept + len(names), left + len(others) - len(names)
    assert kept > SEEDS and left > 0


def edits(seed: int) -> Iterator[Any]:
    """An edit of a random scene with obstacles, then one with a surface of everything; none if they cannot begin."""
    settings = EditSettings()
    for with_obstacles in (True, False):
        build(seed, may_be_followed=False)
        try:
            if with_obstacles:
                yield BlenderEdit.begin(bpy.context, settings, "move")
            else:
                participants = find_participants(bpy.context, settings)
                yield BlenderEdit.begin_with(bpy.context, settings, "move", participants)
        except StartIntersectsError as error:
            yield sorted({*map(frozenset, (pair[:2] for pair in error.objects))}, key=sorted)
        except InputError as error:
            yield str(error)


def drag(edit: Any, seed: int) -> tuple[Any, ...]:
    """The results of a drag through the scene, in steps that end as in an edit of the same scene."""
    random.seed(seed)
    direction = np.array(vector(1))
    matrix = shift(*(direction / np.linalg.norm(direction) * 8))
    for step in range(1, 9):
        half = np.eye(4)
        half[:3, 3] = matrix[:3, 3] * step / 8
        result = edit.drag(half)
        assert edit.write().passed
    edit.settle()
    assert edit.write().passed
    distance = edit.least_distance()
    bodies = frozenset() if distance is None else frozenset(distance.bodies)
    return result.status, bodies, edit.standstill_note(result), np.array(bpy.data.objects["Mover"].matrix_world)


@pytest.mark.shared
@pytest.mark.parametrize("first", range(0, SCENES * SEEDS, SEEDS))
def test_an_edit_with_obstacles_ends_as_in_a_surface_of_everything(first: int) -> None:
    compared, touching = 0, 0
    for seed in range(first, first + SEEDS):
        found = []
        for edit in edits(seed):
            if not isinstance(edit, BlenderEdit):
                found.append(edit)
                continue
            assert bool(edit.assembly.obstacles) != bool(found)
            known = set(check_scene(bpy.context).pairs)
            found.append(drag(edit, seed))
            new = {
                pair for pair in check_scene(bpy.context).pairs if "Mover" in (pair.first.object, pair.second.object)
            }
            assert not new - known, f"seed {seed}"
        if not isinstance(found[0], tuple):
            assert found[0] == found[1], f"seed {seed}"
            continue
        (status, bodies, note, matrix), (other_status, other_bodies, other_note, other_matrix) = found
        assert (status, note) == (other_status, other_note), f"seed {seed}"
        assert bodies == other_bodies, f"seed {seed}"
        np.testing.assert_allclose(matrix, other_matrix, atol=0.05, err_msg=f"seed {seed}")
        compared, touching = compared + 1, touching + (status != "reached")
    assert compared > 2 and touching > 0


@pytest.mark.parametrize("first", range(0, SCENES * SEEDS, SEEDS))
def test_the_next_edit_sees_what_has_changed_between(first: int) -> None:
    """Any other object is moved, turned, or reshaped between two edits: obstacles are read where Blender shows them."""
    changed = 0
    for seed in range(first, first + SEEDS):
        mover, others = build(seed)
        edit = begin_or_skip()
        if edit is None:
            continue
        check_obstacles(edit, seed)
        edit.finish()
        before = placed()
        change(random.choice([ob for ob in others if ob.type == "MESH" or ob.children or ob.name == "Centre"]))
        select(mover)
        edit = begin_or_skip()
        if edit is not None:
            check_obstacles(edit, seed)
            edit.finish()
            after = placed()
            changed += sum(not np.array_equal(before[name], after[name]) for name in before if name != "Mover")
    assert changed > 0


def begin_or_skip() -> Any:
    try:
        return BlenderEdit.begin(bpy.context, EditSettings(), "move")
    except (StartIntersectsError, InputError):
        return None


def change(ob: Any) -> None:
    if ob.type == "MESH" and random.random() < 0.4:
        ob.data.vertices[0].co.x += 0.05
        ob.data.update()
    else:
        ob.location.x += 0.1
        ob.rotation_euler.z += 0.1
    bpy.context.view_layer.update()


def check_obstacles(edit: Any, seed: int) -> None:
    """All that Blender shows of the obstacles, in its order."""
    shown, numbers = placed(), dict[str, int]()
    for each in edit.assembly.obstacles:
        name = each.owner.name
        numbers[name] = numbers.get(name, -1) + 1
        np.testing.assert_allclose(
            each.obstacle.vertices, shown[name][numbers[name]], atol=1e-5, err_msg=f"seed {seed}, {name}"
        )
    for name, last in numbers.items():
        assert last == len(shown[name]) - 1
