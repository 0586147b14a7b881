# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators in Blender: registration, and values through `execute` with a replacement of the edit."""

import json
import sys
from collections.abc import Iterator
from contextlib import nullcontext
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

import mathutils  # noqa: E402

import stiv_addon  # noqa: E402
from stiv import InputError  # noqa: E402
from stiv.blender.scene.lattice_reading import read_selected_lattice_points  # noqa: E402
from stiv.blender.scene.message_fitting import fit_message  # noqa: E402
from stiv.task import Steps, run  # noqa: E402
from stiv_addon import native_module  # noqa: E402
from stiv_addon.menus import MENUS  # noqa: E402
from stiv_addon.operators.classes import CLASSES  # noqa: E402
from stiv_addon.operators.reports import last_messages, outcome_text  # noqa: E402
from stiv_addon.operators.transform import drag_results  # noqa: E402
from stiv_addon.panels.base import draw_problem  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


class Motion(SimpleNamespace):
    """Replaces that of `stiv.blender`."""

    NAMES = ("matrix", "pivot", "individual", "influence", "rotation", "free", "place", "align")

    def __init__(self, *given: Any) -> None:
        super().__init__(**dict(zip(self.NAMES, given, strict=True)))


class FreeDirections(SimpleNamespace):
    """Replaces that of `stiv.blender`."""

    def __init__(self, axes: Any, free: Any) -> None:
        super().__init__(axes=axes.tolist(), free=free.tolist())

    @staticmethod
    def line(direction: Any) -> Any:
        return SimpleNamespace(opposite=("across", direction.tolist()))


class RecordingEdit:
    """Replaces the edit: moves the active object to its goal, unless it should fail."""

    begun: Any = None
    summary = SimpleNamespace(warnings=())
    start_notes = ()
    untested_notes: tuple[str, ...] = ()
    reset_note = passenger_note = ""
    standstill_note = staticmethod(lambda result: "")
    guard = SimpleNamespace(evaluations=("viewport",))
    carried = frozenset()
    failing: Exception | None = None

    @classmethod
    def begin_steps(cls, context: Any, settings: Any, kind: str) -> Steps["RecordingEdit"]:
        yield from ()
        edit = cls()
        edit.kind, edit.settings, edit.matrix = kind, settings, None
        edit.name = context.active_object.name
        edit.before = context.active_object.matrix_world.copy()
        RecordingEdit.begun = edit
        return edit

    start_digest = "start"

    def resume_from(self, controls: Any, motion: Any) -> bool:
        self.matrix = controls
        return True

    def apply_steps(self, motion: Any, path: Any) -> Steps[Any]:
        yield from ()
        self.motion, self.matrix = motion, np.array(motion.matrix)
        assert path(1.0) == pytest.approx(self.matrix)
        assert path(0.0) == pytest.approx(np.eye(4))
        if self.failing is not None:
            raise self.failing
        numbers = {"rounds": 3, "patches": 1, "energy": 0.5, "timings": {"total": 0.25}, "counters": {"rounds": 3}}
        return SimpleNamespace(status="corrected", blocking=(), events=SimpleNamespace(kind=[0, 1]), **numbers)

    def finish(self) -> None:
        """Replaces the end of the use of an edit."""

    def write(self) -> Any:
        obj = bpy.data.objects[self.name]
        obj.matrix_world = mathutils.Matrix(self.matrix @ np.array(self.before))
        return SimpleNamespace(passed=True, message="", result=None)

    def write_steps(self) -> Any:
        yield None
        return self.write()

    def restore(self) -> None:
        bpy.data.objects[self.name].matrix_world = self.before

    def start_shown(self) -> Any:
        return nullcontext()


