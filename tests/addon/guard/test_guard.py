# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard in Blender: it corrects results of tools, scripts and operators that intersect."""

from collections.abc import Iterator

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

from guarding import FURTHEST, box, expect_free, look, move, names_of_steps, watched_scene  # noqa: E402

from stiv_addon.guard import alerts, watcher  # noqa: E402
from stiv_addon.overlay import display  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture(autouse=True)
def scene() -> Iterator[None]:
    yield from watched_scene()


def test_blenders_own_move_is_corrected_and_undone_in_one_step() -> None:
    before = names_of_steps()
    move(7.0)
    look()
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02)
    expect_free()
    assert names_of_steps() == [*before, "Move"]
    bpy.ops.ed.undo()
    look()
    assert box().location.x == 0.0
    bpy.ops.ed.redo()
    look()
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02)
    expect_free()


def test_a_clear_result_keeps_its_numbers() -> None:
    move(1 / 3)
    expected = tuple(box().location)
    look()
    assert tuple(box().location) == expected


def test_a_tool_after_a_corrected_one_starts_from_it() -> None:
    move(7.0)
    look()
    move(-1.0)
    look()
    assert box().location.x == pytest.approx(FURTHEST - 1.0, abs=0.02)


def test_edit_mode_is_watched_and_undone_in_one_step() -> None:
    bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode="EDIT")
    bpy.ops.mesh.select_all("EXEC_DEFAULT", True, action="SELECT")
    look()
    move(7.0)
    look()
    expect_free()
    box().update_from_editmode()
    assert max(vertex.co.x for vertex in box().data.vertices) == pytest.approx(2.0, abs=0.02)
    bpy.ops.ed.undo()
    look()
    box().update_from_editmode()
    assert max(vertex.co.x for vertex in box().data.vertices) == 0.5
    bpy.ops.object.mode_set(mode="OBJECT")


def test_sculpting_is_corrected_and_leaves_the_stack_alone() -> None:
    bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode="SCULPT")
    look()
    steps = names_of_steps()
    for vertex in box().data.vertices:
        vertex.co.x += 2.0 if vertex.co.x > 0 else 0.0
    box().data.update()
    bpy.context.view_layer.update()
    look()
    assert max(vertex.co.x for vertex in box().data.vertices) == pytest.approx(2.0, abs=0.02)
    assert min(vertex.co.x for vertex in box().data.vertices) == -0.5
    expect_free()
    assert names_of_steps() == steps
    bpy.ops.object.mode_set(mode="OBJECT")


def test_excluded_pairs_may_intersect_and_all_others_are_guarded() -> None:
    bpy.context.scene.stiv.live_guard = False
    bpy.ops.mesh.primitive_cube_add(size=1, location=(2.5, 0, 2.4))  # stands in the top of the wall
    bpy.context.scene.stiv.live_guard = True
    look()
    assert watcher.problem().pairs
    bpy.ops.stiv.exclude_intersections()
    look()
    assert watcher.problem() is None
    bpy.ops.object.select_all(action="DESELECT")
    box().select_set(True)
    bpy.context.view_layer.objects.active = box()
    move(7.0)
    look()
    assert watcher.problem() is None
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02)


def test_a_new_object_stays_if_clear_and_is_placed_freely_if_not_in_one_step() -> None:
    bpy.ops.mesh.primitive_cube_add("EXEC_DEFAULT", True, location=(0, 8, 0))
    look()
    assert tuple(bpy.context.object.location) == (0, 8, 0)
    steps = names_of_steps()
    bpy.ops.mesh.primitive_cube_add("EXEC_DEFAULT", True, size=1, location=(0.4, 0, 0))
    look()
    assert watcher.problem() is None and watcher.uncorrected() == 0
    expect_free()
    placed = tuple(bpy.data.objects["Cube.001"].location)
    assert 0.9 < np.linalg.norm(np.array(placed)) < 1.2
    assert names_of_steps() == [*steps, "Add Cube"]
    bpy.ops.ed.undo()
    look()
    assert "Cube.001" not in bpy.data.objects
    bpy.ops.ed.redo()
    look()
    assert tuple(bpy.data.objects["Cube.001"].location) == placed
    expect_free()


def test_a_duplicate_is_corrected_in_its_own_step() -> None:
    steps = names_of_steps()
    bpy.ops.object.duplicate_move("EXEC_DEFAULT", True, TRANSFORM_OT_translate={"value": (7, 0, 0)})
    look()
    copy = bpy.data.objects["Box.001"]
    assert copy.location.x == 7.0  # behind the wall, where it is free
    bpy.ops.object.duplicate_move("EXEC_DEFAULT", True, TRANSFORM_OT_translate={"value": (-4.4, 0, 0)})
    look()
    assert bpy.data.objects["Box.002"].location.x == pytest.approx(3.5, abs=0.02)  # on its original's side
    expect_free()
    assert names_of_steps() == [*steps, "Duplicate Objects", "Duplicate Objects"]


