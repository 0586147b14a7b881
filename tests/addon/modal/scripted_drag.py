# SPDX-License-Identifier: GPL-3.0-or-later
"""Drags of a fake edit, whose goal is a hundredth of the pointer's x, or the typed number."""

from unittest.mock import patch

from fake_edit import FakeEdit, FakeTask

from stiv_addon.modal import drag_loop
from stiv_addon.modal.drag_calls import DragCalls
from stiv_addon.modal.drag_loop import DragLoop
from stiv_addon.modal.event import Event
from stiv_addon.modal.expression import evaluate
from stiv_addon.modal.pointer import Pointer
from stiv_addon.modal.state import State


def new_drag(edit: FakeEdit) -> DragLoop:
    """A drag whose goal is a hundredth of the pointer's x, or the typed number."""
    calls = DragCalls(
        edit.begin_steps, measure, lambda value, state: value, edit.apply_steps, lambda steps: FakeTask(steps, edit)
    )
    return DragLoop(calls, State(Pointer.at((0.0, 0.0))))


def measure(state: State) -> float:
    typed = state.typed.value(0, lambda text: evaluate(text, {"": 1.0}.get))
    return (typed or 0.0) if state.typed.active else state.pointer.effective[0] / 100.0


def move_to(x: float) -> Event:
    return Event("MOUSEMOVE", "NOTHING", (x, 0.0))


def follow(drag: DragLoop, *positions: float) -> None:
    """Move the mouse before each tick."""
    for x in positions:
        drag.handle(move_to(x))
        drag.tick()


def pause(drag: DragLoop) -> None:
    """Leave the mouse where it is until the drag is at rest."""
    with patch.object(drag_loop, "PAUSE_TIME", 0.0):
        while not drag.at_rest:
            drag.tick()
