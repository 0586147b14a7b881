# SPDX-License-Identifier: GPL-3.0-or-later
"""Watches Blender for the guard: handlers only note that something happened, a timer works when nothing else does."""

from __future__ import annotations

import time
import traceback
from typing import Any

import bpy
from bpy.app.handlers import persistent

from .. import native_module
from ..operators import last_edit
from . import alerts, correction, undo_steps
from .decision import LOOK_AGAIN, Action, Guard, Seen, decide, is_new_result
from .problem import Problem

STEP_NAME = "Live Guard"


class Watch:
    """All that the guard remembers.

    Attributes:
        state: of all controls when the scene was clear last, at `state_frame`; None before that.
        frame: at which the scene was last looked at.
        problem: why the scene is not clear; None if it is.
        uncorrected: results of tools that still intersect, counted since the guard was turned on.
    """

    def __init__(self) -> None:
        """Nothing accepted yet."""
        self.guard = Guard()
        self.state: Any = None
        self.state_frame = 0
        self.frame = 0
        self.updates = 0
        self.seen_updates = -1
        self.own_edits = last_edit.written()
        self.problem: Problem | None = None
        self.uncorrected = 0
        self.working = False


_watch = Watch()


def problem() -> Problem | None:
    """Why the guard cannot act; None if it can."""
    return _watch.problem


def uncorrected() -> int:
    """How many results of tools the guard left as they were, although they intersect, since it was turned on."""
    return _watch.uncorrected


def last_clear_state() -> tuple[Any, int] | None:
    """A `stiv.blender.SceneState` without intersections and its frame; None where the guard saw none so far."""
    return None if _watch.state is None else (_watch.state, _watch.state_frame)


def is_on(context: Any) -> bool:
    """Is the guard of the scene turned on, and can it work at all?"""
    return context.scene is not None and bool(context.scene.stiv.live_guard) and not native_module.problem()


def switched(context: Any) -> None:
    """The switch was turned: begin with the scene as it is, or end."""
    restart()
    if is_on(context):
        _arm()


def exclusions_changed(context: Any) -> None:
    """Other pairs of faces may intersect from now on: look again."""
    if is_on(context):
        _noted()


def restart() -> None:
    """Forget everything; the next look begins anew."""
    global _watch
    _watch = Watch()
    alerts.clear()
    if bpy.app.timers.is_registered(look):
        bpy.app.timers.unregister(look)


def look() -> float | None:
    """Look at Blender and do what is due: called by a timer; seconds until the next call, None for none."""
    window = alerts.window()
    if window is None:
        return None
    with bpy.context.temp_override(window=window):
        context = bpy.context
        if not is_on(context):
            restart()
            return None
        try:
            return _look(context, window)
        except Exception as error:  # a timer that raises is gone, and with it the guard
            traceback.print_exc()
            _give_up(Problem(reason=str(error) or type(error).__name__))
            return None


def _look(context: Any, window: Any) -> float | None:
    watch = _watch
    seen = _see(context)
    watch.guard, action = decide(watch.guard, seen)
    if action is Action.WAIT:
        return LOOK_AGAIN
    if action is not Action.REST:
        watch.working = True
        try:
            _act(context, window, action, seen)
        finally:
            watch.working = False
    _watch.seen_updates = watch.updates
    return None


def _see(context: Any) -> Seen:
    watch = _watch
    busy = alerts.is_busy()
    return Seen(
        time=time.monotonic(),
        busy=busy,
        changed=watch.updates != watch.seen_updates,
        updates=watch.updates,
        step=None if busy else undo_steps.active_step(),
        sculpting=context.mode == "SCULPT",
        accepted_by_us=last_edit.written() != watch.own_edits,
        frame_changed=context.scene.frame_current != watch.frame,
    )


def _act(context: Any, window: Any, action: Action, seen: Seen) -> None:
    watch = _watch
    if seen.sculpting:
        correction.take_strokes(context)
    if action is Action.ACCEPT:
        outcome = correction.test(context)
    else:
        outcome = correction.test(context) if action is Action.WRITE else None
        if outcome is None or outcome.problem is not None:
            outcome = correction.correct(context, watch.state)
    if outcome.wrote:
        _record(window, action, seen)
    if outcome.problem is not None and watch.state is not None and is_new_result(watch.guard, seen, action):
        watch.uncorrected += 1
    _settle(context, outcome)
    alerts.tell(context, outcome.text, watch.problem)


def _record(window: Any, action: Action, seen: Seen) -> None:
    if action is Action.REPLACE and seen.step is not None:
        undo_steps.replace_active(window, seen.step[2])
    elif action is Action.PUSH:
        undo_steps.push(window, STEP_NAME)


def _settle(context: Any, outcome: correction.Outcome) -> None:
    watch = _watch
    watch.own_edits = last_edit.written()
    watch.frame = context.scene.frame_current
    watch.problem = outcome.problem
    if outcome.problem is None:
        watch.state, watch.state_frame = correction.read(context), watch.frame
    watch.guard = watch.guard.settled(undo_steps.active_step(), outcome.problem is None)
    # Reading a mesh in Edit Mode marks it as changed: told while the guard works, it is no change to look at again.
    context.view_layer.update()


def _give_up(problem: Problem) -> None:
    """Until the next change, which is tried again."""
    _watch.problem = problem
    _watch.seen_updates = _watch.updates
    alerts.tell(bpy.context, "", problem)


def _arm() -> None:
    if not bpy.app.timers.is_registered(look):
        bpy.app.timers.register(look, first_interval=0.0)


def _noted() -> None:
    """Something changed: look at it when nothing runs any more. The guard's own writing is not looked at."""
    if not _watch.working:
        _watch.updates += 1
        _arm()


@persistent
def _on_update(scene: Any, graph: Any) -> None:
    if scene != bpy.context.scene:
        return  # copies that STIV evaluates, or a scene that is not guarded here
    if is_on(bpy.context) and any(_may_move_surfaces(each) for each in graph.updates):
        _noted()


def _may_move_surfaces(update: Any) -> bool:
    """A stroke of Sculpt Mode tells of no more than that the object is to be drawn anew."""
    moved = update.is_updated_geometry or update.is_updated_transform
    return bool(moved or (update.is_updated_shading and bpy.context.mode == "SCULPT"))


@persistent
def _on_frame(scene: Any, graph: Any) -> None:
    if is_on(bpy.context):
        _noted()


@persistent
def _on_history(*_unused: Any) -> None:
    if is_on(bpy.context) and not _watch.working:
        _watch.guard = _watch.guard.went_through_history(undo_steps.active_step())
        _noted()


@persistent
def _on_load(*_unused: Any) -> None:
    switched(bpy.context)


HANDLERS = {
    "depsgraph_update_post": _on_update,
    "frame_change_post": _on_frame,
    "undo_post": _on_history,
    "redo_post": _on_history,
    "load_post": _on_load,
}


def register() -> None:
    """Begin to listen."""
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    """Stop, and forget everything."""
    restart()
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).remove(handler)
