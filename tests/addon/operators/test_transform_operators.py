# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole edits by the operators, compared with Blender's evaluation afterwards."""

from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

import bmesh  # noqa: E402

from stiv.blender.scene.animation_curves import own_curves  # noqa: E402
from stiv.blender.scripts.replaying import replay  # noqa: E402
from stiv.edit_scripts import parse_edit_script  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


WALL_FACE = 1.9


@pytest.fixture(autouse=True)
def wall() -> Any:
    """An upright plate whose face is at x = WALL_FACE."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    return box("Wall", (WALL_FACE + 0.1, 0.0, 0.0), (0.1, 2.0, 2.0))


def box(name: str, centre: tuple, half: tuple) -> Any:
    bpy.ops.mesh.primitive_cube_add(size=2.0, location=centre)
    obj = bpy.context.active_object
    obj.name = name
    for vertex in obj.data.vertices:
        vertex.co = [coordinate * extent for coordinate, extent in zip(vertex.co, half, strict=True)]
    return obj


def smooth_cage() -> Any:
    cage = box("Cage", (0.0, 0.0, 0.0), (0.5, 0.5, 0.5))
    cage.modifiers.new("Subdivision", "SUBSURF").levels = 2
    return cage


def ball_in_lattice() -> Any:
    """The lattice, active and the only selected object."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=0.5)
    ball = bpy.context.active_object
    ball.name = "Ball"
    bpy.ops.object.add(type="LATTICE")
    lattice = bpy.context.active_object
    lattice.data.points_u = lattice.data.points_v = lattice.data.points_w = 3
    lattice.scale = (1.3, 1.3, 1.3)
    ball.modifiers.new("Lattice", "LATTICE").object = lattice
    bpy.context.view_layer.update()
    return lattice


def edit_right_half() -> None:
    """Edit Mode with the vertices at x > 0 selected."""
    bpy.ops.object.mode_set(mode="EDIT")
    data = bpy.context.object.data
    if bpy.context.object.type == "LATTICE":
        for point in data.points:
            point.select = point.co_deform.x > 0.1  # `co` is nonsense in Edit Mode
        return
    content = bmesh.from_edit_mesh(data)
    for vertex in content.verts:
        vertex.select_set(vertex.co.x > 0.1)
    content.select_flush_mode()
    bmesh.update_edit_mesh(data)


def positions(name: str) -> np.ndarray:
    """World positions of an object in Blender's evaluation, (n, 3)."""
    obj = bpy.data.objects[name].evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = obj.to_mesh()
    result = np.array([obj.matrix_world @ vertex.co for vertex in mesh.vertices])
    obj.to_mesh_clear()
    return result


def expect_free() -> None:
    assert bpy.ops.stiv.check() == {"FINISHED"}
    assert bpy.context.window_manager.stiv_check.summary.splitlines()[0] == "No intersections"


def test_a_box_moved_through_a_wall_ends_in_front_of_it() -> None:
    box("Box", (0.0, 0.0, 0.0), (0.5, 0.5, 0.5))
    assert bpy.ops.stiv.move(value=(5.0, 0.0, 0.0)) == {"FINISHED"}
    assert WALL_FACE - 0.02 < positions("Box")[:, 0].max() < WALL_FACE
    expect_free()


def test_a_clear_move_is_exact() -> None:
    obj = box("Box", (0.0, 0.0, 0.0), (0.5, 0.5, 0.5))
    bpy.ops.stiv.move(value=(0.25, -1.0, 3.0))
    assert tuple(obj.location) == (0.25, -1.0, 3.0)


def test_a_typed_rotation_and_scaling_leave_no_intersection() -> None:
    box("Box", (1.0, 0.0, 0.0), (0.2, 0.9, 0.2))
    bpy.ops.stiv.rotate(angle=np.pi / 2.0, axis=(0.0, 0.0, 1.0))
    expect_free()
    bpy.ops.stiv.scale(value=(4.0, 4.0, 4.0))
    expect_free()
    assert positions("Box")[:, 0].max() < WALL_FACE


