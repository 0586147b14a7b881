# SPDX-License-Identifier: GPL-3.0-or-later
"""Check, repair, contract, expand and settle as a script calls them, with the core."""

import json
import time
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

import bmesh  # noqa: E402

from blend_fixtures.scenes.primitives import icosphere  # noqa: E402
from blend_fixtures.scenes.tangled import hairpin  # noqa: E402
from stiv import deadlines  # noqa: E402
from stiv.blender import check_scene  # noqa: E402
from stiv_addon.operators.repair.exclusions import excluded_count  # noqa: E402
from stiv_addon.operators.repair.repair import STIV_OT_repair  # noqa: E402
from stiv_addon.operators.repair.reshape import ReshapeOperator  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture(autouse=True)
def empty_scene() -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)


def add(name: str, vertices: Any, faces: Any, location: Any = (0, 0, 0), select: bool = True) -> Any:
    data = bpy.data.meshes.new(name)
    data.from_pydata([tuple(v) for v in vertices], [], [tuple(f) for f in faces])
    ob = bpy.data.objects.new(name, data)
    ob.location = location
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.update()
    ob.select_set(select)
    bpy.context.view_layer.objects.active = ob
    return ob


def add_tube() -> Any:
    tube = hairpin(0.28, rings=24, sides=8)
    return add("Tube", tube.positions, tube.surface.triangles.tolist())


def positions(ob: Any) -> np.ndarray:
    return np.array([v.co for v in ob.data.vertices])


def last() -> dict[str, Any]:
    result: dict[str, Any] = json.loads(bpy.context.window_manager.stiv_last_edit)
    return result


def test_repair_is_one_undo_step_and_reports() -> None:
    tube = add_tube()
    before = positions(tube)
    bpy.ops.ed.undo_push(message="start")
    assert bpy.ops.stiv.repair("EXEC_DEFAULT", True) == {"FINISHED"}
    assert check_scene(bpy.context).pairs == ()
    said = last()
    assert (said["status"], said["changed"], said["pairs_left"]) == ("repaired", True, 0)
    assert said["pairs_before"] > 60 and 0 < said["deviation"] < 0.02
    bpy.ops.ed.undo()
    assert np.array_equal(positions(bpy.data.objects["Tube"]), before)


def test_a_rejected_repair_raises_and_names_the_pairs() -> None:
    ball = icosphere(1)
    one, two = add("One", ball.vertices, ball.faces), add("Two", ball.vertices, ball.faces)
    with pytest.raises(RuntimeError, match="triangles coincide"):
        bpy.ops.stiv.repair()
    assert np.array_equal(positions(one), positions(two))
    assert last()["status"] == "refused" and last()["pairs"][0] == [["One", "face", 0], ["Two", "face", 0]]


def test_contract_expand_and_settle_use_their_properties() -> None:
    tube = add_tube()
    before = positions(tube)
    assert bpy.ops.stiv.contract(steps=12, until_free=True) == {"FINISHED"}
    assert check_scene(bpy.context).pairs == ()
    far = np.linalg.norm(positions(tube) - before)
    assert bpy.ops.stiv.expand(amount=0.5) == {"FINISHED"}
    half = np.linalg.norm(positions(tube) - before)
    assert bpy.ops.stiv.expand() == {"FINISHED"}
    near = np.linalg.norm(positions(tube) - before)
    assert far > half > near
    bpy.ops.stiv.settle(rounds=2, smoothness=0.01)
    assert np.linalg.norm(positions(tube) - before) <= near
    assert check_scene(bpy.context).pairs == ()


