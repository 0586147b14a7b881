# SPDX-License-Identifier: GPL-3.0-or-later
"""Watches Blender for the guard: handlers only note changes, and a timer acts when no tool runs."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import bpy
from bpy.app.handlers import persistent

from .. import native_module, stiv_blender
from ..modal.header_texts import naming
from ..operators import last_edit
from ..operators.reports import error_text
from ..translations import translate
from . import alerts, correction, undo_steps, waiting
from .decision import POLL_INTERVAL, Action, Guard, Observation, UndoStep, decide, is_new_result
from .problem import Problem
from .record import Record

STEP_NAME = "Live Guard"
SWITCHES = ("live_transforms", "live_guard")  # in this order: the first sets the second
FIRST_WAIT = 0.1  # seconds that a correction may take before its progress is shown
WAIT = 0.02  # seconds of each further look at it


class Watch:
    """The state of the guard.

    Attributes:
        record: the accepted state and its intersections.
        frame: the frame of the last observation.
        uncorrected: results of tools that still intersect, counted since the guard was turned on.
        correction: the one that runs now; its writes are not observed.
    """

    def __init__(self) -> None:
        """The state before the first observation."""
        self.guard = Guard()
        self.record = Record()
        self.frame = 0
        self.updates = 0
        self.seen_updates = -1
        self.own_edits = last_edit.written()
        self.uncorrected = 0
        self.working = False
        self.correction: _Correction | None = None


@dataclass
class _Correction:
    """A running correction, the scene from which it starts, and why it runs."""

    work: waiting.Work
    accepted: stiv_blender.AcceptedScene
    action: Action
    seen: Observation
    restored: bool


_watch = Watch()
_switches: dict[tuple[str, str], bool] = {}  # of scenes by name, before undo or redo
_restores_switches = False


def problem() -> Problem | None:
    """The intersections and their cause; None if there are none."""
    return _watch.record.problem


def state(context: bpy.types.Context) -> str:
    """The state for the icon: "off", "guarded", "partial" (known intersections are left alone), or "intersecting"."""
    if not is_on(context):
        return "off"
    found = problem()
    return "guarded" if found is None else "partial" if found.known else "intersecting"


def uncorrected() -> int:
    """Number of results since the guard was turned on that intersect and were not corrected."""
    return _watch.uncorrected


def last_clear_state() -> tuple[stiv_blender.SceneState, int] | None:
    """The last state without an uncorrected result, and its frame; None before the first."""
    return _watch.record.clear


def uncorrected_of(outcome: correction.Outcome) -> Problem | None:
    """The rest of uncorrected results in the outcome of a test; None if nothing is."""
    return _watch.record.uncorrected_of(outcome)


def is_on(context: bpy.types.Context) -> bool:
    """Whether the guard of the scene is turned on and can run."""
    return context.scene is not None and bool(context.scene.stiv.live_guard) and not native_module.problem()


def switched(context: bpy.types.Context) -> None:
    """Called when the guard is turned on or off: start with the current scene, or stop."""
    if _restores_switches:
        return
    restart()
    if is_on(context):
        _start_timer()


def is_working() -> bool:
    """Whether the guard tests or corrects, or is about to."""
    return bool(bpy.app.timers.is_registered(observe_and_act))


def step_replaced(before: UndoStep | None) -> None:
    """Called when the active undo step was replaced by the same: the guard knows it again."""
    if before is not None and _watch.guard.step == before:
        _watch.guard = replace(_watch.guard, step=undo_steps.active_step())


def exclusions_changed(context: bpy.types.Context) -> None:
    """Called when the excluded pairs change: test again."""
    if is_on(context):
        _note_change()


def restart() -> None:
    """Reset the state; the next observation is the first."""
    global _watch
    running, _watch.correction = _watch.correction, None
    if running is not None:
        waiting.end(bpy.context)
        running.work.task.abandon()
    _watch = Watch()
    alerts.clear()
    if bpy.app.timers.is_registered(observe_and_act):
        bpy.app.timers.unregister(observe_and_act)


def observe_and_act() -> float | None:
    """Timer: observe Blender and do what is due. Returns seconds until the next call, None for no further call."""
    windows = bpy.context.window_manager.windows
    if not len(windows):
        return None
    with bpy.context.temp_override(window=windows[0]):
        context = bpy.context
        if not is_on(context):
            restart()
            return None
        try:
            return _run(context, windows[0])
        except Exception as error:  # Blender would remove a timer that raises
            waiting.end(context)
            _watch.correction, _watch.working = None, False
            _give_up(Problem(reason=error_text(error)))
            return None


def _run(context: bpy.types.Context, window: bpy.types.Window) -> float | None:
    watch = _watch
    if watch.correction is None:
        seen = _observe(context)
        watch.guard, action = decide(watch.guard, seen)
        if action is Action.WAIT:
            return POLL_INTERVAL
        if action is not Action.REST:
            watch.working = True
            _act(context, window, action, seen)
    if watch.correction is not None and not _continue(context, window, watch.correction):
        return 0.0
    watch.working = False
    watch.seen_updates = watch.updates
    return None


def _observe(context: bpy.types.Context) -> Observation:
    watch = _watch
    busy = alerts.is_busy()
    return Observation(
        time=time.monotonic(),
        busy=busy,
        changed=watch.updates != watch.seen_updates,
        updates=watch.updates,
        step=None if busy else undo_steps.active_step(),
        sculpting=context.mode == "SCULPT",
        own_edit=last_edit.written() != watch.own_edits,
        frame_changed=context.scene.frame_current != watch.frame,
    )


def _act(context: bpy.types.Context, window: bpy.types.Window, action: Action, seen: Observation) -> None:
    watch = _watch
    if seen.sculpting:
        correction.evaluate_strokes(context)
    restored = watch.guard.history and action is Action.WRITE
    outcome = _tested(context, watch.record, action, restored)
    if outcome is not None:
        _finish(context, window, action, seen, restored, outcome)
        return
    accepted = watch.record.accepted
    assert accepted is not None
    task = stiv_blender.Task(correction.correct_steps(context, accepted))
    watch.correction = _Correction(waiting.Work(task), accepted, action, seen, restored)
    task.advance(FIRST_WAIT)


def _continue(context: bpy.types.Context, window: bpy.types.Window, running: _Correction) -> bool:
    """Advance a correction, or stop it; returns whether it has ended."""
    work = running.work
    if not work.stopped and not work.task.advance(WAIT):
        waiting.begin(window, work)
        return False
    waiting.end(context)
    _watch.correction = None
    if work.stopped:
        work.task.leave()  # `stop` restores
        outcome = correction.stop(context, running.accepted)
    else:
        outcome = work.task.result
    _finish(context, window, running.action, running.seen, running.restored, outcome)
    return True


def _finish(
    context: bpy.types.Context,
    window: bpy.types.Window,
    action: Action,
    seen: Observation,
    restored: bool,
    outcome: correction.Outcome,
) -> None:
    """Store a correction in the history, and accept the scene."""
    watch = _watch
    if outcome.wrote:
        _store_in_history(window, action, seen)
    first = watch.record.accepted is None
    left = watch.record.accept(context, outcome, restored) or bool(outcome.reason)
    if left and not first and is_new_result(watch.guard, seen, action):
        watch.uncorrected += 1
    _settle(context)
    alerts.show(context, outcome.text or _first_text(first), watch.record.problem)


def _tested(context: bpy.types.Context, record: Record, action: Action, restored: bool) -> correction.Outcome | None:
    """The outcome of a test; None if the scene has to be corrected."""
    if record.accepted is None or action in (Action.ACCEPT, Action.WRITE):
        tested = correction.test(context)
        if record.accepted is None or action is Action.ACCEPT or record.allows(tested.pairs, restored):
            return tested
    return None


def _first_text(first: bool) -> str:
    """A message about the known intersections, when the guard is turned on."""
    found = problem()
    if not first or found is None or not found.known:
        return ""
    text = translate("{} intersect and are left alone; all else is guarded")
    return naming(text, translate, stiv_blender.fit_message, found.names)


def _store_in_history(window: bpy.types.Window, action: Action, seen: Observation) -> None:
    if action is Action.REPLACE and seen.step is not None:
        undo_steps.replace_active(window, seen.step[2])
    elif action is Action.PUSH:
        undo_steps.push(window, STEP_NAME)


def _settle(context: bpy.types.Context) -> None:
    watch = _watch
    watch.own_edits = last_edit.written()
    watch.frame = context.scene.frame_current
    watch.guard = watch.guard.settled(undo_steps.active_step(), watch.record.accepted is not None)
    # Reading a mesh in Edit Mode marks it as changed; updating here, while working, ignores that change.
    context.view_layer.update()


def _give_up(problem: Problem) -> None:
    """Stop until the next change."""
    _watch.record.problem = problem
    _watch.seen_updates = _watch.updates
    alerts.show(bpy.context, "", problem)


def _start_timer() -> None:
    if not bpy.app.timers.is_registered(observe_and_act):
        bpy.app.timers.register(observe_and_act, first_interval=0.0)


def _note_change() -> None:
    """Observe when no tool runs any more. Changes by the guard itself are ignored."""
    if not _watch.working:
        _watch.updates += 1
        _start_timer()


@persistent
def _on_update(scene: bpy.types.Scene, graph: bpy.types.Depsgraph) -> None:
    if scene != bpy.context.scene:
        return  # a copy for STIV's evaluations, or a scene of another window
    if not is_on(bpy.context):
        return
    if any(_may_move_surfaces(each) for each in graph.updates):
        _note_change()
    elif not _watch.working:
        _watch.record.note_selection(bpy.context)


def _may_move_surfaces(update: bpy.types.DepsgraphUpdate) -> bool:
    """Whether an update may move surfaces. A sculpt stroke is only marked as an update of shading."""
    moved = update.is_updated_geometry or update.is_updated_transform
    return bool(moved or (update.is_updated_shading and bpy.context.mode == "SCULPT"))


@persistent
def _on_frame(scene: bpy.types.Scene, graph: bpy.types.Depsgraph) -> None:
    if is_on(bpy.context):
        _note_change()


@persistent
def _before_history(*_unused: object) -> None:
    _switches.clear()
    for scene in bpy.data.scenes:
        _switches.update({(scene.name, name): getattr(scene.stiv, name) for name in SWITCHES})


def _restore_switches() -> None:
    """Undo and redo leave the switches as they are, as they do with Blender's snapping."""
    global _restores_switches
    _restores_switches = True
    for (scene_name, name), before in _switches.items():
        scene = bpy.data.scenes.get(scene_name)
        if scene is not None and getattr(scene.stiv, name) != before:
            setattr(scene.stiv, name, before)
    _switches.clear()
    _restores_switches = False


@persistent
def _on_history(*_unused: object) -> None:
    _restore_switches()
    if is_on(bpy.context) and not _watch.working:
        _watch.guard = _watch.guard.after_history(undo_steps.active_step())
        _note_change()


@persistent
def _on_load(*_unused: object) -> None:
    switched(bpy.context)


HANDLERS = {
    "depsgraph_update_post": _on_update,
    "frame_change_post": _on_frame,
    "undo_pre": _before_history,
    "redo_pre": _before_history,
    "undo_post": _on_history,
    "redo_post": _on_history,
    "load_post": _on_load,
}


def register() -> None:
    """Add the handlers."""
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    """Remove the handlers and reset the state."""
    restart()
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).remove(handler)
