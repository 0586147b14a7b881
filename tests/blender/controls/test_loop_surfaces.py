# SPDX-License-Identifier: GPL-3.0-or-later
"""Loop subdivision shown by a child: correct by published masks, updated by edits, colliding instead of the cage."""

from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, edit_mode, evaluated, mesh, moved, select, shift, snapshot, turn

import stiv
from stiv.blender import (
    BlenderEdit,
    EditSettings,
    Handles,
    LoopSurface,
    add_refined,
    check_scene,
    compare,
    correct_after_tool,
    read_state,
    read_surface,
    refresh,
    remove_refined,
)
from tests.deformation.loop_masks import LoopMesh, subdivided

CORNERS = [(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
FACES = [(k, (k + 1) % 4, 4) for k in range(4)] + [((k + 1) % 4, k, 5) for k in range(4)]


def octahedron(name: str = "Cage", location: Any = (0, 0, 0), **properties: Any) -> Any:
    return add(name, mesh(name, CORNERS, FACES), location, **properties)


def with_loop(cage: Any, levels: int = 2) -> tuple[Any, EditSettings]:
    refined = add_refined(bpy.context, cage, levels, "all")
    return refined, EditSettings(object_response="deform", loops={cage.name: LoopSurface(refined.name, levels)})


def begin(settings: EditSettings, kind: str = "move") -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, settings, kind)


def by_masks(cage: Any, levels: int, creases: dict[tuple[int, int], float] | None = None) -> np.ndarray:
    """World positions by Loop's masks, in an order of their own."""
    world = np.array([cage.matrix_world @ v.co for v in cage.data.vertices])
    return subdivided(LoopMesh(6, FACES, creases or {}, {}), world, levels, limit=True)[0]


def matches(shown: np.ndarray, expected: np.ndarray) -> bool:
    """The same points in any order."""
    distances = np.linalg.norm(shown[:, None] - expected[None], axis=2)
    nearest = distances.argmin(axis=1)
    return len(shown) == len(expected) == len(set(nearest)) and bool(distances.min(axis=1).max() < 1e-6)


@pytest.mark.parametrize("levels", [1, 2, 3])
def test_the_refined_object_follows_the_published_masks(levels: int) -> None:
    cage = octahedron(location=(1, -2, 0.5), rotation_euler=(0.4, 0.1, 0.9), scale=(1.2, 0.7, -1))
    refined, _ = with_loop(cage, levels)
    assert refined.name == "Cage.loop" and refined.parent == cage
    assert matches(evaluated(refined), by_masks(cage, levels))
    assert len(refined.data.polygons) == 8 * 4**levels


def test_creases_are_respected() -> None:
    cage = octahedron()
    creases = cage.data.attributes.new("crease_edge", "FLOAT", "EDGE")
    ring = {(0, 1), (1, 2), (2, 3), (0, 3)}
    for edge in cage.data.edges:
        creases.data[edge.index].value = 1.0 if tuple(sorted(edge.vertices)) in ring else 0.0
    refined, _ = with_loop(cage)
    assert matches(evaluated(refined), by_masks(cage, 2, dict.fromkeys(ring, 1e9)))
    assert not matches(evaluated(refined), by_masks(cage, 2))


@pytest.mark.parametrize("kind", ["vertices", "laplacian", "rigid"])
def test_edits_keep_the_refined_object_current_and_free(kind: str) -> None:
    add_grid("Floor", 2, 4.0, (0, 0, -1.2))
    cage = octahedron(rotation_euler=(0.3, 0, 0.2))
    refined, settings = with_loop(cage)
    cage.vertex_groups.new(name="All").add(list(range(6)), 1.0, "REPLACE")
    settings = EditSettings(
        loops=settings.loops, deformations={"Cage": kind}, handles={"Cage": Handles(("All",), pull=1.0)}
    )
    select(cage)
    start = snapshot()
    edit = begin(settings)
    assert snapshot() == start
    names = {each.name: each.role for each in edit.summary.participants}
    assert names == {
        "Floor": "obstacle",
        "Cage.loop": {"vertices": "cage", "laplacian": "soft", "rigid": "rigid"}[kind],
    }
    for depth in (0.3, 0.6, 0.9):
        edit.drag(shift(z=-depth))
        assert edit.write().passed
        assert matches(evaluated(refined), by_masks(cage, 2))
    assert -1.2 < evaluated(refined)[:, 2].min() < -1.15
    assert check_scene(bpy.context, settings).pairs == ()
    edit.restore()
    assert snapshot() == start


def test_the_cage_may_intersect_if_its_surface_does_not() -> None:
    add_grid("Floor", 2, 4.0, (0, 0, -0.9))
    cage = octahedron()
    refined, settings = with_loop(cage)
    edit_mode(cage)
    bpy.ops.mesh.select_all(action="SELECT")
    edit = begin(settings)
    assert edit.drag(turn(0.5, "Z") @ shift(0.2)).status == "reached"
    assert edit.write().passed
    bpy.ops.object.mode_set(mode="OBJECT")
    assert matches(evaluated(refined), by_masks(cage, 2))
    assert moved(np.array(cage.matrix_world), np.array(CORNERS, float))[:, 2].min() < -0.9
    assert check_scene(bpy.context, settings).pairs == ()
    assert check_scene(bpy.context, objects=bpy.data.objects.keys()).pairs != ()


def test_a_stale_object_is_refused_until_refreshed() -> None:
    cage = octahedron()
    refined, settings = with_loop(cage)
    chosen = settings.loops["Cage"]
    assert not refresh(cage, refined, chosen)
    cage.data.vertices[4].co.z += 0.2
    select(cage)
    with pytest.raises(stiv.InputError, match=r'Cage\.loop: is older than its cage "Cage"'):
        begin(settings)
    assert refresh(cage, refined, chosen)
    assert matches(evaluated(refined), by_masks(cage, 2))
    assert begin(settings).drag(shift(1)).status == "reached"
    edit_mode(cage)
    edited = bmesh.from_edit_mesh(cage.data)
    bmesh.ops.poke(edited, faces=list(edited.faces)[:1])
    bmesh.update_edit_mesh(cage.data)
    assert refresh(cage, refined, chosen)
    assert len(refined.data.polygons) == 10 * 16


def test_materials_and_shading_are_those_of_the_cage() -> None:
    cage = octahedron()
    for name in ("Red", "Blue"):
        cage.data.materials.append(bpy.data.materials.new(name))
    cage.data.polygons[3].material_index = 1
    cage.data.polygons[3].use_smooth = True
    refined, _ = with_loop(cage, 1)
    assert [slot.name for slot in refined.data.materials] == ["Red", "Blue"]
    assert [p.material_index for p in refined.data.polygons].count(1) == 4
    assert [p.use_smooth for p in refined.data.polygons].count(True) == 4


def test_other_cages_are_refused_and_nothing_is_added() -> None:
    cube = add_cube("Cube")
    before = snapshot()
    with pytest.raises(stiv.InputError, match="Cube: face 0 has 4 corners"):
        add_refined(bpy.context, cube, 2, "all")
    assert snapshot() == before
    with pytest.raises(stiv.InputError, match="levels: 4"):
        LoopSurface("X", 4)


def test_hidden_and_removed_objects() -> None:
    cage = octahedron()
    refined, settings = with_loop(cage)
    refined.hide_set(True)
    select(cage)
    with pytest.raises(stiv.InputError, match=r'Cage\.loop: shows the cage "Cage" and is hidden'):
        begin(settings)
    before = sorted(bpy.data.meshes.keys())
    remove_refined(refined)
    assert sorted(bpy.data.meshes.keys()) == [name for name in before if name != "Cage.loop"]
    with pytest.raises(stiv.InputError, match=r"Cage\.loop: the settings name it"):
        begin(settings)


def test_a_replaced_cage_is_not_a_surface_unless_it_is_named() -> None:
    cage = octahedron()
    refined, _ = with_loop(cage)
    assert [mesh.owner.name for mesh in read_surface(bpy.context).meshes] == [refined.name]
    assert [mesh.owner.name for mesh in read_surface(bpy.context, ["Cage"]).meshes] == ["Cage"]
    remove_refined(refined)
    assert [mesh.owner.name for mesh in read_surface(bpy.context).meshes] == ["Cage"]


def test_a_refined_object_yields_with_its_cage() -> None:
    cage = octahedron(location=(2.5, 0, 0))
    refined, settings = with_loop(cage)
    pusher = add_cube("Pusher")
    select(pusher)
    edit = begin(EditSettings(responders="unselected", loops=settings.loops))
    edit.apply(shift(1.5))
    assert edit.write().passed
    assert cage.location.x > 2.7 and tuple(refined.location) == (0, 0, 0)
    assert evaluated(refined)[:, 0].min() > 2.5
    assert check_scene(bpy.context, settings).pairs == ()


def test_a_cage_moved_by_another_tool_is_corrected_by_its_surface() -> None:
    add_grid("Floor", 2, 4.0, (0, 0, -1.2))
    cage = octahedron()
    refined, settings = with_loop(cage)
    accepted = read_state(bpy.context)
    for vertex in cage.data.vertices:
        vertex.co.z -= 1.0
    cage.data.update()
    refresh(cage, refined, settings.loops["Cage"])
    bpy.context.view_layer.update()
    outcome = correct_after_tool(bpy.context, settings, accepted, compare(accepted, read_state(bpy.context)))
    assert outcome.corrected and outcome.names == ("Cage",)
    assert -1.2 < evaluated(refined)[:, 2].min() < -1.1
    assert matches(evaluated(refined), by_masks(cage, 2))
    assert check_scene(bpy.context, settings).pairs == ()


def test_a_check_without_settings_leaves_out_the_cage_unless_it_is_named() -> None:
    cage = octahedron()
    cage.data.vertices[4].co.z = -0.5  # a dent, in which the surface is outside of the cage
    refined, settings = with_loop(cage)
    assert check_scene(bpy.context, settings).pairs == check_scene(bpy.context).pairs == ()
    assert check_scene(bpy.context).objects == 1
    assert check_scene(bpy.context, objects=[cage.name, refined.name]).pairs != ()