def test_a_time_limit_keeps_what_is_done_or_changes_nothing(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(deadlines, "LEAST_TIME", 1e-9)
    tube = add_tube()
    assert bpy.ops.stiv.contract(steps=12, time_limit=1e-6) == {"FINISHED"}
    assert (last()["status"], last()["changed"]) == ("budget", True)
    assert "time limit reached, result so far kept; run it again to continue" in capfd.readouterr().out
    before = positions(tube)
    with pytest.raises(RuntimeError, match="nothing changed; allow more time, or select fewer objects"):
        bpy.ops.stiv.contract(steps=12, until_free=True, time_limit=1e-6)
    assert np.array_equal(positions(tube), before)
    assert bpy.ops.stiv.contract(steps=12, until_free=True, time_limit=0) == {"FINISHED"}
    assert last()["status"] == "contracted" and check_scene(bpy.context).pairs == ()


def test_without_a_rest_shape_expand_reports_it() -> None:
    add("Ball", icosphere(1).vertices, icosphere(1).faces)
    with pytest.raises(RuntimeError, match="Ball: it has no rest shape"):
        bpy.ops.stiv.expand()
    with pytest.raises(RuntimeError, match="Ball: it has no rest shape"):
        bpy.ops.stiv.settle()


def test_without_a_change_there_is_no_undo_step() -> None:
    add("Ball", icosphere(1).vertices, icosphere(1).faces)
    assert bpy.ops.stiv.repair() == {"CANCELLED"}
    assert last()["status"] == "already_free"


GRID = ([(x, y, 0.0) for y in (-1, 0, 1) for x in (-1, 0, 1)], [(0, 1, 4, 3), (1, 2, 5, 4), (3, 4, 7, 6), (4, 5, 8, 7)])
SPIKE = ([(0.6, 0.55, -1), (0.7, 0.55, -1), (0.65, 0.55, 1), (0.6, 5, 0)], [(0, 1, 2), (0, 1, 3)])


@pytest.mark.parametrize("levels", [0, 2])
@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_check_selects_the_faces_that_meet_only_if_asked(levels: int, mode: str) -> None:
    grid, spike = add("Grid", *GRID, select=False), add("Spike", *SPIKE, select=False)
    add("Apart", *SPIKE, location=(9, 0, 0))
    if levels:
        grid.modifiers.new("Finer", "SUBSURF").levels = levels
    if mode == "EDIT":
        bpy.context.view_layer.objects.active = grid
        bpy.ops.object.mode_set(mode="EDIT")
    selected = [obj.name for obj in bpy.context.selected_objects], [p.select for p in spike.data.polygons]
    assert bpy.ops.stiv.check() == {"FINISHED"}
    assert ([obj.name for obj in bpy.context.selected_objects], [p.select for p in spike.data.polygons]) == selected
    assert bpy.ops.stiv.check(select=True) == {"FINISHED"}
    if mode == "EDIT":
        assert [f.select for f in bmesh.from_edit_mesh(grid.data).faces] == [False, False, False, True]
        assert tuple(bpy.context.tool_settings.mesh_select_mode) == (False, False, True)
        bpy.ops.object.mode_set(mode="OBJECT")
    else:
        assert {ob.name for ob in bpy.context.selected_objects} == {"Grid", "Spike"}
    assert [p.select for p in grid.data.polygons] == [False, False, False, True]
    assert [p.select for p in spike.data.polygons] == [True, False]
    lines = bpy.context.window_manager.stiv_check.summary.splitlines()
    assert lines[0].startswith("Grid cuts Spike, ")


class InWindow(ReshapeOperator):
    """The repair operator as a window runs it, with a replacement of the window."""

    bl_label = "Repair"
    max_deviation = 0.05
    weld = False
    time_limit = 0.0
    begin = STIV_OT_repair.begin

    def __init__(self) -> None:
        self.reported: list[tuple[set[str], str]] = []

    def report(self, kind: set[str], text: str) -> None:
        self.reported.append((kind, text))


class Manager:
    """A window manager that counts running timers."""

    def __init__(self) -> None:
        self.timers, self.windows, self.stiv_last_edit = 0, (), ""
        self.stiv_check = SimpleNamespace(summary="")

    def event_timer_add(self, seconds: float, window: Any) -> str:
        self.timers += 1
        return "timer"

    def event_timer_remove(self, timer: str) -> None:
        self.timers -= 1

    def modal_handler_add(self, operator: Any) -> None:
        pass


class Context:
    """Blender's own context with another window manager."""

    def __init__(self) -> None:
        self.window_manager, self.window = Manager(), None

    def __getattr__(self, name: str) -> Any:
        return getattr(bpy.context, name)


def event(kind: str) -> Any:
    return SimpleNamespace(type=kind, value="PRESS")


def run(operator: Any, context: Any) -> set[str]:
    """Timer events until the operator ends."""
    while (outcome := operator.modal(context, event("TIMER"))) == {"RUNNING_MODAL"}:
        time.sleep(0.01)
    return outcome


def test_in_a_window_a_job_solves_and_timers_wait_for_it() -> None:
    add_tube()
    operator, context = InWindow(), Context()
    assert operator.start(context) == {"RUNNING_MODAL"}
    assert operator.modal(context, event("A")) == {"RUNNING_MODAL"}
    assert run(operator, context) == {"FINISHED"}
    assert check_scene(bpy.context).pairs == ()
    assert context.window_manager.timers == 0
    assert json.loads(context.window_manager.stiv_last_edit)["status"] == "repaired"
    assert operator.reported[-1][0] == {"INFO"}


def test_esc_restores_everything() -> None:
    tube = add_tube()
    before = positions(tube)
    operator, context = InWindow(), Context()
    operator.start(context)
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}
    assert np.array_equal(positions(tube), before) and not tube.data.attributes.get("stiv_original")
    assert context.window_manager.timers == 0
    assert "cancelled" in operator.reported[-1][1]


