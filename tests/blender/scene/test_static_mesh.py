# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes read once as obstacles, and cropped, against a plain loop over all faces, edges and vertices."""

from collections.abc import Callable, Iterator, Sequence
from types import SimpleNamespace
from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from building import add, add_cube, mesh
from numpy.testing import assert_array_equal

from stiv.blender import check_scene
from stiv.blender.scene import static_reading
from stiv.blender.scene.elements import Element
from stiv.blender.scene.evaluated_scene import VisibleMesh, read_scene
from stiv.blender.scene.evaluations import SHOWN
from stiv.blender.scene.mesh_reading import evaluated_mesh, read_positions, view_first_corners, view_positions
from stiv.blender.scene.static_mesh import StaticMesh
from stiv.blender.scene.static_reading import prepare_static_meshes_steps, read_static_meshes

BOXES = [((-1, -1, -1), (1, 1, 1)), ((0.2, -9, -9), (0.9, 9, 9)), ((40, 40, 40), (41, 41, 41)), ((-99,) * 3, (99,) * 3)]


def all_kinds(seed: int) -> Any:
    """Triangles, quads and larger faces, loose edges and loose vertices, anywhere; turned, scaled and mirrored."""
    random = np.random.default_rng(seed)
    content = bmesh.new()
    for _ in range(60):
        middle, size = random.uniform(-4, 4, 3), random.uniform(0.1, 2)
        turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
        corners = random.integers(1, 8)
        angles = np.sort(random.uniform(0, 6.28, corners))
        ring = np.stack([np.cos(angles), np.sin(angles), 0.2 * random.normal(size=corners)], axis=1)
        vertices = [content.verts.new(row) for row in middle + size * ring @ turn]
        if corners == 2:
            content.edges.new(vertices)
        elif corners > 2:
            content.faces.new(vertices)
    data = bpy.data.meshes.new("All kinds")
    content.to_mesh(data)
    content.free()
    return add("All kinds", data, (0.3, -0.2, 0.5), rotation_euler=(0.4, 0.5, 0.6), scale=(1.5, -0.7, 1.0))


@pytest.fixture(autouse=True)
def nothing_is_known() -> None:
    static_reading.forget_static_meshes()


def read() -> VisibleMesh:
    (found,) = read_scene(bpy.context).meshes
    return found


def read_static() -> StaticMesh:
    (found,) = read_static_meshes(bpy.context, {ob.name for ob in bpy.data.objects}, frozenset({SHOWN}))
    return found


def read_near(box: Any) -> VisibleMesh:
    static = read_static()
    return static.cropped(static.obstacle.triangles_near(*box))


@pytest.mark.parametrize("box", BOXES)
@pytest.mark.parametrize("seed", range(8))
def test_all_elements_that_touch_the_box_are_read(seed: int, box: Any) -> None:
    all_kinds(seed)
    low, high = map(np.array, box)
    part, whole = read_near(box), read()
    assert part.cropped is not None and part.is_static and part.size == whole.size
    world, numbers = whole.world(), part.cropped.vertices
    assert_array_equal(part.world(), world[numbers])

    def meets(vertices: Any) -> bool:
        """Whether any of many points of a vertex, an edge or a triangle lies in the box."""
        shares = np.random.default_rng(seed).dirichlet(np.ones(len(vertices)), 300)
        points = np.concatenate([world[vertices], shares @ world[vertices]])
        return bool(((points >= low) & (points <= high)).all(axis=1).any())

    faces = {int(face) for face, corners in zip(whole.faces, whole.triangles, strict=True) if meets(corners)}
    assert faces <= set(part.faces.tolist())
    theirs = {(face, *corners) for face, corners in zip(whole.faces.tolist(), whole.triangles.tolist(), strict=True)}
    ours = zip(part.faces.tolist(), numbers[part.triangles].tolist(), strict=True)
    assert {(face, *corners) for face, corners in ours} <= theirs
    edges = {int(n) for n, edge in zip(whole.loose_numbers, whole.loose_edges, strict=True) if meets(edge)}
    assert edges <= set(part.loose_numbers.tolist())
    rows = np.isin(whole.loose_numbers, part.loose_numbers)
    assert_array_equal(numbers[part.loose_edges], whole.loose_edges[rows])
    assert {n for n in range(len(world)) if meets([n])} <= set(numbers.tolist())


