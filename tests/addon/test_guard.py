# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard in Blender: handlers run here, timers do not, so that each test looks by itself."""

import time
from collections.abc import Iterator
from typing import Any

import pytest

bpy = pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

import stiv_addon  # noqa: E402
from stiv.blender import check_scene  # noqa: E402
from stiv_addon.guard import undo_steps, watching  # noqa: E402
from stiv_addon.guard.decision import STILL  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")

FURTHEST = 1.5  # of the box's centre: the wall's face is at 2, the box is 1 wide


@pytest.fixture(autouse=True)
def scene() -> Iterator[None]:
    """A box, selected, in front of a wall, watched over; the undo history begins with it."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(2.5, 0, 0), scale=(1, 4, 4))
    bpy.context.object.name = "Wall"
    bpy.ops.mesh.primitive_cube_add(size=1)
    bpy.context.object.name = "Box"
    bpy.context.scene.stiv.live_guard = True
    bpy.ops.ed.undo_push(message="start")
    look()
    yield
    bpy.context.scene.stiv.live_guard = False


def look() -> None:
    """What the timer would do, until there is nothing to do."""
    deadline = time.monotonic() + 3 * STILL + 20
    while watching.look() is not None:
        assert time.monotonic() < deadline, "the guard never settles"
        time.sleep(0.02)


def box() -> Any:
    return bpy.data.objects["Box"]


def move(x: float) -> None:
    bpy.ops.transform.translate("EXEC_DEFAULT", True, value=(x, 0, 0))


def expect_free() -> None:
    assert check_scene(bpy.context).pairs == ()


def names_of_steps() -> list[str]:
    return [line.split("name=")[1].strip("'") for line in undo_steps._printed().splitlines() if "name=" in line]


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


def test_the_corrected_state_is_in_the_stack_also_with_the_guard_off() -> None:
    move(7.0)
    look()
    corrected = box().location.x
    bpy.ops.ed.undo()
    bpy.context.scene.stiv.live_guard = False
    bpy.ops.ed.redo()
    assert box().location.x == corrected


def test_what_meets_nothing_keeps_its_numbers() -> None:
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


def test_a_script_is_corrected_in_a_step_of_its_own() -> None:
    before = names_of_steps()
    box().location.x = 2.4
    bpy.context.view_layer.update()
    look()
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02)
    assert names_of_steps() == [*before, watching.STEP_NAME]
    bpy.ops.ed.undo()
    look()
    assert box().location.x == 0.0


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


def test_undo_to_before_the_guard_was_on_turns_it_off() -> None:
    bpy.context.scene.stiv.live_guard = False
    move(2.4)
    move(-2.4)
    bpy.context.scene.stiv.live_guard = True
    bpy.ops.ed.undo_push(message="guard on")
    look()
    bpy.ops.ed.undo()
    bpy.ops.ed.undo()
    look()
    assert box().location.x == pytest.approx(2.4)
    assert not bpy.context.scene.stiv.live_guard
    assert watching.problem() == ""


def test_what_undo_restores_from_a_raw_state_is_corrected_and_the_stack_left_alone() -> None:
    watching._watch.working = True  # as while the guard is off, with its switch on
    move(2.4)
    move(1.0)
    watching._watch.working = False
    bpy.ops.ed.undo()
    look()
    expect_free()
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02)
    assert names_of_steps() == ["start", "Move", "Move"]


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


def test_a_scene_that_intersects_is_named_and_watched_again_once_it_is_free() -> None:
    bpy.context.scene.stiv.live_guard = False
    box().location.x = 2.4
    bpy.context.view_layer.update()
    bpy.context.scene.stiv.live_guard = True
    look()
    assert "intersect: Box, Wall" in watching.problem()
    assert box().location.x == pytest.approx(2.4)  # nothing was written
    move(-3.4)
    look()
    assert watching.problem() == ""
    move(7.0)
    look()
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02)


def test_what_may_intersect_is_excluded_and_everything_else_is_guarded() -> None:
    bpy.context.scene.stiv.live_guard = False
    bpy.ops.mesh.primitive_cube_add(size=1, location=(2.5, 0, 2.5))  # stands in the top of the wall
    bpy.context.scene.stiv.live_guard = True
    look()
    assert "intersect" in watching.problem()
    bpy.ops.stiv.exclude_intersections()
    look()
    assert watching.problem() == ""
    bpy.ops.object.select_all(action="DESELECT")
    box().select_set(True)
    bpy.context.view_layer.objects.active = box()
    move(7.0)
    look()
    assert watching.problem() == ""
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02)


def test_a_changed_structure_is_accepted_if_free_and_told_if_not() -> None:
    bpy.ops.mesh.primitive_cube_add("EXEC_DEFAULT", True, location=(0, 8, 0))
    look()
    assert watching.problem() == ""
    bpy.ops.mesh.primitive_cube_add("EXEC_DEFAULT", True, size=1, location=(0.4, 0, 0))
    look()
    assert "not corrected" in watching.problem() and "added" in watching.problem()
    bpy.ops.ed.undo()
    look()
    assert watching.problem() == ""


def test_what_our_own_operators_write_is_not_corrected_again() -> None:
    bpy.ops.stiv.move("EXEC_DEFAULT", True, value=(7.0, 0, 0))
    shown = tuple(box().location)
    steps = names_of_steps()
    look()
    assert tuple(box().location) == shown
    assert names_of_steps() == steps


def test_a_cage_that_shows_a_loop_subdivision_is_corrected_by_what_is_seen() -> None:
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
    assert watching.problem() == ""
    box().update_from_editmode()
    bpy.context.view_layer.update()
    shown = [vertex.co.x for vertex in bpy.data.objects["Box.loop"].data.vertices]
    assert 1.8 < max(shown) < 2.0
    bpy.ops.object.mode_set(mode="OBJECT")


def test_looking_again_does_nothing() -> None:
    move(7.0)
    look()
    shown, steps = tuple(box().location), names_of_steps()
    for _ in range(3):
        watching._noted()
        look()
    assert tuple(box().location) == shown
    assert names_of_steps() == steps


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_its_own_reading_gives_it_nothing_to_look_at(mode: str) -> None:
    """Blender marks a mesh that was read in Edit Mode as changed: the guard looked at it once a second, for ever."""
    bpy.ops.object.mode_set(mode=mode)
    for _ in range(2):
        look()
        noted = watching._watch.updates
        bpy.context.view_layer.update()
        assert watching._watch.updates == noted
        move(0.1)


def test_a_file_that_is_loaded_is_watched_over_if_it_says_so(tmp_path: Any) -> None:
    path = str(tmp_path / "guarded scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.context.scene.stiv.live_guard = False
    bpy.ops.wm.open_mainfile(filepath=path)
    assert bpy.app.timers.is_registered(watching.look)
    look()
    bpy.ops.ed.undo_push(message="loaded")
    look()
    bpy.context.view_layer.objects.active = box()
    move(7.0)
    look()
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02)


def test_turned_off_it_leaves_no_timer_and_does_nothing() -> None:
    bpy.context.scene.stiv.live_guard = False
    assert not bpy.app.timers.is_registered(watching.look)
    move(2.4)
    assert not bpy.app.timers.is_registered(watching.look)
    assert box().location.x == pytest.approx(2.4)


def test_unregistering_leaves_no_handler_and_no_timer() -> None:
    watching._noted()
    stiv_addon.unregister()
    try:
        for name in watching.HANDLERS:
            assert not any("stiv" in each.__module__ for each in getattr(bpy.app.handlers, name))
        assert not bpy.app.timers.is_registered(watching.look)
    finally:
        stiv_addon.register()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[*  ]   2 {0x1} type='Global Undo', name='Move'\n", (2, "0x1", "Move")),
        ("[    ]   0 {0x5} type='A', name='a'\n[*#M ]  11 {0x6} type='B', name='Z: -3 m'\n", (11, "0x6", "Z: -3 m")),
        ("[* ] 1 {0x6} type='B', name='it's'\n", (1, "0x6", "it's")),
        ("nothing of the kind", None),
    ],
)
def test_the_active_step_is_read_from_blenders_list(text: str, expected: Any) -> None:
    assert undo_steps.parse(text) == expected
