# SPDX-License-Identifier: GPL-3.0-or-later
"""Results that the live guard cannot correct: it reports and counts them, and an operator restores the clear state."""

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

from guarding import box, expect_free, look, move, names_of_steps, watched_scene  # noqa: E402

from stiv_addon.guard import alerts, watcher  # noqa: E402
from stiv_addon.overlay import display  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture(autouse=True)
def scene() -> Iterator[None]:
    yield from watched_scene()


def wrap_box() -> None:
    """A Shrinkwrap modifier, which no edit follows, with an influence of a thousandth on one vertex."""
    bpy.ops.mesh.primitive_plane_add(location=(0, 0, -3))
    box().vertex_groups.new(name="Wrapped").add([0], 0.001, "REPLACE")
    modifier = box().modifiers.new("Wrap", "SHRINKWRAP")
    modifier.target, modifier.vertex_group = bpy.context.object, "Wrapped"


def rig_box() -> None:
    bpy.ops.object.armature_add(location=(0, 0, -3))
    modifier = box().modifiers.new("Armature", "ARMATURE")
    modifier.object, modifier.show_in_editmode = bpy.context.object, False
    bpy.context.object.name = "Rig"
    box().vertex_groups.new(name="Bone").add(range(8), 1.0, "REPLACE")


def watched_again(change: Any) -> None:
    """The scene changed while the guard was off; then it is on, with Box as the only selected object."""
    bpy.context.scene.stiv.live_guard = False
    change()
    bpy.ops.object.select_all(action="DESELECT")
    box().select_set(True)
    bpy.context.view_layer.objects.active = box()
    bpy.context.scene.stiv.live_guard = True
    bpy.ops.ed.undo_push(message="again")
    look()


def positions() -> np.ndarray:
    if box().mode == "EDIT":
        box().update_from_editmode()
    return np.array([vertex.co for vertex in box().data.vertices])


def shown_in_status_bar() -> tuple[list[str], list[str], bool]:
    """The guard's labels and buttons, and whether they are red."""
    drawn: tuple[list[str], list[str]] = ([], [])
    row = SimpleNamespace(
        alert=False, label=lambda text, icon: drawn[0].append(text), operator=lambda name: drawn[1].append(name)
    )
    header = type("Header", (), {"_draw_orig": lambda self, context: None})()
    header.layout = SimpleNamespace(row=lambda align: row)
    alerts.draw_alert(header, bpy.context)
    return *drawn, row.alert


def test_a_mesh_that_cannot_be_corrected_is_named_counted_and_restored() -> None:
    watched_again(wrap_box)
    bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode="EDIT")
    bpy.ops.mesh.select_all("EXEC_DEFAULT", True, action="SELECT")
    look()
    before, steps = positions(), names_of_steps()
    assert not bpy.ops.stiv.guard_revert.poll()
    move(1.8)
    look()
    problem = watcher.problem()
    assert problem.names == ["Box", "Wall"] and 'Box: Shrinkwrap "Wrap" projects onto' in problem.reason
    assert watcher.uncorrected() == 1
    labels, buttons, is_red = shown_in_status_bar()
    assert is_red and buttons == ["stiv.guard_revert"]
    faces = {(each.object, each.number) for pair in problem.pairs for each in (pair.first, pair.second)}
    assert labels == [f"Live guard: Box cuts Wall, {len(faces)} faces"]
    assert display.content().alert[0] == f"Box cuts Wall, {len(faces)} faces" and len(display.content().intersecting)
    move(0.1)
    look()
    assert watcher.uncorrected() == 2
    moved = positions()

    assert bpy.ops.stiv.guard_revert("EXEC_DEFAULT", True) == {"FINISHED"}
    look()
    assert np.array_equal(positions(), before)
    expect_free()
    assert watcher.problem() is None and watcher.uncorrected() == 2
    assert not display.content().alert and not alerts._alert
    assert names_of_steps() == [*steps, "Move", "Move", "Restore Before Collision"]
    bpy.ops.ed.undo()
    look()
    assert np.array_equal(positions(), moved)
    assert watcher.problem().names == ["Box", "Wall"] and watcher.uncorrected() == 2
    bpy.ops.object.mode_set(mode="OBJECT")


