# SPDX-License-Identifier: GPL-3.0-or-later
"""Drop, Settle into Contact, Place, Push Apart and Fit into as a script calls them, with the core."""

import ctypes
import json
from typing import Any

import pytest

bpy = pytest.importorskip("bpy")

from blend_fixtures.scenes.primitives import icosphere  # noqa: E402
from stiv.blender import check_scene  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture(autouse=True)
def empty_scene() -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_plane_add(size=20)
    bpy.context.object.name = "Floor"
    bpy.context.scene.stiv.separation = 0.01


def add_ball(name: str, location: Any, select: bool = True) -> Any:
    ball = icosphere(2)
    data = bpy.data.meshes.new(name)
    data.from_pydata(ball.vertices.tolist(), [], [list(face) for face in ball.faces])
    ob = bpy.data.objects.new(name, data)
    ob.location = location
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.update()
    ob.select_set(select)
    bpy.context.view_layer.objects.active = ob
    bpy.data.objects["Floor"].select_set(False)
    return ob


def last() -> dict[str, Any]:
    result: dict[str, Any] = json.loads(bpy.context.window_manager.stiv_last_edit)
    return result


def test_drop_is_one_undo_step() -> None:
    add_ball("Ball", (0, 0, 4))
    bpy.ops.ed.undo_push(message="start")
    assert bpy.ops.stiv.drop("EXEC_DEFAULT", True, turn=False) == {"FINISHED"}
    assert bpy.data.objects["Ball"].location.z == pytest.approx(1.01, abs=0.01) and last()["changed"] == ["Ball"]
    assert bpy.context.window_manager.stiv_check.summary == "Dropped 1 of 1"
    bpy.ops.ed.undo()
    assert bpy.data.objects["Ball"].location.z == 4


def test_an_object_that_stays_is_named_with_the_way_out() -> None:
    add_ball("Suzanne", (0, 30, 4))
    bpy.ops.stiv.drop()
    assert bpy.context.window_manager.stiv_check.summary == "Suzanne: nothing below; add a floor"
    bpy.ops.stiv.settle_contact()
    assert bpy.context.window_manager.stiv_check.summary == "Suzanne: nothing near; raise Max Distance"
    assert bpy.ops.stiv.drop(ground=True) == {"FINISHED"}


def test_a_message_fits_the_status_bar_and_the_tab_shows_all(capfd: pytest.CaptureFixture[str]) -> None:
    names = ["A prop with a rather long name", "Another prop with a long name"]
    for number, name in enumerate(names):
        add_ball(name, (0, 30 + 4 * number, 4))
    bpy.ops.stiv.drop()
    ctypes.CDLL(None).fflush(None)  # Blender prints reports
    reported = next(line for line in capfd.readouterr().out.splitlines() if line.startswith("Warning: "))
    assert reported == f"Warning: {names[0]}: nothing below; add a floor"
    assert all(name in bpy.context.window_manager.stiv_check.summary for name in names)


def test_the_view_is_straight_down_without_a_window() -> None:
    ball = add_ball("Ball", (0, 0, 4))
    bpy.context.scene.gravity = (1, 0, 0)
    assert bpy.ops.stiv.drop() == {"CANCELLED"}
    assert bpy.ops.stiv.drop(direction="VIEW", turn=False) == {"FINISHED"} and ball.location.z < 1.1


def test_push_apart_parts_and_reports() -> None:
    add_ball("A", (0, 0, 3))
    add_ball("B", (0.5, 0.2, 3.4))
    assert check_scene(bpy.context).pairs
    assert bpy.ops.stiv.push_apart() == {"FINISHED"} and last()["changed"] == ["A", "B"]
    assert not check_scene(bpy.context).pairs


def test_place_adds_copies_in_one_undo_step() -> None:
    add_ball("Ball", (0, 0, 4)).scale = (0.5, 0.5, 0.5)
    bpy.data.objects["Floor"].select_set(True)
    bpy.ops.ed.undo_push(message="start")
    assert bpy.ops.stiv.place("EXEC_DEFAULT", True, count=5) == {"FINISHED"}
    assert bpy.context.window_manager.stiv_check.summary == "Placed 5 of 5" and len(bpy.data.objects) == 7
    assert not check_scene(bpy.context).pairs
    bpy.ops.ed.undo()
    assert len(bpy.data.objects) == 2


@pytest.mark.shared
def test_fit_into_names_objects_without_room() -> None:
    bpy.ops.mesh.primitive_cube_add(size=2.2, location=(0, 0, 5))
    box = bpy.context.object
    balls = [add_ball("A", (5, 0, 3)), add_ball("B", (8, 0, 3))]
    for ob in (*balls, box):
        ob.select_set(True)
    bpy.context.view_layer.objects.active = box
    assert bpy.ops.stiv.fit_into() == {"FINISHED"}
    assert bpy.context.window_manager.stiv_check.summary == "Packed 1 of 2; B: does not fit"
    bpy.ops.stiv.fit_into(scale=True)
    assert bpy.context.window_manager.stiv_check.summary.startswith("Packed 2 of 2; scaled by 0.")


def test_refusals_name_the_object_and_change_nothing() -> None:
    ball = add_ball("Ball", (0, 0, 0.5))
    with pytest.raises(RuntimeError, match="Ball: intersects Floor; use Push Apart"):
        bpy.ops.stiv.drop()
    assert tuple(ball.location) == (0, 0, 0.5)
    bpy.ops.object.mode_set(mode="EDIT")
    assert not bpy.ops.stiv.drop.poll()