@pytest.fixture(autouse=True)
def scene(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """A selected and active cube, and the replacements."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_cube_add(location=(1.0, 2.0, 3.0))
    plain = dict.fromkeys(("EditSettings", "Handles", "LoopSurface", "WeightGroup"), SimpleNamespace)
    plain |= {"Motion": Motion, "FreeDirections": FreeDirections, "Influence": lambda *given: given}
    plain |= {"Exclusions": SimpleNamespace(from_json=str)}
    plain |= {"read_selected_lattice_points": read_selected_lattice_points}
    plain |= {"unguarded_text": lambda *_: "", "find_without_surface": lambda context: ()}
    stand_in = SimpleNamespace(BlenderEdit=RecordingEdit, SceneChangedError=KeyError, run_steps=run, **plain)
    stand_in.fit_message = fit_message
    stand_in.is_cut_by_topology = lambda result: False
    stand_in.free_kept_data = lambda: None
    stand_in.copies_made, stand_in.on_copies = lambda: 0, lambda listener: None
    monkeypatch.setitem(sys.modules, "stiv.blender", stand_in)
    monkeypatch.setattr(RecordingEdit, "failing", None)
    monkeypatch.setattr(native_module, "problem", lambda: "")
    return bpy.context.active_object


def test_move_takes_world_values(scene: Any) -> None:
    assert bpy.ops.stiv.move(value=(0.5, 0.0, -1.0)) == {"FINISHED"}
    np.testing.assert_allclose(scene.location, (1.5, 2.0, 2.0), atol=1e-6)
    assert RecordingEdit.begun.kind == "move"


def test_chosen_axes_limit_the_motion(scene: Any) -> None:
    first = (True, False, False)
    tilted = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    chosen = {"constraint_axis": first}
    cases: list[tuple[str, dict[str, Any], Any]] = [
        ("move", {"value": (1, 2, 3)}, None),
        ("move", {"value": (6, 0, 0), **chosen}, FreeDirections(np.eye(3), np.array(first))),
        ("move", {**chosen, "orient_matrix": tilted.ravel()}, FreeDirections(tilted, np.array(first))),
        ("scale", {"value": (2, 2, 2)}, None),
        ("scale", {"value": (2, 1, 3)}, FreeDirections(np.eye(3), np.array([True, False, True]))),
        ("scale", {"value": (2, 1, 1), **chosen}, FreeDirections(np.eye(3), np.array(first))),
        ("rotate", {"angle": 1.0, "axis": (0, 2, 0)}, None),
        ("rotate", {"angle": 1.0, "axis": (0, 2, 0), **chosen}, ("across", [0, 1, 0])),
    ]
    for name, values, free in cases:
        getattr(bpy.ops.stiv, name)(**values)
        assert RecordingEdit.begun.motion.free == free, (name, values)


def test_scripts_can_read_the_last_edit() -> None:
    bpy.ops.stiv.move(value=(0.5, 0.0, -1.0))
    said = json.loads(bpy.context.window_manager.stiv_last_edit)
    assert (said["status"], said["rounds"], said["events"], said["patches"]) == ("corrected", 3, 2, 1)
    assert said["timings"] == {"total": 0.25} and said["shown"] is True


def test_rotate_turns_about_the_cursor_when_the_scene_says_so() -> None:
    bpy.context.scene.tool_settings.transform_pivot_point = "CURSOR"
    assert bpy.ops.stiv.rotate(angle=np.pi / 2.0, axis=(0.0, 0.0, 5.0)) == {"FINISHED"}
    np.testing.assert_allclose(bpy.context.active_object.location, (-2.0, 1.0, 3.0), atol=1e-6)


def test_scale_uses_local_axes_on_request(scene: Any) -> None:
    scene.rotation_euler.z = np.pi / 2.0
    bpy.context.view_layer.update()
    assert bpy.ops.stiv.scale(value=(2.0, 1.0, 1.0), orientation="LOCAL") == {"FINISHED"}
    np.testing.assert_allclose(RecordingEdit.begun.matrix[:3, :3], np.diag([1.0, 2.0, 1.0]), atol=1e-6)
    assert bpy.ops.stiv.scale(value=(2.0, 1.0, 1.0)) == {"FINISHED"}
    np.testing.assert_allclose(RecordingEdit.begun.matrix[:3, :3], np.diag([2.0, 1.0, 1.0]), atol=1e-6)


UNEXPECTED = "Unexpected error, the edit is undone; the system console has the details"


@pytest.mark.parametrize(
    ("failure", "text"),
    [(InputError("no"), "no"), (KeyError("no"), "no"), (ValueError("zip()"), UNEXPECTED), (RuntimeError(), UNEXPECTED)],
)
def test_a_refusal_is_reported_and_changes_nothing(scene: Any, failure: Exception, text: str) -> None:
    RecordingEdit.failing = failure
    before = scene.matrix_world.copy()
    with pytest.raises(RuntimeError, match=text):  # what Blender makes of a reported error
        bpy.ops.stiv.move(value=(1.0, 0.0, 0.0))
    assert scene.matrix_world == before


def test_an_axis_without_direction_is_refused_before_anything_begins() -> None:
    RecordingEdit.begun = None
    with pytest.raises(RuntimeError, match="rotation axis"):
        bpy.ops.stiv.rotate(angle=1.0, axis=(0.0, 0.0, 0.0))
    assert RecordingEdit.begun is None


def test_settings_and_roles_of_the_scene_are_passed_on(scene: Any) -> None:
    bpy.context.scene.stiv.separation = 0.25
    bpy.context.scene.stiv.object_response = "deform"
    bpy.context.scene.stiv.constraints = "single"
    scene.stiv.role = "controls"
    bpy.ops.stiv.move(value=(0.0, 0.0, 1.0))
    settings = RecordingEdit.begun.settings
    assert (settings.separation, settings.object_response, settings.roles) == (0.25, "deform", {scene.name: "controls"})
    assert (settings.constraints, settings.smoothness, settings.time_budget) == ("single", 0.1, 0.0)
    bpy.context.scene.stiv.smoothness = 0.013
    bpy.ops.stiv.move(value=(0.0, 0.0, 1.0))
    assert RecordingEdit.begun.settings.smoothness == 0.013
    assert not RecordingEdit.begun.settings.tight
    bpy.context.scene.stiv.tight = True
    bpy.ops.stiv.move(value=(0.0, 0.0, 1.0))
    assert RecordingEdit.begun.settings.tight


def test_choices_of_a_drag_are_properties() -> None:
    bpy.context.scene.tool_settings.transform_pivot_point = "INDIVIDUAL_ORIGINS"
    chosen = {"proportional": True, "proportional_size": 2.5, "proportional_falloff": "SHARP"}
    bpy.ops.stiv.rotate(angle=0.5, responders="all", interference="OFF", **chosen)
    edit = RecordingEdit.begun
    assert edit.settings.responders == "all" and not edit.settings.interference and edit.motion.individual
    np.testing.assert_allclose(edit.motion.rotation, [0.0, 0.0, 0.5])
    with pytest.raises(TypeError):
        bpy.ops.stiv.move(falloff="ODD")


def test_a_drag_does_not_register_the_proportional_editing_of_the_last_one() -> None:
    as_drags_do = "EXEC_DEFAULT", True  # with an undo step Blender recalls the last values of an operator
    chosen = {"proportional": True, "proportional_size": 2.5, "proportional_falloff": "SHARP"}
    bpy.ops.stiv.move(*as_drags_do, value=(1.0, 0.0, 0.0), **chosen, proportional_connected=True)
    assert RecordingEdit.begun.motion.influence is not None
    bpy.ops.stiv.move(*as_drags_do, value=(1.0, 0.0, 0.0))
    assert RecordingEdit.begun.motion.influence is None
    bpy.ops.stiv.move(*as_drags_do, value=(1.0, 0.0, 0.0), proportional=True)
    assert RecordingEdit.begun.motion.influence == (1.0, "SMOOTH", False)


def test_the_result_of_a_drag_is_reused_from_the_same_start(scene: Any) -> None:
    ended = np.eye(4)
    ended[:3, 3] = 0.0, 7.0, 0.0
    result = SimpleNamespace(status="blocked", blocking=(), rounds=1, patches=0, energy=0.0, timings={}, counters={})
    result.events = SimpleNamespace(kind=[])
    number = drag_results.store(drag_results.DragResult("start", ended, result, None))
    RecordingEdit.begun = None
    bpy.ops.stiv.move(value=(0.0, 9.0, 0.0), outcome=number)  # what the drag does at its end
    assert RecordingEdit.begun is None
    bpy.ops.stiv.move(value=(0.0, 9.0, 0.0), outcome=number)  # the redo panel
    np.testing.assert_array_equal(scene.location, (1.0, 9.0, 3.0))
    assert json.loads(bpy.context.window_manager.stiv_last_edit)["status"] == "blocked"
    bpy.ops.stiv.move(value=(0.0, 1.0, 0.0), outcome=number)  # with another value
    np.testing.assert_array_equal(scene.location, (1.0, 10.0, 3.0))
    drag_results.find(number).start = "another"
    bpy.ops.stiv.move(value=(0.0, 9.0, 0.0), outcome=number)  # from another start
    np.testing.assert_array_equal(scene.location, (1.0, 19.0, 3.0))


def test_the_redo_panel_repeats_the_messages_of_a_drag(scene: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(RecordingEdit, "reset_note", "Cube: the next frame resets it to its keyframes; key it")
    result = SimpleNamespace(status="corrected", blocking=(), rounds=1, patches=0, energy=0.0, timings={}, counters={})
    result.events = SimpleNamespace(kind=[])
    dragged = drag_results.DragResult("start", np.eye(4), result, None, outcome="nothing moved")
    number = drag_results.store(dragged)
    bpy.ops.stiv.move(value=(0.0, 9.0, 0.0), outcome=number)  # what the drag does at its end
    last_messages.clear()
    bpy.ops.stiv.move(value=(0.0, 9.0, 0.0), outcome=number)  # the redo panel
    assert [message.partition(": ")[2] for message in last_messages] == [
        "WARNING: nothing moved; Cube: the next frame resets it to its keyframes; key it"
    ]


@pytest.mark.parametrize(
    ("blocking", "keeps", "text"),
    [
        ((), True, "blocked: intersecting surfaces may only part; see Let These Pass"),
        (("Wall",), True, "blocked by Wall"),
        (("Eyes",), True, "blocked by Eyes, which cuts itself; see Let These Pass"),
        (("Eyes", "Wall"), True, "blocked by Eyes, Wall"),
        ((), False, "blocked"),
    ],
)
def test_a_blocked_result_says_why_although_nothing_is_in_contact(
    blocking: tuple[str, ...], keeps: bool, text: str
) -> None:
    result = SimpleNamespace(status="blocked", blocking=blocking, counters={})
    edit = SimpleNamespace(keeps_intersections=keeps, intersects_itself=lambda name: name == "Eyes")
    assert outcome_text(result, edit) == text


def test_old_results_are_deleted() -> None:
    numbers = [
        drag_results.store(drag_results.DragResult(str(i), None, None, None)) for i in range(drag_results.CAPACITY + 3)
    ]
    assert drag_results.find(numbers[0]) is None and drag_results.find(numbers[-1]).start == str(
        drag_results.CAPACITY + 2
    )
    drag_results.clear()
    assert drag_results.find(numbers[-1]) is None and drag_results.find(0) is None


def test_median_of_selected_vertices_is_the_pivot_in_edit_mode(scene: Any) -> None:
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.stiv.scale(value=(2.0, 2.0, 2.0))
    np.testing.assert_allclose(RecordingEdit.begun.matrix @ [1.0, 2.0, 3.0, 1.0], [1.0, 2.0, 3.0, 1.0], atol=1e-5)
    bpy.ops.object.mode_set(mode="OBJECT")


def test_selected_lattice_points_are_the_pivot_in_edit_mode() -> None:
    bpy.ops.object.add(type="LATTICE", location=(5.0, 0.0, 0.0))
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.lattice.select_all(action="SELECT")
    bpy.ops.stiv.scale(value=(3.0, 3.0, 3.0))
    np.testing.assert_allclose(RecordingEdit.begun.matrix @ [5.0, 0.0, 0.0, 1.0], [5.0, 0.0, 0.0, 1.0], atol=1e-5)
    bpy.ops.object.mode_set(mode="OBJECT")


def test_without_the_native_module_operators_say_why(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(native_module, "problem", lambda: "the native module is missing")
    assert not any(cls.poll(bpy.context) for cls in CLASSES if "INTERNAL" not in cls.bl_options)
    with pytest.raises(RuntimeError, match="the native module is missing"):
        bpy.ops.stiv.move(value=(1.0, 0.0, 0.0))


def test_the_panel_gives_the_reason_too(monkeypatch: pytest.MonkeyPatch) -> None:
    lines: list[str] = []

    class Layout:
        alert = False

        def box(self) -> "Layout":
            return self

        def column(self, align: bool = False) -> "Layout":
            return self

        def label(self, text: str, icon: str = "") -> None:
            lines.append(text)

    monkeypatch.setattr(
        native_module, "problem", lambda: "The native module of STIV is missing.\nInstall the extension."
    )
    draw_problem(Layout())
    assert "Install the extension." in lines


@pytest.mark.parametrize("menu", MENUS)
def test_registering_twice_leaves_nothing_behind(menu: str) -> None:
    entries = len(getattr(bpy.types, menu).draw._draw_funcs)
    stiv_addon.unregister()
    assert not hasattr(bpy.types.Scene, "stiv") and not hasattr(bpy.types.Object, "stiv")
    assert len(getattr(bpy.types, menu).draw._draw_funcs) == entries - 1
    stiv_addon.register()
    assert len(getattr(bpy.types, menu).draw._draw_funcs) == entries
