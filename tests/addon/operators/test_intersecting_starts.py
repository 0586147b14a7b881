# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that intersect at the start: Separate, Let These Pass, exclusions that do not glue, and those that touch."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
blender = pytest.importorskip("stiv.blender")

from stiv.task import Task  # noqa: E402
from stiv_addon.modal.drag_calls import DragCalls  # noqa: E402
from stiv_addon.modal.drag_end import Progress  # noqa: E402
from stiv_addon.modal.drag_loop import DragLoop  # noqa: E402
from stiv_addon.modal.event import Event  # noqa: E402
from stiv_addon.modal.pointer import Pointer  # noqa: E402
from stiv_addon.modal.request import Request  # noqa: E402
from stiv_addon.modal.state import State  # noqa: E402
from stiv_addon.operators.transform.constraint import Constraint  # noqa: E402
from stiv_addon.operators.transform.transform_operator import apply_values, begin_edit, make_motion  # noqa: E402
from stiv_addon.scene.frame import read_frame  # noqa: E402
from stiv_addon.transform.translation import Translation  # noqa: E402

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


def cube_on_floor() -> Any:
    """The default cube, exactly on a plane; selected."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_plane_add(size=20.0)
    bpy.ops.mesh.primitive_cube_add(location=(0.0, 0.0, 1.0))
    return bpy.context.active_object


@pytest.mark.parametrize(
    ("operator", "values", "end"),
    [
        ("move", {"value": (2.0, 0.0, 0.0)}, (2.0, 0.0, 1.0)),
        ("move", {"value": (2.0, 1.0, -1.0)}, (2.0, 1.0, 1.0)),
        ("move", {"value": (0.0, 0.0, -1.0)}, (0.0, 0.0, 1.0)),
        ("move", {"value": (3.0, 0.0, -1.0), "constraint_axis": (True, False, False)}, (3.0, 0.0, 1.0)),
        ("rotate", {"angle": 0.5}, (0.0, 0.0, 1.0)),
        ("scale", {"value": (0.5, 0.5, 0.5)}, (0.0, 0.0, 1.0)),
    ],
)
def test_what_touches_is_edited_in_one_undo_step(operator: str, values: dict, end: tuple[float, ...]) -> None:
    cube_on_floor()
    bpy.ops.ed.undo_push(message="start")
    assert getattr(bpy.ops.stiv, operator)("EXEC_DEFAULT", True, **values) == {"FINISHED"}
    assert blender.check_scene(bpy.context).pairs == ()
    first = tuple(bpy.data.objects["Cube"].location)
    assert first == pytest.approx(end, abs=1e-5)
    bpy.ops.ed.undo()
    assert tuple(bpy.data.objects["Cube"].location) == (0.0, 0.0, 1.0)
    assert getattr(bpy.ops.stiv, operator)("EXEC_DEFAULT", True, **values) == {"FINISHED"}
    assert tuple(bpy.data.objects["Cube"].location) == first


def test_consecutive_edits_stay_on_the_floor() -> None:
    cube = cube_on_floor()
    for way in ((3.0, 0.0, 0.0), (-2.0, 4.0, -1.0), (0.0, -6.0, 0.0), (5.0, 1.0, -0.1)):
        bpy.ops.stiv.move(value=way)
        assert cube.location.z == pytest.approx(1.0, abs=1e-5)
    assert tuple(cube.location) == pytest.approx((6.0, -1.0, 1.0), abs=1e-4)
    assert blender.check_scene(bpy.context).pairs == ()


def test_an_edit_that_fails_after_its_start_restores_what_touched(monkeypatch: pytest.MonkeyPatch) -> None:
    cube = cube_on_floor()

    def failing(edit: Any, motion: Any, path: Any = None) -> Any:
        assert cube.location.z > 1.0
        raise MemoryError
        yield

    monkeypatch.setattr(blender.BlenderEdit, "apply_steps", failing)
    with pytest.raises(RuntimeError, match="Unexpected error"):
        bpy.ops.stiv.move(value=(1.0, 0.0, 0.0))
    assert tuple(cube.location) == (0.0, 0.0, 1.0)


@pytest.mark.parametrize("end", [Task.close, Task.abandon, Task.leave])
def test_applied_values_restore_what_touched_when_they_are_left(end: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """As when Esc ends typed values of a drag, which are solved in jobs."""
    cube = cube_on_floor()

    def endless(edit: Any, motion: Any, path: Any = None) -> Any:
        while True:
            yield None

    monkeypatch.setattr(blender.BlenderEdit, "apply_steps", endless)
    transform = Translation(np.array((1.0, 0.0, 0.0)))
    request = Request("move", "selected", True, "slide")

    def motion_of(transform: Any, frame: Any) -> Any:
        return make_motion(transform, frame, None, Constraint())

    reporter = SimpleNamespace(report=lambda kind, text: None)
    task = Task(apply_values(reporter, bpy.context, request, transform, motion_of))
    for _ in range(50):
        assert not task.advance(0.1)
    assert cube.location.z > 1.0
    end(task)
    assert tuple(cube.location) == (0.0, 0.0, 1.0)


def drag_of(places: list[tuple[float, float]]) -> DragLoop:
    """A drag of the selection to consecutive places in the plane y = 0; at rest there."""

    def transform_of(state: State) -> Translation:
        x, z = state.pointer.effective
        return Translation(np.array((x, 0.0, z)))

    def motion_of(transform: Any, state: State) -> Any:
        return make_motion(transform, read_frame(bpy.context), None, Constraint())

    calls = DragCalls(
        lambda request: begin_edit(bpy.context, request, 0.5), transform_of, motion_of, lambda *_: None, Task
    )
    drag = DragLoop(calls, State(Pointer.at((0.0, 0.0)), Request("move", "selected", True, "slide")))
    for place in places:
        drag.handle(Event("MOUSEMOVE", "NOTHING", place))
        drag.tick()
        while not drag.at_rest:
            drag.tick()
    return drag


@pytest.mark.parametrize("places", [[], [(1.0, 0.0)], [(1.0, 0.0), (2.0, -1.0)], [(0.5, 2.0), (1.0, -3.0)]])
def test_a_cancelled_drag_restores_what_touched(places: list[tuple[float, float]]) -> None:
    cube = cube_on_floor()
    drag = drag_of(places)
    drag.handle(Event("ESC", "PRESS", (0.0, 0.0)))
    assert drag.progress is Progress.CANCELLED and drag.error is None
    assert tuple(cube.location) == (0.0, 0.0, 1.0)


def test_a_confirmed_drag_slides_what_touched() -> None:
    cube = cube_on_floor()
    drag = drag_of([(1.0, 0.0), (2.0, -1.0), (3.0, -1.0)])
    drag.handle(Event("LEFTMOUSE", "PRESS", (3.0, -1.0)))
    while not drag.progress.ended:
        drag.tick()
    assert drag.progress is Progress.FINISHED
    assert tuple(cube.location) == pytest.approx((3.0, 0.0, 1.0), abs=1e-5)
    assert blender.check_scene(bpy.context).pairs == ()
