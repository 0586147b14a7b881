# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.morph` as a script calls it: values, undo, the description of the last edit, and what it refuses."""

import json
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from stiv.blender import check_scene  # noqa: E402
from stiv_addon.operators.transform import morph as morph_module  # noqa: E402
from stiv_addon.operators.transform import morph_in_steps  # noqa: E402
from stiv_addon.operators.transform.morph import STIV_OT_morph  # noqa: E402
from stiv_addon.operators.transform.morph_in_steps import MorphInSteps  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture
def ball() -> Any:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_plane_add(size=8, location=(2, 0, 0), rotation=(0, np.pi / 2, 0))
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1, segments=16, ring_count=9)
    ball = bpy.context.object
    ball.shape_key_add(name="Basis")
    for name, factor in (("Wide", 3), ("Thin", 0.5)):
        key = ball.shape_key_add(name=name)
        key.value = 0  # 1 in Blender 5
        for point, rest in zip(key.data, ball.data.vertices, strict=True):
            point.co = rest.co * factor
    return ball


def value(ball: Any, key: str) -> float:
    return float(ball.data.shape_keys.key_blocks[key].value)


def morph(others_yield: bool = False, **values: float) -> set[str]:
    rows = [{"name": name, "value": goal} for name, goal in values.items()]
    result: set[str] = bpy.ops.stiv.morph("EXEC_DEFAULT", True, keys=rows, others_yield=others_yield)
    return result


def test_a_morph_stops_reports_and_is_one_undo_step(ball: Any) -> None:
    bpy.ops.ed.undo_push(message="start")
    assert morph(Wide=1.0) == {"FINISHED"}
    assert 0.45 < value(ball, "Wide") < 0.55
    assert check_scene(bpy.context).pairs == ()
    said = json.loads(bpy.context.window_manager.stiv_last_edit)
    assert said["status"] in ("corrected", "blocked") and said["values"] == {"Wide": value(ball, "Wide")}
    bpy.ops.ed.undo()
    assert value(bpy.data.objects["Sphere"], "Wide") == 0


class Rows(list[SimpleNamespace]):
    """A collection property of an operator without a window."""

    def add(self) -> SimpleNamespace:
        self.append(SimpleNamespace())
        return self[-1]


def test_the_dialog_begins_with_the_values(ball: Any) -> None:
    ball.data.shape_keys.key_blocks["Thin"].value = 0.25
    operator = SimpleNamespace(keys=Rows())
    manager = SimpleNamespace(invoke_props_dialog=lambda shown: {"RUNNING_MODAL"})
    STIV_OT_morph.invoke(operator, SimpleNamespace(active_object=ball, window_manager=manager), None)
    assert [(row.name, row.value) for row in operator.keys] == [("Wide", 0.0), ("Thin", 0.25)]


class InWindow(MorphInSteps):
    """The operator as a window runs it after its dialog, without the window."""

    bl_label = "Morph"
    others_yield = False
    time_limit = 120.0
    _is_invoked = True
    execute, finish_task, _time_budget = STIV_OT_morph.execute, STIV_OT_morph.finish_task, STIV_OT_morph._time_budget

    def __init__(self, **values: float) -> None:
        self.keys = [SimpleNamespace(name=name, value=goal) for name, goal in values.items()]
        self.options = SimpleNamespace(is_repeat=False)
        self.reported: list[tuple[set[str], str]] = []

    def report(self, kind: set[str], text: str) -> None:
        self.reported.append((kind, text))


class Context:
    """Blender's own context with another window manager, which counts timers."""

    def __init__(self) -> None:
        self.timers = 0
        self.window_manager = SimpleNamespace(
            event_timer_add=self._add, event_timer_remove=self._remove, modal_handler_add=lambda _: None, windows=()
        )

    def _add(self, seconds: float, window: Any) -> str:
        self.timers += 1
        return "timer"

    def _remove(self, timer: str) -> None:
        self.timers -= 1

    def __getattr__(self, name: str) -> Any:
        return getattr(bpy.context, name)


