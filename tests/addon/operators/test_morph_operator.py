# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.morph` as a script calls it: values, undo, the description of the last edit, and what it refuses."""

import json
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from stiv.blender import check_scene  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture
def ball() -> Any:
    bpy.ops.wm.read_factory_settings(use_empty=True)
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


def test_the_dialog_begins_with_the_values_and_a_short_time_limit(ball: Any) -> None:
    from stiv_addon.operators.transform import morph as module

    ball.data.shape_keys.key_blocks["Thin"].value = 0.25
    operator = SimpleNamespace(keys=Rows(), time_limit=120.0)
    manager = SimpleNamespace(invoke_props_dialog=lambda shown: {"RUNNING_MODAL"})
    module.STIV_OT_morph.invoke(operator, SimpleNamespace(active_object=ball, window_manager=manager), None)
    assert [(row.name, row.value) for row in operator.keys] == [("Wide", 0.0), ("Thin", 0.25)]
    assert operator.time_limit == module.DIALOG_TIME_LIMIT


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
    bpy.ops.wm.read_factory_settings(use_empty=True)
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