def test_vertices_of_a_cage_are_pushed_against_the_wall_in_edit_mode() -> None:
    smooth_cage()
    edit_right_half()
    assert bpy.ops.stiv.move(value=(3.0, 0.0, 0.0)) == {"FINISHED"}
    assert bpy.context.mode == "EDIT_MESH"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert WALL_FACE - 0.1 < positions("Cage")[:, 0].max() < WALL_FACE
    expect_free()


def test_points_of_a_lattice_are_pushed_against_the_wall_in_edit_mode() -> None:
    ball_in_lattice()
    edit_right_half()
    assert bpy.ops.stiv.move(value=(3.0, 0.0, 0.0)) == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert WALL_FACE - 0.1 < positions("Ball")[:, 0].max() < WALL_FACE
    expect_free()


def test_a_lattice_responds_with_its_points_in_object_mode_on_request() -> None:
    ball_in_lattice()
    bpy.context.scene.stiv.object_response = "deform"
    bpy.ops.stiv.move(value=(2.5, 0.0, 0.0))
    ball = positions("Ball")
    assert WALL_FACE - 0.1 < ball[:, 0].max() < WALL_FACE
    assert np.ptp(ball[:, 0]) < 0.95 * np.ptp(ball[:, 1])
    expect_free()


@pytest.mark.parametrize("value", [(5.0, 0.0, 0.0), (0.3, 1.0, 0.2)])
def test_the_same_value_reproduces_the_bits(value: tuple) -> None:
    smooth_cage()
    edit_right_half()
    bpy.ops.ed.undo_push(message="start")
    results = []
    for _ in range(2):
        bpy.ops.stiv.move("EXEC_DEFAULT", True, value=value)
        results.append(positions("Cage"))
        bpy.ops.ed.undo()
    np.testing.assert_array_equal(*results)


def test_one_undo_restores_the_state_before() -> None:
    box("Box", (0.0, 0.0, 0.0), (0.5, 0.5, 0.5))
    bpy.ops.ed.undo_push(message="start")
    bpy.ops.stiv.move("EXEC_DEFAULT", True, value=(5.0, 0.0, 0.0))
    bpy.ops.ed.undo()
    assert tuple(bpy.data.objects["Box"].location) == (0.0, 0.0, 0.0)
    bpy.ops.ed.redo()
    assert WALL_FACE - 0.02 < positions("Box")[:, 0].max() < WALL_FACE


def test_a_start_that_intersects_is_refused_and_nothing_changes() -> None:
    obj = box("Box", (1.5, 0.0, 0.0), (0.5, 0.5, 0.5))
    before = obj.matrix_world.copy()
    with pytest.raises(RuntimeError, match="intersect"):
        bpy.ops.stiv.move(value=(-1.0, 0.0, 0.0))
    assert obj.matrix_world == before


def test_nothing_selected_is_refused() -> None:
    bpy.ops.object.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="selected"):
        bpy.ops.stiv.move(value=(1.0, 0.0, 0.0))


def test_the_role_of_an_object_is_respected(wall: Any) -> None:
    wall.stiv.role = "ignored"
    obj = box("Box", (0.0, 0.0, 0.0), (0.5, 0.5, 0.5))
    bpy.ops.stiv.move(value=(5.0, 0.0, 0.0))
    assert tuple(obj.location) == (5.0, 0.0, 0.0)


def test_the_check_finds_and_selects_what_intersects() -> None:
    box("Box", (1.5, 0.0, 0.0), (0.5, 0.5, 0.5))
    box("Far", (-5.0, 0.0, 0.0), (0.5, 0.5, 0.5))
    assert bpy.ops.stiv.check(select=True) == {"FINISHED"}
    assert {obj.name for obj in bpy.context.selected_objects} == {"Wall", "Box"}
    summary = bpy.context.window_manager.stiv_check.summary
    assert summary.splitlines()[0] == "Box cuts Wall, 5 faces" and "Far" not in summary