def test_distant_elements_are_not_read() -> None:
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=50, y_subdivisions=50, size=50)
    part = read_near(((-2.5, -2.5, -1), (2.5, 2.5, 1)))
    assert 25 <= len(set(part.faces.tolist())) <= 49
    assert read_near(((60, 60, 60), (61, 61, 61))).local.shape == (0, 3)


def test_a_singular_frame_is_read() -> None:
    add("Flat", mesh("Flat", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]), (5, 0, 0), scale=(1, 1, 0))
    assert len(read_near(((4, -1, -1), (6, 1, 1))).triangles) == 1


@pytest.mark.parametrize("at_once", [1, 7, 1 << 15])
@pytest.mark.parametrize("seed", range(8))
def test_all_triangles_are_those_of_blender(seed: int, at_once: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(static_reading, "FACES_AT_ONCE", at_once)
    all_kinds(seed)
    static, whole = read_static(), read()
    triangles = static.obstacle.triangles
    assert static.triangle_count == len(whole.triangles)
    assert_array_equal(triangles[: len(whole.triangles)], whole.triangles)
    assert_array_equal(static.obstacle.vertices, whole.world())
    elements = [static.element(number) for number in range(len(triangles))]
    faces = [Element("All kinds", "face", face) for face in whole.faces.tolist()]
    edges = [Element("All kinds", "edge", edge) for edge in whole.loose_numbers.tolist()]
    used = {*whole.triangles.ravel().tolist(), *whole.loose_edges.ravel().tolist()}
    vertices = [Element("All kinds", "vertex", number) for number in range(whole.size) if number not in used]
    assert elements == [*faces, *edges, *vertices]
    assert len(edges) > 0 and len(vertices) > 0


def moved_vertex(ob: Any) -> None:
    ob.data.vertices[7].co.z += 1e-6


def moved_object(ob: Any) -> None:
    ob.location.x += 1e-6


def another_face(ob: Any) -> None:
    content = bmesh.new()
    content.from_mesh(ob.data)
    content.faces.ensure_lookup_table()
    content.faces[3].normal_flip()
    content.to_mesh(ob.data)
    content.free()


def new_loose_edge(ob: Any) -> None:
    ob.data.edges.add(1)
    ob.data.edges[-1].vertices = (0, 5)


def modifier(ob: Any) -> None:
    ob.modifiers.new("Wave", "WAVE").start_position_x = 0.3


@pytest.mark.parametrize("change", [moved_vertex, moved_object, another_face, new_loose_edge, modifier])
def test_a_mesh_is_read_again_only_if_its_data_changed(change: Any) -> None:
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4, size=2)
    ground = bpy.context.object
    first = read_static()
    assert read_static() is first
    ground.data.update()  # evaluated again, to the same values
    bpy.context.view_layer.update()
    assert read_static() is first
    change(ground)
    ground.data.update()
    bpy.context.view_layer.update()
    again = read_static()
    assert again is not first
    assert_array_equal(again.obstacle.vertices, read().world())
    assert_array_equal(again.obstacle.triangles[: again.triangle_count], read().triangles)


def test_views_show_the_values_that_are_read() -> None:
    bpy.ops.mesh.primitive_uv_sphere_add()
    with evaluated_mesh(bpy.context.object.evaluated_get(bpy.context.evaluated_depsgraph_get())) as data:
        view = view_positions(data)
        assert not view.flags.writeable and not view.flags.owndata
        assert_array_equal(view, read_positions(data))


@pytest.mark.parametrize("seed", range(4))
def test_viewed_first_corners_are_those_that_are_read(seed: int) -> None:
    ob = all_kinds(seed)
    for data in (ob.data, ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data, bpy.data.meshes.new("Empty")):
        expected = [face.loop_start for face in data.polygons]
        assert_array_equal(view_first_corners(data), np.array(expected, np.int32))


