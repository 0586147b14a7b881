# SPDX-License-Identifier: GPL-3.0-or-later
"""Loop subdivision by the operators, and its updates after changes of the cage."""

from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

import bmesh  # noqa: E402

import stiv  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture(autouse=True)
def cage() -> Any:
    """An icosahedron, selected and active, above a floor."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_plane_add(size=6.0, location=(0, 0, -1.5))
    bpy.context.active_object.name = "Floor"
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=1, radius=1.0)
    obj = bpy.context.active_object
    obj.name = "Cage"
    return obj


def shown(name: str = "Cage.loop") -> np.ndarray:
    return np.array([tuple(vertex.co) for vertex in bpy.data.objects[name].data.vertices])


def expected(cage: Any, levels: int = 2) -> np.ndarray:
    """The refined positions of the cage in Object Mode, by the package without Blender."""
    triangles = [list(polygon.vertices) for polygon in cage.data.polygons]
    edges = [tuple(edge.vertices) for edge in cage.data.edges]
    positions = np.array([tuple(vertex.co) for vertex in cage.data.vertices])
    deformation, _ = stiv.loop(stiv.Cage.of_faces(triangles, len(positions), edges), levels)
    return deformation.surface(positions)


def test_added_refreshed_removed(cage: Any) -> None:
    assert not bpy.ops.stiv.loop_refresh.poll()
    assert bpy.ops.stiv.loop_add(levels=1) == {"FINISHED"}
    assert shown() == pytest.approx(expected(cage, 1), abs=1e-6)
    assert cage.display_type == "WIRE" and cage.hide_render
    assert not bpy.ops.stiv.loop_add.poll()
    cage.stiv.loop.levels = 3
    assert shown() == pytest.approx(expected(cage, 3), abs=1e-6)
    assert bpy.ops.stiv.loop_refresh() == {"FINISHED"}
    assert bpy.ops.stiv.loop_remove() == {"FINISHED"}
    assert "Cage.loop" not in bpy.data.objects
    assert cage.display_type == "TEXTURED" and not cage.hide_render
    assert bpy.ops.stiv.loop_add.poll()


def test_edits_press_the_surface_on_the_floor_and_one_undo_restores_both(cage: Any) -> None:
    bpy.ops.stiv.loop_add()
    bpy.context.scene.stiv.object_response = "deform"
    before = shown()
    bpy.ops.ed.undo_push(message="start")
    bpy.ops.stiv.move("EXEC_DEFAULT", True, value=(0.0, 0.0, -1.0))
    assert -1.5 < shown()[:, 2].min() < -1.45
    assert shown() == pytest.approx(expected(bpy.data.objects["Cage"]), abs=1e-6)
    assert bpy.ops.stiv.check() == {"FINISHED"}
    assert bpy.context.window_manager.stiv_check.summary.splitlines()[0] == "No intersections"
    bpy.ops.ed.undo()
    np.testing.assert_array_equal(shown(), before)


def test_results_of_blenders_tools_are_refined(cage: Any) -> None:
    bpy.ops.stiv.loop_add()
    cage.data.vertices[0].co.z -= 0.3
    cage.data.update()
    bpy.context.view_layer.update()
    assert shown() == pytest.approx(expected(cage), abs=1e-6)
    bpy.ops.object.mode_set(mode="EDIT")
    edited = bmesh.from_edit_mesh(cage.data)
    edited.verts.ensure_lookup_table()
    edited.verts[3].co.x += 0.4
    bmesh.ops.poke(edited, faces=list(edited.faces)[:1])
    bmesh.update_edit_mesh(cage.data)
    bpy.context.view_layer.update()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert shown() == pytest.approx(expected(cage), abs=1e-6)
    assert len(bpy.data.objects["Cage.loop"].data.polygons) == 22 * 16


def test_a_cage_with_another_face_is_refused_and_says_which(cage: Any) -> None:
    bpy.context.view_layer.objects.active = bpy.data.objects["Floor"]
    with pytest.raises(RuntimeError, match="Floor: face 0 has 4 corners"):
        bpy.ops.stiv.loop_add()
    assert bpy.data.objects["Floor"].stiv.loop.object is None


def test_a_copy_of_a_cage_has_no_surface_of_its_own(cage: Any) -> None:
    bpy.ops.stiv.loop_add()
    copy = cage.copy()
    copy.data = cage.data.copy()
    bpy.context.collection.objects.link(copy)
    copy.location.x = 5
    bpy.context.view_layer.update()
    bpy.ops.object.select_all(action="DESELECT")
    copy.select_set(True)
    bpy.context.view_layer.objects.active = copy
    assert bpy.ops.stiv.loop_add.poll()
    assert bpy.ops.stiv.move(value=(0.0, 0.0, 0.5)) == {"FINISHED"}
    assert tuple(copy.location) == (5, 0, 0.5)


def test_undo_in_edit_mode_restores_the_object_too(cage: Any) -> None:
    bpy.ops.stiv.loop_add()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    before = shown()
    bpy.ops.ed.undo_push(message="start")
    bpy.ops.stiv.move("EXEC_DEFAULT", True, value=(0.0, 0.0, -1.0))
    assert np.abs(shown() - before).max() > 0.1
    bpy.ops.ed.undo()
    assert shown() == pytest.approx(before, abs=1e-6)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert shown() == pytest.approx(expected(bpy.data.objects["Cage"]), abs=1e-6)