@pytest.fixture
def windowed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the operator think that there is a window, and look at each step alone."""
    monkeypatch.setattr(morph_in_steps, "SHORTEST", 0.0)
    monkeypatch.setattr(morph_in_steps, "LONGEST", 0.0)
    app = SimpleNamespace(background=False)
    monkeypatch.setattr(morph_module, "bpy", SimpleNamespace(app=app, types=bpy.types))


def event(kind: str) -> Any:
    return SimpleNamespace(type=kind, value="PRESS")


@pytest.mark.usefixtures("windowed")
def test_after_the_dialog_timers_solve_and_the_result_is_that_of_a_script(ball: Any) -> None:
    operator, context = InWindow(Wide=1.0), Context()
    assert operator.execute(context) == {"RUNNING_MODAL"}
    assert operator.modal(context, event("A")) == {"RUNNING_MODAL"}
    while operator.modal(context, event("TIMER")) == {"RUNNING_MODAL"}:
        assert value(ball, "Wide") == 0
    in_window, said = value(ball, "Wide"), context.window_manager.stiv_last_edit
    assert context.timers == 0 and operator.reported[-1][0] == {"INFO"}
    ball.data.shape_keys.key_blocks["Wide"].value = 0
    assert morph(Wide=1.0) == {"FINISHED"}
    assert (value(ball, "Wide"), bpy.context.window_manager.stiv_last_edit) == (in_window, said)
    ball.data.shape_keys.key_blocks["Wide"].value = 0
    assert operator.execute(context) == {"FINISHED"}  # the redo panel
    assert value(ball, "Wide") == in_window


@pytest.mark.usefixtures("windowed")
@pytest.mark.parametrize("ends", ["ESC", "cancel"])
def test_esc_and_blender_end_a_morph_with_the_values_of_its_start(ball: Any, ends: str) -> None:
    operator, context = InWindow(Wide=1.0), Context()
    operator.execute(context)
    for _ in range(10):
        assert operator.modal(context, event("TIMER")) == {"RUNNING_MODAL"}
    if ends == "ESC":
        assert operator.modal(context, event("ESC")) == {"CANCELLED"}
        assert "cancelled" in operator.reported[-1][1]
    else:
        operator.cancel(context)
    assert value(ball, "Wide") == value(ball, "Thin") == 0 and context.timers == 0


@pytest.mark.usefixtures("windowed")
def test_a_start_that_intersects_is_refused_after_the_dialog(ball: Any) -> None:
    bpy.data.objects["Plane"].location.x = 0.5
    operator, context = InWindow(Wide=1.0), Context()
    assert operator.execute(context) == {"RUNNING_MODAL"}
    while (outcome := operator.modal(context, event("TIMER"))) == {"RUNNING_MODAL"}:
        pass
    assert outcome == {"CANCELLED"} and context.timers == 0 and value(ball, "Wide") == 0
    assert operator.reported[-1][0] == {"ERROR"} and "intersect" in operator.reported[-1][1]


def test_the_redo_panel_waits_for_a_short_time(ball: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    operator = InWindow(Wide=1.0)
    assert operator._time_budget() == 120
    monkeypatch.setattr(morph_module.redo_limit, "is_redo", lambda _: True)
    for chosen, limit in ((120.0, morph_module.REDO_TIME_LIMIT), (0.0, morph_module.REDO_TIME_LIMIT), (2.0, 2.0)):
        operator.time_limit = chosen
        assert operator._time_budget() == limit


def test_the_other_keys_yield(ball: Any) -> None:
    assert morph(Wide=0.6) == morph(others_yield=True, Wide=0.6) == {"FINISHED"}
    assert value(ball, "Wide") > 0.52 and value(ball, "Thin") > 0.05
    assert check_scene(bpy.context).pairs == ()


def test_values_that_do_not_change_or_do_not_exist(ball: Any) -> None:
    assert morph(Wide=0.0) == {"CANCELLED"}
    with pytest.raises(RuntimeError, match="Sphere: it has no shape key Round"):
        morph(Round=1.0)
    bpy.context.view_layer.objects.active = bpy.data.objects["Plane"]
    assert not bpy.ops.stiv.morph.poll()


def test_the_slider_of_the_panel_stops_while_it_is_dragged(ball: Any) -> None:
    """Blender calls the setter with each motion of the mouse."""
    ball.active_shape_key_index = 1
    for goal in np.linspace(0.05, 1.0, 20):
        ball.stiv.morph_value = goal
        assert check_scene(bpy.context).pairs == ()
    assert 0.45 < value(ball, "Wide") < 0.55 and ball.stiv.morph_value == value(ball, "Wide")
    ball.stiv.morph_value = 0.2
    assert value(ball, "Wide") == np.float32(0.2)
    wall = bpy.data.objects["Plane"]
    wall.location.x = 1.5  # another scene: read again, though the edit is recent
    ball.stiv.morph_value = 1.0
    assert 0.25 < value(ball, "Wide") < 0.27 and check_scene(bpy.context).pairs == ()
    wall.location.x = 1.0
    ball.stiv.morph_value = 0.1
    assert "intersect" in bpy.context.window_manager.stiv_check.summary
    assert 0.25 < value(ball, "Wide") < 0.27


def test_drags_of_several_keys_show_only_clear_values(ball: Any) -> None:
    """The calls of a drag: goals far beyond contact, with little time, while others yield or not."""
    from stiv.blender import EditSettings, MorphEdit

    ball.data.shape_keys.key_blocks["Thin"].slider_min = -1
    for others_yield in (False, True):
        goals = {"Sphere": {"Wide": 0.9, "Thin": -0.5}}
        edit = MorphEdit.begin(bpy.context, goals, EditSettings(separation=0.01), others_yield=others_yield)
        for _ in range(10):
            edit.advance(edit.goals(goals), 0.01)
            assert edit.show() == "" and edit.is_shown()
            assert check_scene(bpy.context).pairs == ()
        assert max(edit.values) > 0.2
        edit.restore()
        assert value(ball, "Wide") == value(ball, "Thin") == 0


def test_faces_that_cut_at_a_seam_torn_by_the_slider_are_named() -> None:
    """Two squares side by side, of which a key moves one across the other."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    places = [(x + side, y, 0) for side in (-1, 0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    data = bpy.data.meshes.new("Sheet")
    data.from_pydata(places, [], [range(4), range(4, 8)])
    sheet = bpy.data.objects.new("Sheet", data)
    bpy.context.collection.objects.link(sheet)
    bpy.context.view_layer.objects.active = sheet
    sheet.shape_key_add(name="Basis")
    key = sheet.shape_key_add(name="Cross")
    key.value = 0
    key.data[4].co, key.data[7].co = (-0.5, 0, -0.5), (-0.5, 1, 0.5)
    sheet.active_shape_key_index = 1
    sheet.stiv.morph_value = 0.9
    text = "Sheet: 2 faces at torn seams cut each other; use Merge by Distance"
    assert bpy.context.window_manager.stiv_check.summary == text