def test_a_scene_with_a_moved_rig_is_not_clear_without_a_test() -> None:
    """The object Rig has no surface; its effect on the box was once not tested. A constraint prevents corrections."""

    def scale_by_rig() -> None:
        rig_box()
        rig = bpy.data.objects["Rig"]
        rig.location.z, rig.pose.bones["Bone"].scale = 0.0, (2.0, 2.0, 2.0)
        rig.constraints.new("LIMIT_SCALE")

    watched_again(scale_by_rig)
    bpy.data.objects["Rig"].location.x = -1.5
    bpy.ops.ed.undo_push(message="rig")
    look()
    assert watcher.problem().names == ["Box", "Wall"] and "Rig cannot be corrected" in watcher.problem().reason
    assert bpy.ops.stiv.guard_revert("EXEC_DEFAULT", True) == {"FINISHED"}
    look()
    assert watcher.problem() is None and bpy.data.objects["Rig"].location.x == 0.0


def test_a_pose_and_a_placement_are_restored_in_one_step() -> None:
    """The guard cannot correct the pose of a rig with a driver that depends on itself."""

    def rig_with_cycle() -> None:
        rig_box()
        rig = bpy.data.objects["Rig"]
        variable = (driver := rig.pose.bones["Bone"].driver_add("scale", 0).driver).variables.new()
        variable.targets[0].id, variable.targets[0].data_path = rig, 'pose.bones["Bone"].scale[0]'
        driver.expression = variable.name

    watched_again(rig_with_cycle)
    bpy.data.objects["Rig"].pose.bones["Bone"].location.x = 2.0
    bpy.ops.ed.undo_push(message="pose")
    look()
    assert "a driver of Bone depends on itself" in watcher.problem().reason
    box().location.y = 1.0
    bpy.ops.ed.undo_push(message="move")
    look()
    assert bpy.ops.stiv.guard_revert("EXEC_DEFAULT", True) == {"FINISHED"}
    look()
    assert watcher.problem() is None
    assert bpy.data.objects["Rig"].pose.bones["Bone"].location.x == 0.0 and box().location.y == 0.0


def test_the_frame_of_the_clear_state_is_restored() -> None:
    box().keyframe_insert("location", frame=1)
    box().location.x = 2.5
    box().keyframe_insert("location", frame=20)
    bpy.context.scene.frame_set(1)
    look()
    bpy.context.scene.frame_set(20)
    look()
    assert watcher.problem().names == ["Box", "Wall"] and watcher.uncorrected() == 0
    assert bpy.ops.stiv.guard_revert("EXEC_DEFAULT", True) == {"FINISHED"}
    look()
    assert bpy.context.scene.frame_current == 1 and watcher.problem() is None


def test_changed_topology_is_refused_by_name_and_an_added_object_is_left_and_named() -> None:
    bpy.ops.object.duplicate("EXEC_DEFAULT", True)
    look()
    assert watcher.problem().reason == "Box.001: is in the place of Box; move it"
    assert watcher.state(bpy.context) == "intersecting"
    box().location.y = 0.1
    bpy.ops.ed.undo_push(message="moved")
    look()
    assert bpy.ops.stiv.guard_revert("EXEC_DEFAULT", True) == {"FINISHED"}
    look()
    assert box().location.y == 0.0
    assert watcher.problem().names == ["Box", "Box.001"]
    mesh = box().data
    mesh.vertices.add(1)
    mesh.update()
    with pytest.raises(RuntimeError, match="Box: its structure has changed; use Undo instead"):
        bpy.ops.stiv.guard_revert("EXEC_DEFAULT", True)


def test_a_stroke_is_restored_in_sculpt_mode_and_undo_preserves_the_mesh() -> None:
    watched_again(wrap_box)
    bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode="SCULPT")
    look()
    before = positions()
    for vertex in box().data.vertices:
        vertex.co.x += 1.8
    box().data.update()
    bpy.context.view_layer.update()
    look()
    assert watcher.problem().names == ["Box", "Wall"]
    assert bpy.ops.stiv.guard_revert("EXEC_DEFAULT", True) == {"FINISHED"}
    look()
    assert np.array_equal(positions(), before) and watcher.problem() is None
    expect_free()
    bpy.ops.ed.undo()
    look()
    assert np.array_equal(positions(), before)
    bpy.ops.object.mode_set(mode="OBJECT")
