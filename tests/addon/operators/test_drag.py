# SPDX-License-Identifier: GPL-3.0-or-later
"""The modal part of the operators with a context of plain values, since Blender needs a window to run it."""

import sys
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from fake_edit import FakeEdit  # noqa: E402

from stiv.task import Task  # noqa: E402
from stiv_addon.modal.pointer import Pointer  # noqa: E402
from stiv_addon.modal.state import State  # noqa: E402
from stiv_addon.operators import running, window_io  # noqa: E402
from stiv_addon.operators.transform import drag  # noqa: E402
from stiv_addon.operators.transform.drag import DragOperator  # noqa: E402
from stiv_addon.operators.transform.move import STIV_OT_move  # noqa: E402
from stiv_addon.transform.frame import Frame  # noqa: E402
from stiv_addon.transform.snapping import Snap  # noqa: E402

UNEXPECTED = "Unexpected error, the edit is undone; the system console has the details"


class Area:
    """A 3D view: its header, and the number of redraws."""

    type, width = "VIEW_3D", 800

    def __init__(self) -> None:
        self.header: str | None = None
        self.drawn = 0

    def header_text_set(self, text: str | None) -> None:
        self.header = text

    def tag_redraw(self) -> None:
        self.drawn += 1


class Value(SimpleNamespace):
    """A transform that is a number."""

    rotation = None

    def matrix(self, frame: Frame) -> np.ndarray:
        return np.diag([self.value] * 3 + [1.0])

    def text(self, state: State, frame: Frame, translate: Callable[[str], str], length: Callable[[float], str]) -> str:
        return length(self.value)


class Probe(DragOperator):
    """A drag whose value is a hundredth of the pointer's x."""

    kind = "move"

    def __init__(self) -> None:
        self.reports: list[tuple[set, str]] = []
        self._frame, self._snap, self._readers, self._length = Frame(np.zeros(3)), Snap(), {}, str
        self._orientations, self._notes = ("GLOBAL", "LOCAL"), []

    def report(self, kind: set, text: str) -> None:
        self.reports.append((kind, text))


class Context(SimpleNamespace):
    """The members of Blender's context that the operator uses."""

    def __init__(self) -> None:
        self.area, self.timers, self.modals = Area(), [], []
        manager = SimpleNamespace(
            windows=[SimpleNamespace(screen=SimpleNamespace(areas=[self.area]))],
            event_timer_add=lambda step, window: self.timers.append(step) or step,
            event_timer_remove=self.timers.remove,
            modal_handler_add=self.modals.append,
            stiv_last_edit="",
        )
        nothing = dict.fromkeys(("region", "region_data", "workspace", "window"))
        super().__init__(mode="OBJECT", **nothing, window_manager=manager)


def event(kind: str, value: str = "PRESS", x: int = 0) -> Any:
    nothing = dict.fromkeys(window_io.MODIFIERS, False)
    return SimpleNamespace(type=kind, value=value, mouse_x=x, mouse_y=0, unicode="", **nothing)


@pytest.fixture
def edit() -> FakeEdit:
    return FakeEdit()


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch, edit: FakeEdit) -> Iterator[tuple[Probe, Context]]:
    stand_in = SimpleNamespace(SceneChangedError=KeyError, Task=Task, kept_twins=nullcontext)
    stand_in.is_cut_by_topology = lambda result: False
    stand_in.fit_message = str.format
    monkeypatch.setitem(sys.modules, "stiv.blender", stand_in)
    monkeypatch.setattr(
        drag, "requested_transform", lambda state, *rest: Value(value=state.pointer.effective[0] / 100.0)
    )
    monkeypatch.setattr(drag, "make_motion", lambda transform, *rest: transform.value)
    monkeypatch.setattr(drag, "make_influence", lambda proportional: None)
    operator, context = Probe(), Context()
    operator._launch(context, State(Pointer.at((0.0, 0.0))), edit.begin_steps)
    yield operator, context
    running.end()


def expect_clean(context: Context) -> None:
    assert context.area.header is None and not context.timers


def test_a_drag_shows_its_value_and_leaves_nothing_behind(started: Any, edit: FakeEdit) -> None:
    operator, context = started
    assert operator.modal(context, event("MOUSEMOVE", "NOTHING", 50)) == {"RUNNING_MODAL"}
    assert operator.modal(context, event("TIMER")) == {"RUNNING_MODAL"}
    assert context.area.header.startswith("0.5") and edit.shown == 0.5
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}
    assert edit.shown == 0.0 and operator.reports == []
    expect_clean(context)


@pytest.mark.parametrize("leaves", [False, True])
def test_a_long_start_shows_the_wait_cursor_until_it_ends_or_esc_is_pressed(
    started: Any, monkeypatch: pytest.MonkeyPatch, leaves: bool
) -> None:
    _, context = started
    running.end()
    shown: list[bool] = []
    monkeypatch.setattr(window_io, "show_wait_cursor", lambda context, on: shown.append(on))
    operator, edit = Probe(), FakeEdit(delays={"begin": 3})
    operator._launch(context, State(Pointer.at((0.0, 0.0))), edit.begin_steps)
    assert shown == [True] and edit.calls == []
    if leaves:
        assert operator.modal(context, event("ESC")) == {"CANCELLED"}
        assert edit.calls == [] and operator.reports == []
    else:
        for _ in range(4):
            assert operator.modal(context, event("TIMER")) == {"RUNNING_MODAL"}
        operator.cancel(context)
    assert shown == [True, False]