def test_an_intersecting_scene_is_guarded_but_for_its_intersections() -> None:
    bpy.context.scene.stiv.live_guard = False
    bpy.ops.mesh.primitive_cube_add(size=1, location=(2.5, 0, 2.4))  # stands in the top of the wall
    bpy.context.scene.stiv.live_guard = True
    look()
    assert watcher.state(bpy.context) == "partial" and watcher.problem().names == ["Cube", "Wall"]
    assert not display.content().alert and not alerts._alert
    bpy.ops.object.select_all(action="DESELECT")
    box().select_set(True)
    bpy.context.view_layer.objects.active = box()
    move(7.0)
    look()
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02) and watcher.state(bpy.context) == "partial"
    bpy.data.objects["Cube"].location.z = 4.0
    bpy.ops.ed.undo_push(message="apart")
    look()
    assert watcher.state(bpy.context) == "guarded"
    bpy.ops.ed.undo()
    look()
    assert bpy.data.objects["Cube"].location.z == np.float32(2.4), "undo restores what the guard left alone"
    assert watcher.state(bpy.context) == "partial"


def test_a_cube_that_stands_on_another_is_guarded_and_needs_no_correction_to_slide() -> None:
    bpy.context.scene.stiv.live_guard = False
    bpy.ops.mesh.primitive_cube_add(size=1, location=(2.5, 0, 2.5))
    cube = bpy.context.object
    bpy.context.scene.stiv.live_guard = True
    look()
    assert watcher.state(bpy.context) == "guarded" and watcher.problem() is None
    for way, place in (((0, 1, 0), (2.5, 1, 2.5)), ((0, 0, -1), (2.5, 1, 2.5)), ((0, 0, 1), (2.5, 1, 3.5))):
        bpy.ops.transform.translate("EXEC_DEFAULT", True, value=way)
        look()
        assert tuple(cube.location) == (place if way == (0, 1, 0) else pytest.approx(place, abs=2e-5))
        assert watcher.state(bpy.context) == "guarded" and watcher.uncorrected() == 0
    bpy.ops.ed.undo()
    bpy.ops.ed.undo()
    look()
    assert tuple(bpy.data.objects["Cube"].location) == (2.5, 1, 2.5) and watcher.state(bpy.context) == "guarded"


def test_a_duplicate_in_edit_mode_is_corrected_in_its_own_step() -> None:
    bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode="EDIT")
    bpy.ops.mesh.select_all("EXEC_DEFAULT", True, action="SELECT")
    look()
    before = names_of_steps()
    bpy.ops.mesh.duplicate_move("EXEC_DEFAULT", True, TRANSFORM_OT_translate={"value": (1.8, 0, 0)})
    look()
    box().update_from_editmode()
    x = [vertex.co.x for vertex in box().data.vertices][8:]
    assert (min(x), max(x)) == pytest.approx((1.0, 2.0), abs=0.02) and max(x) - min(x) == pytest.approx(1.0)
    assert len(names_of_steps()) == len(before) + 1 and watcher.state(bpy.context) == "guarded"
    expect_free()
    bpy.ops.ed.undo()
    look()
    box().update_from_editmode()
    assert len(box().data.vertices) == 8
    bpy.ops.object.mode_set(mode="OBJECT")


def test_objects_that_intersected_before_may_be_joined() -> None:
    bpy.context.scene.stiv.live_guard = False
    bpy.ops.mesh.primitive_cube_add("EXEC_DEFAULT", True, size=1, location=(-3, 0, 0))
    bpy.ops.mesh.primitive_cube_add("EXEC_DEFAULT", True, size=1, location=(-3.5, 0.2, 0.1))
    bpy.context.scene.stiv.live_guard = True
    look()
    assert watcher.state(bpy.context) == "partial"
    for ob in bpy.data.objects:
        ob.select_set(ob.name.startswith("Cube"))
    bpy.ops.object.join("EXEC_DEFAULT", True)
    look()
    assert len(bpy.data.objects) == 3 and watcher.state(bpy.context) == "partial"


def test_results_of_the_own_operators_are_not_corrected() -> None:
    bpy.ops.stiv.move("EXEC_DEFAULT", True, value=(7.0, 0, 0))
    shown = tuple(box().location)
    steps = names_of_steps()
    look()
    assert tuple(box().location) == shown
    assert names_of_steps() == steps


def test_a_cage_is_corrected_by_its_loop_subdivision() -> None:
    bpy.context.scene.stiv.live_guard = False
    bpy.data.objects.remove(box())
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=1)
    bpy.context.object.name = "Box"
    bpy.ops.stiv.loop_add()
    bpy.context.view_layer.objects.active = box()
    bpy.context.scene.stiv.live_guard = True
    bpy.ops.ed.undo_push(message="cage")
    look()
    bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode="EDIT")
    bpy.ops.mesh.select_all("EXEC_DEFAULT", True, action="SELECT")
    look()
    move(1.6)
    look()
    assert watcher.problem() is None
    box().update_from_editmode()
    bpy.context.view_layer.update()
    shown = [vertex.co.x for vertex in bpy.data.objects["Box.loop"].data.vertices]
    assert 1.8 < max(shown) < 2.0
    bpy.ops.object.mode_set(mode="OBJECT")


def test_pairs_that_pass_are_intersections_no_more() -> None:
    bpy.ops.object.duplicate("EXEC_DEFAULT", True)
    look()
    assert watcher.state(bpy.context) == "intersecting"
    bpy.ops.stiv.let_pass("EXEC_DEFAULT", True)
    look()
    assert watcher.state(bpy.context) == "guarded"
    bpy.ops.stiv.let_pass_remove("EXEC_DEFAULT", True, index=0)
    look()
    assert watcher.state(bpy.context) == "intersecting"
