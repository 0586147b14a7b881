# SPDX-License-Identifier: GPL-3.0-or-later
"""Drags an edit script as a user does: the mouse moves in real time, with the add-on's drag.

A step with repetitions is one drag. The mouse moves through SPEED repetitions per second. Then it rests
until nothing is left to solve, and the drag is confirmed. There is no window, so times include Blender's
evaluation but not its drawing. Ticks come when Blender's timer sends them: at multiples of TICK since its
start, or as soon as the previous one ends if it lasts beyond them (wm_window_timers_process in wm_window.cc).
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import bpy
import numpy as np

import stiv
from benchmarks.sessions.frame_times import goal_matrix, name_of
from stiv.blender.edit.blender_edit import BlenderEdit
from stiv.blender.scene.arrays import Floats
from stiv.blender.scripts.replaying import prepare, run_edit
from stiv.blender.settings import EditSettings
from stiv.edit_scripts import TRANSFORMS, EditScript, EditStep
from stiv.task import Steps

SPEED = 24.0  # repetitions a second: each would be a frame of its own in a film
TICK = 1.0 / 60.0  # seconds, of the add-on's timer
PATIENCE = 60.0  # seconds that a drag may continue solving after the mouse rests


class Drag(Protocol):
    """The interface of the add-on's drag that this module uses."""

    @property
    def result(self) -> Any:
        """Result of the last solve, a stiv.EditResult, or None."""

    @property
    def report(self) -> Any:
        """Report of the last writing, a WriteReport, or None."""

    @property
    def written(self) -> Any:
        """The result that the scene shows, a stiv.EditResult, or None."""

    @property
    def written_for(self) -> float:
        """The position of the mouse for which it was solved."""

    @property
    def error(self) -> Exception | None:
        """The error that ended the drag."""

    @property
    def starting(self) -> bool:
        """Whether the edit has not begun yet."""

    @property
    def at_rest(self) -> bool:
        """Whether nothing is left to solve."""

    def point(self, where: float) -> None:
        """Move the mouse."""

    def tick(self) -> None:
        """A timer event."""

    def confirm(self) -> None:
        """Enter, until the drag has ended."""


NewDrag = Callable[[str, Callable[[], Any], Callable[[float], Floats]], Drag]


@dataclass(frozen=True)
class Tick:
    """One timer event that solved. Times are wall time in seconds.

    Attributes:
        at: end of the tick, since the start of the drag.
        seconds: duration, which blocks the interface.
        solving: time of the core for the result that it took; the solve may have begun in the tick before.
        shown: whether it wrote, evaluated, read back and tested an accepted state that differs from the last one.
        behind: with `shown`, the delay of the displayed state behind the mouse.
        touches: whether anything was in contact.
        passed: whether the displayed state passed the exact test.
    """

    at: float
    seconds: float
    solving: float
    shown: bool
    behind: float
    touches: bool
    passed: bool


@dataclass(frozen=True)
class DraggedStage:
    """One drag. Times are wall time in seconds.

    Attributes:
        name: operator and objects.
        beginning: time to read the scene and build the session.
        moving: time that the mouse moved.
        ticks: all ticks that solved, in order.
        settling: time from the rest of the mouse to the end of the last tick.
        confirming: time of the confirmation with Enter.
    """

    name: str
    beginning: float
    moving: float
    ticks: Sequence[Tick]
    settling: float
    confirming: float


def dragged_stages(
    script: EditScript, settings_of: Callable[[Any], EditSettings], new_drag: NewDrag
) -> list[DraggedStage]:
    """Drags a script in the open scene. Steps that reshape run in between, without timing.

    settings_of: returns the add-on's settings of a scene. new_drag: makes the add-on's drag from a kind, the
    steps that begin an edit of the scene, and the goal for a position of the mouse. Raises InputError.
    """
    stages = []
    for number, step in enumerate(script.steps):
        prepare(step, script, number)
        if step.operator not in TRANSFORMS:
            for _ in range(step.repeat):
                run_edit(step, number)
        elif step.operator == "rotate":
            raise stiv.InputError("rotate: frame times are of scripts that move, scale and reshape")
        else:
            stages.append(_Dragging(step, settings_of, new_drag).stage())
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    return stages


@dataclass
class _Dragging:
    step: EditStep
    settings_of: Callable[[Any], EditSettings]
    new_drag: NewDrag
    ticks: list[Tick] = field(default_factory=list)
    shown: Floats | None = None  # controls

    def stage(self) -> DraggedStage:
        begun = time.perf_counter()
        drag = self.new_drag(self.step.operator, self._begin, self._goal)
        while drag.starting:
            drag.tick()
        beginning, moving = time.perf_counter() - begun, self.step.repeat / SPEED
        self._start = time.perf_counter()
        while self._now() < moving:
            drag.point(min(self._now() * SPEED, self.step.repeat))
            self._tick(drag)
        drag.point(float(self.step.repeat))
        while not drag.at_rest and self._now() < moving + PATIENCE:
            self._tick(drag)
        settling = max(self._now() - moving, 0.0)
        confirmed = time.perf_counter()
        drag.confirm()
        if drag.error is not None:
            raise drag.error
        return DraggedStage(
            name_of(self.step), beginning, moving, self.ticks, settling, time.perf_counter() - confirmed
        )

    def _now(self) -> float:
        return time.perf_counter() - self._start

    def _begin(self) -> Steps[Any]:
        settings = self.settings_of(bpy.context.scene)
        edit = yield from BlenderEdit.begin_steps(bpy.context, settings, self.step.operator)
        self._pivot = edit.controls.mean(axis=0)
        return edit

    def _goal(self, where: float) -> Floats:
        return goal_matrix(self.step, where, self._pivot)

    def _tick(self, drag: Drag) -> None:
        report, previous, begun = drag.report, drag.result, self._now()
        if drag.at_rest:
            self._await_timer(begun)
            return
        drag.tick()
        ended = self._now()
        writes, result = drag.report is not report, drag.result
        shown = writes and self._is_new(drag.written)
        behind = ended - drag.written_for / SPEED if shown else 0.0
        if result is None or (result is previous and not writes):  # a job is still running
            return
        touches = result.rounds > 0 or len(result.events) > 0
        passed = not writes or drag.report.passed
        self.ticks.append(Tick(ended, ended - begun, result.timings["total"], shown, behind, touches, passed))
        self._await_timer(begun)

    def _await_timer(self, begun: float) -> None:
        """Wait for the tick after one that began then."""
        time.sleep(max(0.0, TICK * math.ceil(begun / TICK) - self._now()))

    def _is_new(self, written: Any) -> bool:
        """Whether the scene shows another shape than before."""
        if written is None or (self.shown is not None and np.array_equal(written.controls, self.shown)):
            return False
        self.shown = written.controls
        return True