def test_blender_may_end_a_repair_and_an_object_may_be_deleted() -> None:
    tube = add_tube()
    before = positions(tube)
    operator, context = InWindow(), Context()
    operator.start(context)
    operator.cancel(context)
    assert np.array_equal(positions(tube), before) and context.window_manager.timers == 0
    operator.start(context)
    bpy.data.objects.remove(tube)
    assert run(operator, context) == {"CANCELLED"}
    assert "Tube is gone" in operator.reported[-1][1] and context.window_manager.timers == 0


def test_excluded_intersections_allow_edits_until_they_are_cleared() -> None:
    add("Grid", *GRID, select=False)
    spike = add("Spike", *SPIKE)
    with pytest.raises(RuntimeError, match="intersect"):
        bpy.ops.stiv.move(value=(0, 0, 0.01))
    assert bpy.ops.stiv.exclude_intersections() == {"FINISHED"}
    before = check_scene(bpy.context).pairs
    assert excluded_count(bpy.context.scene.stiv.excluded) == "2 faces excluded"
    assert bpy.ops.stiv.move(value=(0, 0, 0.01)) == {"FINISHED"}
    assert spike.location.z == pytest.approx(0.01)
    assert len(check_scene(bpy.context).pairs) <= len(before)
    bpy.context.scene.stiv.excluded = "broken"
    with pytest.raises(RuntimeError, match="use Clear Excluded Collisions"):
        bpy.ops.stiv.move(value=(0, 0, 0.01))
    assert bpy.ops.stiv.clear_exclusions() == {"FINISHED"}
    with pytest.raises(RuntimeError, match="intersect"):
        bpy.ops.stiv.move(value=(0, 0, 0.01))


def test_pairs_that_cannot_be_excluded_are_reported_with_the_way_out(capfd: pytest.CaptureFixture[str]) -> None:
    add("Grid", *GRID, select=False)
    wire = add("Wire", [(0.6, 0.55, -1), (0.6, 0.55, 1)], [])
    wire.data.clear_geometry()
    wire.data.from_pydata([(0.6, 0.55, -1), (0.6, 0.55, 1)], [(0, 1)], [])
    wire.data.update()
    bpy.context.view_layer.update()
    assert len(check_scene(bpy.context).pairs) == 1
    assert bpy.ops.stiv.exclude_intersections() == {"FINISHED"}
    reported = capfd.readouterr().out
    assert "0 faces excluded" in reported
    assert "its edges or hair still cut; set its role to No Collision" in reported


def test_stale_exclusions_are_reported() -> None:
    grid, _ = add("Grid", *GRID, select=False), add("Spike", *SPIKE)
    bpy.ops.stiv.exclude_intersections()
    grid.location.z = 5.0  # apart again, and with other faces
    grid.modifiers.new("Finer", "SUBSURF").levels = 1
    bpy.context.view_layer.update()
    assert bpy.ops.stiv.move(value=(0, 0, 0.01)) == {"FINISHED"}
    summary = bpy.context.window_manager.stiv_check.summary
    assert summary == "Grid: the faces have changed, so their exclusions are dropped"


def test_the_check_reports_the_clearance() -> None:
    add("Grid", *GRID, select=False)
    add("Apart", *SPIKE, location=(0, 0, 1.25))
    assert bpy.ops.stiv.check() == {"FINISHED"}
    lines = bpy.context.window_manager.stiv_check.summary.splitlines()
    assert lines[:2] == ["No intersections", "Grid, Apart: clearance 0.2500 m"]
    bpy.data.objects.remove(bpy.data.objects["Apart"])
    assert bpy.ops.stiv.check() == {"FINISHED"}
    lines = bpy.context.window_manager.stiv_check.summary.splitlines()
    assert lines[0] == "No intersections" and lines[1].startswith("Tested 1 object, ")