def test_elements_are_named_by_their_numbers_in_blenders_mesh() -> None:
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=50, y_subdivisions=50, size=50)
    ground = bpy.context.object
    part, whole = read_near(((19.2, 19.2, -1), (19.8, 19.8, 1))), read()
    number = part.vertex_number(0)
    assert number == part.cropped.vertices[0] > 0 and ground.data.vertices[number].co.x > 18
    assert whole.vertex_number(3) == 3
    assert check_scene(bpy.context).pairs == ()


def add_instances() -> None:
    """Five cubes, three of which share a mesh; two instances of a collection with two cubes."""
    first = add_cube("Cube 0", (0, 0, 0))
    for number in range(1, 5):
        add(f"Cube {number}", first.data if number < 3 else add_cube("Other").data, (3.0 * number, 0, 0))
    collection = bpy.data.collections.new("Cubes")
    for number in range(2):
        collection.objects.link(bpy.data.objects[f"Cube {number}"])
    for number in range(2):
        add(f"Instances {number}", None, (0, 5 + number, 0), instance_type="COLLECTION", instance_collection=collection)


def read_in_steps(between: Callable[[int], object] = lambda step: None) -> tuple[int, tuple[StaticMesh, ...]]:
    """The number of steps, each of which reads one mesh, and all meshes."""
    names, count = {ob.name for ob in bpy.data.objects}, 0
    for _ in prepare_static_meshes_steps(bpy.context, names):
        between(count)
        bpy.context.view_layer.update()
        count += 1
    return count, read_static_meshes(bpy.context, names, frozenset({SHOWN}))


def assert_same(ours: Sequence[StaticMesh], theirs: Sequence[StaticMesh]) -> None:
    assert [(each.owner, each.source, each.number) for each in ours] == [
        (each.owner, each.source, each.number) for each in theirs
    ]
    for a, b in zip(ours, theirs, strict=True):
        assert_array_equal(a.obstacle.vertices, b.obstacle.vertices)
        assert_array_equal(a.obstacle.triangles, b.obstacle.triangles)


def test_meshes_read_in_steps_are_those_read_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(static_reading, "TURN", 0.0)
    add_instances()
    steps, found = read_in_steps()
    assert steps == len(found) == 11
    assert len({id(each.shape) for each in found}) == 3  # instances share theirs in all steps
    assert [a is b for a, b in zip(read_in_steps()[1], found, strict=True)] == [True] * len(found)
    static_reading.forget_static_meshes()
    names = {ob.name for ob in bpy.data.objects}
    assert_same(found, read_static_meshes(bpy.context, names, frozenset({SHOWN})))


def test_a_step_reads_several_meshes_however_many_are_read_already(monkeypatch: pytest.MonkeyPatch) -> None:
    """A clock that counts the meshes that are visited. A step reads until five seconds after its first mesh."""
    clock, visit = [0.0], static_reading._visible

    def visit_slowly(*given: Any) -> Iterator[Any]:
        for each in visit(*given):
            clock[0] += 1
            yield each

    monkeypatch.setattr(static_reading, "TURN", 5.0)
    monkeypatch.setattr(static_reading, "_visible", visit_slowly)
    monkeypatch.setattr(static_reading, "time", SimpleNamespace(perf_counter=lambda: clock[0]))
    for number in range(30):
        add_cube(f"Cube {number}", (3.0 * number, 0, 0))
    steps, found = read_in_steps()
    assert len(found) == 30 and steps == 4


@pytest.mark.parametrize("seed", range(6))
def test_a_change_between_steps_is_read(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(static_reading, "TURN", 0.0)
    add_instances()
    chosen = np.random.default_rng(seed)

    def change(step: int) -> None:
        ob = bpy.data.objects[f"Cube {chosen.integers(5)}"]
        if step % 2:
            ob.location.z += 1
        else:
            ob.data.vertices[int(chosen.integers(8))].co.x += 0.5
            ob.data.update()

    _, found = read_in_steps(change)
    static_reading.forget_static_meshes()
    names = {ob.name for ob in bpy.data.objects}
    assert_same(found, read_static_meshes(bpy.context, names, frozenset({SHOWN})))