def test_the_check_reports_tested_and_untested_objects(wall: Any) -> None:
    box("Hidden", (9.0, 0.0, 0.0), (0.5, 0.5, 0.5)).hide_set(True)
    box("Box", (-5.0, 0.0, 0.0), (0.5, 0.5, 0.5))
    bpy.ops.stiv.check()
    lines = bpy.context.window_manager.stiv_check.summary.splitlines()[-2:]
    triangles = 12 + sum(len(face.vertices) - 2 for face in wall.data.polygons)
    assert lines == [f"Tested 2 objects, {triangles} triangles", 'Not tested: hidden: 1 ("Hidden")']


@pytest.mark.parametrize("constraints", ["per_patch", "single"])
@pytest.mark.parametrize("smoothness", [0.01, 1.0])
def test_constraints_and_smoothness_are_choices(constraints: str, smoothness: float) -> None:
    settings = bpy.context.scene.stiv
    settings.constraints, settings.smoothness = constraints, smoothness
    ball_in_lattice()
    edit_right_half()
    assert bpy.ops.stiv.move(value=(3.0, 0.0, 0.0)) == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert positions("Ball")[:, 0].max() > 1.2
    expect_free()


@pytest.mark.parametrize(("build", "name"), [(smooth_cage, "Cage"), (ball_in_lattice, "Ball")])
def test_restoring_works_in_another_mode_too(build: Any, name: str) -> None:
    from stiv.blender import BlenderEdit, EditSettings

    build()
    before = positions(name)
    edit_right_half()
    edit = BlenderEdit.begin(bpy.context, EditSettings(), kind="move")
    edit.drag([[1, 0, 0, 0.3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    edit.write()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert np.abs(positions(name) - before).max() > 0.1
    edit.restore()
    np.testing.assert_array_equal(positions(name), before)


def test_objects_in_the_render_alone_are_named_unless_the_render_is_guarded(wall: Any) -> None:
    hidden = bpy.data.objects.new("Hidden", wall.data)
    hidden.location, hidden.hide_viewport = (-3.0, 0.0, 0.0), True
    bpy.context.collection.objects.link(hidden)
    cube = box("Box", (-5.0, 0.0, 0.0), (0.5, 0.5, 0.5))
    bpy.ops.stiv.move(value=(4, 0, 0))
    assert cube.location.x == pytest.approx(-1)
    assert bpy.context.window_manager.stiv_check.left_out == 'Not guarded, rendered only: 1 ("Hidden")'
    cube.location.x = -5.0
    bpy.context.scene.stiv.guard = "both"
    bpy.ops.stiv.move(value=(4, 0, 0))
    assert -4 < cube.location.x < -3.4
    assert bpy.context.window_manager.stiv_check.left_out == ""


def test_an_object_without_a_surface_is_reported_and_shown_in_the_panel(wall: Any, capfd: Any) -> None:
    bpy.context.collection.objects.link(bpy.data.objects.new("Dust", bpy.data.pointclouds.new("Dust")))
    box("Box", (-5.0, 0.0, 0.0), (0.5, 0.5, 0.5))
    assert bpy.ops.stiv.move(value=(1, 0, 0)) == {"FINISHED"}
    said = 'Not guarded, point clouds: 1 ("Dust")'
    assert bpy.context.window_manager.stiv_check.left_out == said
    assert said in capfd.readouterr().out
    bpy.ops.stiv.check()
    assert 'Not tested: point clouds: 1 ("Dust")' in bpy.context.window_manager.stiv_check.summary
    bpy.data.objects.remove(bpy.data.objects["Dust"])
    bpy.ops.stiv.move(value=(1, 0, 0))
    assert bpy.context.window_manager.stiv_check.left_out == ""


@pytest.mark.parametrize("chosen", [(True, False, False), (False, False, False)])
def test_scripts_choose_the_axes_that_contact_may_not_leave(chosen: tuple) -> None:
    """Through the operator and its redo, and by an edit script."""
    moving = box("Box", (0.0, 0.0, 0.0), (0.5, 0.5, 0.5))
    moving.rotation_euler = (0.3, 0.2, 0.5)
    wall = bpy.data.objects["Wall"]
    wall.rotation_euler.z, wall.scale = 0.6, (1.0, 6.0, 6.0)  # too large for a detour
    values = {"value": [6.0, 0.0, 0.0], "constraint_axis": list(chosen)}
    step = {"operator": "move", "objects": ["Box"], "values": values}
    script = parse_edit_script({"schema": "stiv-edits", "version": 1, "steps": [step]})
    for apply in (
        lambda: bpy.ops.stiv.move(value=(6.0, 0.0, 0.0), constraint_axis=chosen),
        lambda: replay(script),
    ):
        moving.location = (0.0, 0.0, 0.0)
        bpy.ops.object.select_all(action="DESELECT")
        moving.select_set(True)
        bpy.context.view_layer.objects.active = moving
        bpy.context.view_layer.update()
        apply()
        x, y, z = moving.location
        assert tuple(moving.rotation_euler) == pytest.approx((0.3, 0.2, 0.5), abs=1e-7)
        assert (y == z == 0.0) == any(chosen)
        assert x > (0.2 if any(chosen) else 1.0)


def test_files_of_the_first_version_keep_their_response() -> None:
    """`rigid` in an edit script turns; the number 1 in a .blend was Deform, 0 becomes the new default."""
    moving = box("Box", (0.0, 0.0, 0.0), (0.2, 1.2, 0.2))
    bpy.data.objects["Wall"].location.y = 2.6
    step = {"operator": "move", "objects": ["Box"], "values": {"value": [2.0, 0.0, 0.0]}}
    head = {"schema": "stiv-edits", "version": 1, "settings": {"object_response": "rigid"}}
    replay(parse_edit_script({**head, "steps": [step]}))
    assert moving.rotation_euler.z != 0
    items = bpy.context.scene.stiv.bl_rna.properties["object_response"].enum_items
    assert {item.identifier: item.value for item in items} == {"slide": 0, "deform": 1, "slide_and_turn": 2}


def test_auto_keying_inserts_keyframes_for_objects() -> None:
    """Blender's own tools do so; the wall stops the box before."""
    cube = box("Box", (0.0, 0.0, 0.0), (0.5, 0.5, 0.5))
    bpy.context.scene.tool_settings.use_keyframe_insert_auto = True
    bpy.context.scene.frame_set(7)
    assert bpy.ops.stiv.move("EXEC_DEFAULT", True, value=(3, 0, 0)) == {"FINISHED"}
    reached = cube.location.x
    cube.location.x = 0.0
    bpy.context.scene.frame_set(8)
    assert cube.location.x == reached == pytest.approx(WALL_FACE - 0.5, abs=0.01)
    paths = {curve.data_path for curve in own_curves(cube)}
    assert paths == {"location"}


def test_auto_keying_can_use_the_active_keying_set_alone() -> None:
    cube = box("Box", (0.0, 0.0, 0.0), (0.5, 0.5, 0.5))
    bpy.context.scene.tool_settings.use_keyframe_insert_auto = True
    bpy.context.scene.tool_settings.use_keyframe_insert_keyingset = True
    bpy.context.scene.keying_sets_all.active = bpy.context.scene.keying_sets_all["Rotation"]
    assert bpy.ops.stiv.move("EXEC_DEFAULT", True, value=(0.5, 0, 0)) == {"FINISHED"}
    assert {curve.data_path for curve in own_curves(cube)} == {"rotation_euler"}