def test_a_key_during_a_solve_does_not_ask_the_session_that_solves(started: Any, edit: FakeEdit) -> None:
    """The drag once ended with "the session is in use by another call"."""
    operator, context = started
    edit.delays["drag"] = 5
    operator.modal(context, event("MOUSEMOVE", "NOTHING", 50))
    assert edit.busy
    assert operator.modal(context, event("X")) == {"RUNNING_MODAL"}
    assert "along" in context.area.header and operator.reports == []


def test_a_timer_that_only_waits_draws_nothing(started: Any) -> None:
    operator, context = started
    operator.modal(context, event("MOUSEMOVE", "NOTHING", 50))
    operator.modal(context, event("TIMER"))
    drawn = context.area.drawn
    for _ in range(20):
        operator.modal(context, event("TIMER"))
    assert context.area.drawn == drawn


@pytest.mark.parametrize("failing", ["drag", "write"])
def test_a_fault_of_the_edit_restores_reports_and_clears(started: Any, edit: FakeEdit, failing: str) -> None:
    operator, context = started
    edit.failing = {failing: RuntimeError("broken")}
    assert operator.modal(context, event("MOUSEMOVE", "NOTHING", 50)) == {"CANCELLED"}
    assert edit.calls[-1] == "restore" and operator.reports == [({"ERROR"}, UNEXPECTED)]
    expect_clean(context)


def test_a_fault_of_the_interface_ends_the_drag_too(
    started: Any, edit: FakeEdit, monkeypatch: pytest.MonkeyPatch
) -> None:
    operator, context = started

    def fail(*arguments: Any) -> None:
        raise AttributeError("no such area")

    monkeypatch.setattr(window_io, "show", fail)
    assert operator.modal(context, event("MOUSEMOVE", "NOTHING", 50)) == {"CANCELLED"}
    assert edit.calls[-1] == "restore" and edit.shown == 0.0 and operator.reports == [({"ERROR"}, UNEXPECTED)]
    expect_clean(context)


def test_a_failure_to_restore_is_reported(started: Any, edit: FakeEdit) -> None:
    operator, context = started
    edit.failing = {"drag": RuntimeError("broken"), "restore": RuntimeError("the box is gone")}
    operator.modal(context, event("MOUSEMOVE", "NOTHING", 50))
    assert operator.reports == [({"ERROR"}, f"{UNEXPECTED}; while restoring: the box is gone")]
    expect_clean(context)


def test_navigation_is_left_to_blender(started: Any) -> None:
    operator, context = started
    assert operator.modal(context, event("NDOF_MOTION")) == {"PASS_THROUGH"}
    assert operator.modal(context, event("WHEELUPMOUSE")) == {"PASS_THROUGH"}


def test_another_mode_ends_the_drag(started: Any, edit: FakeEdit) -> None:
    operator, context = started
    context.mode = "EDIT_MESH"
    assert operator.modal(context, event("TIMER")) == {"CANCELLED"}
    assert edit.calls == ["restore"] and "mode changed" in operator.reports[0][1]
    expect_clean(context)


def test_blender_may_end_the_drag(started: Any, edit: FakeEdit) -> None:
    operator, context = started
    operator.cancel(context)
    assert edit.calls == ["restore"]
    expect_clean(context)


def test_disabling_the_extension_restores_the_start(started: Any, edit: FakeEdit) -> None:
    operator, context = started
    operator.modal(context, event("MOUSEMOVE", "NOTHING", 50))
    operator.modal(context, event("TIMER"))
    assert edit.shown == 0.5
    running.cancel(context)
    assert edit.shown == 0.0
    expect_clean(context)
    running.cancel(context)  # nothing runs any more
    assert edit.calls.count("restore") == 1


def test_a_second_window_cannot_begin_an_edit_until_the_first_one_ends(started: Any, edit: FakeEdit) -> None:
    operator, context = started
    second = Probe()
    assert second.invoke(context, event("MOUSEMOVE", "NOTHING")) == {"CANCELLED"}
    assert second.reports == [({"ERROR"}, "Another window runs an edit; finish it first")]
    assert not STIV_OT_move.is_available(context)
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}
    assert STIV_OT_move.is_available(context) and not running.obstacle()


@pytest.mark.parametrize(("message", "expected"), [("", ["show_edit"]), ("stopped early: Box", ["end_edit"])])
def test_the_overlay_shows_only_the_result_that_the_scene_shows(
    started: Any, edit: FakeEdit, monkeypatch: pytest.MonkeyPatch, message: str, expected: list[str]
) -> None:
    operator, context = started
    calls: list[str] = []
    for name in ("show_edit", "end_edit"):
        monkeypatch.setattr(drag.display, name, lambda *given, name=name: calls.append(name))
    edit.taking = False  # written completely at once
    monkeypatch.setattr(edit, "write", lambda: SimpleNamespace(passed=True, message=message, result=None))
    operator.modal(context, event("MOUSEMOVE", "NOTHING", 50))
    operator.modal(context, event("TIMER"))
    assert calls[:1] == expected and set(calls) == set(expected)
