# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that intersect at the start: Separate, Let These Pass, and exclusions that do not glue."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
blender = pytest.importorskip("stiv.blender")
frame_check = pytest.importorskip("stiv.blender.verify.frame_check")

pytestmark = pytest.mark.usefixtures("registered")

START = np.array((1.6, 0.1, 0.05))


@pytest.fixture(autouse=True)
def scene() -> Any:
    """Two unit balls that overlap; the second one is selected."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    for name, place in (("Ball", (0, 0, 0)), ("Other", START)):
        bpy.ops.mesh.primitive_uv_sphere_add(location=place)
        bpy.context.active_object.name = name


def overlap() -> float:
    """Radii minus the distance of the centers."""
    return 2.0 - float(np.linalg.norm(bpy.data.objects["Other"].location - bpy.data.objects["Ball"].location))


def move(*value: float) -> np.ndarray:
    bpy.ops.stiv.move(value=value)
    return np.array(bpy.data.objects["Other"].location) - START


def test_scripts_get_the_error_and_nothing_moves() -> None:
    with pytest.raises(RuntimeError, match="already intersects"):
        bpy.ops.stiv.move(value=(1.0, 0.0, 0.0))
    assert np.allclose(bpy.data.objects["Other"].location, START)


@pytest.mark.parametrize("way", [(5.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.1, 0.4, -0.3), (0.05, 2.0, 0.0), (0.0, 0.0, 3.0)])
def test_excluded_objects_part_in_every_direction(way: tuple[float, float, float]) -> None:
    bpy.ops.stiv.exclude_intersections()
    assert np.allclose(move(*way), way, atol=1e-5)


def test_excluded_objects_do_not_go_deeper_and_are_guarded_once_apart() -> None:
    before = overlap()
    bpy.ops.stiv.exclude_intersections()
    move(-0.5, 0.0, 0.0)
    assert overlap() <= before + 1e-5
    move(1.0, 0.0, 0.0)
    assert blender.check_scene(bpy.context).pairs == ()
    move(-2.0, 0.0, 0.0)
    assert blender.check_scene(bpy.context).pairs == ()
    assert -0.05 < overlap() < 0.05


def test_separate_moves_by_the_overlap_in_one_undo_step() -> None:
    bpy.ops.ed.undo_push(message="start")
    before = overlap()
    assert bpy.ops.stiv.separate("EXEC_DEFAULT", True) == {"FINISHED"}
    assert blender.check_scene(bpy.context).pairs == ()
    moved = np.linalg.norm(np.array(bpy.data.objects["Other"].location) - START)
    assert 0.9 * before <= moved <= 1.1 * before
    assert bpy.ops.stiv.separate() == {"CANCELLED"}
    bpy.ops.ed.undo()
    assert np.allclose(bpy.data.objects["Other"].location, START)


def test_an_object_that_intersects_itself_may_pass_through_itself() -> None:
    ball, other = bpy.data.objects["Ball"], bpy.data.objects["Other"]
    bpy.context.view_layer.objects.active = ball
    with bpy.context.temp_override(active_object=ball, selected_editable_objects=[ball, other]):
        bpy.ops.object.join()
    ball.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    vertices = ball.data.vertices
    vertices.foreach_set("select", np.arange(len(vertices)) >= len(vertices) // 2)
    bpy.ops.object.mode_set(mode="EDIT")
    assert deviation(ball) > 0.1  # one half would cut the other deeper
    assert bpy.ops.stiv.let_pass() == {"FINISHED"} and bpy.ops.stiv.let_pass() == {"CANCELLED"}
    assert deviation(ball) < 1e-5


def deviation(ob: Any) -> float:
    """Largest distance of a vertex from where Blender's own Move would put it."""

    def places() -> np.ndarray:
        ob.update_from_editmode()
        return np.array([vertex.co for vertex in ob.data.vertices])

    start = places()
    selected = np.array([vertex.select for vertex in ob.data.vertices])
    bpy.ops.stiv.move(value=(-0.5, 0.0, 0.0))
    return float(np.abs(places() - start + np.outer(selected, (0.5, 0.0, 0.0))).max())


def test_a_pair_that_may_pass_is_not_tested_and_named_by_checks_even_in_a_file(tmp_path: Path) -> None:
    assert bpy.ops.stiv.let_pass() == {"FINISHED"}
    assert bpy.ops.stiv.let_pass() == {"CANCELLED"}
    way = (-0.8, 0.2, 0.0)
    assert np.allclose(move(*way), way, atol=1e-6)
    assert "Ball / Other: excluded" in bpy.context.window_manager.stiv_check.left_out
    bpy.ops.stiv.check()
    lines = bpy.context.window_manager.stiv_check.summary.splitlines()
    assert lines[0] == "No intersections" and "Ball / Other: excluded, may pass" in lines
    bpy.data.objects["Other"].name = "Renamed"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "passing.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "passing.blend"))
    (look,) = frame_check.check_frames(bpy.context, evaluations=("viewport",))
    assert look.findings == ()
    assert look.notes == ('excluded, because they may pass through each other: "Ball" and "Renamed"',)
    assert bpy.ops.stiv.let_pass_remove(index=0) == {"FINISHED"}
    (look,) = frame_check.check_frames(bpy.context, evaluations=("viewport",))
    assert look.findings and look.notes == ()
    with pytest.raises(RuntimeError, match="Pair 0 does not exist"):
        bpy.ops.stiv.let_pass_remove(index=0)
