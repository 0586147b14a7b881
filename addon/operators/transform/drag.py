# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.drag`: a drag of any kind of transform; ends as the operator of the kind that it came to."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import bpy
from bpy.props import EnumProperty

from ...modal.drag_loop import Drag, DragEnded, Progress
from ...modal.edit import Request
from ...modal.pointer import Pointer
from ...modal.state import Effect, State
from ...overlay import display
from ...scene.frame import frame_in_new_view, orientation_names, read_frame
from ...scene.tool_settings import keep_proportional, read_proportional, read_snap, unsupported_settings
from ...transform import measure
from ...translations import say
from ...units import length_text, readers
from .. import window_io
from ..last_edit import describe
from ..reports import complain, outcome_text, tell, write_failure
from . import drag_results
from .move import STIV_OT_move
from .options import chosen_properties, make_influence
from .rotate import STIV_OT_rotate
from .scale import STIV_OT_scale
from .transform_operator import begin_drag, make_motion

TICK = 1.0 / 60.0  # seconds between two solves at least
OPERATORS = {operator.kind: operator for operator in (STIV_OT_move, STIV_OT_rotate, STIV_OT_scale)}


class Dragging:
    """The operator without what Blender makes of it; `kind` is the kind of transform that it starts as."""

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Begin; nothing is changed where that is refused."""
        try:
            self._start(context, event)
        except Exception as error:
            return complain(self, error, None)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Pass an event on, show what became of it, clear up at the end."""
        effect = Effect.NONE
        try:
            effect = self._advance(context, event)
            self._show(context)
        except Exception as error:  # Blender would keep an operator running that raises
            self._drag.abort(error)
        if self._drag.progress is not Progress.RUNNING:
            return self._end(context)
        return {"PASS_THROUGH"} if effect is Effect.PASS else {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the drag: a file is loaded, the window closes."""
        self._drag.abort(DragEnded("Blender ended the drag"))
        self._leave(context)

    def _start(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        scene, request = (
            context.scene,
            Request(self.kind, context.scene.stiv.responders, context.scene.stiv.interference),
        )
        self._frame = read_frame(context)
        self._axes = orientation_names(context)
        self._notes = unsupported_settings(context)
        self._snap = read_snap(context, lambda: self._drag.edit.moving, lambda: self._frame.view)
        self._readers = readers(scene)
        self._length = functools.partial(length_text, units=scene.unit_settings)
        mouse = window_io.plain_event(event, context.region).mouse
        proportional, snaps = read_proportional(context), scene.tool_settings.use_snap
        state = State(Pointer.at(mouse, window_io.centre(self._frame)), request, proportional=proportional, snap=snaps)
        self._launch(context, state, lambda request: begin_drag(context, request))

    def _launch(self, context: bpy.types.Context, state: State, begin: Callable[[Request], Any]) -> None:
        self._mode = context.mode
        self._shown: Any = None
        self._drag = Drag(
            begin,
            lambda state: measure(state, self._frame, self._readers, self._snap),
            lambda transform, state: make_motion(transform, self._frame, make_influence(state.proportional)),
            state,
        )
        self._timer = window_io.start_timer(context, TICK)
        context.window_manager.modal_handler_add(self)

    def _advance(self, context: bpy.types.Context, event: bpy.types.Event) -> Effect:
        if context.mode != self._mode:
            self._drag.abort(DragEnded("the mode changed during the drag"))
            return Effect.NONE
        self._look(context)
        if event.type == "TIMER":
            self._drag.tick()
            return Effect.NONE
        return self._drag.handle(window_io.plain_event(event, context.region))

    def _look(self, context: bpy.types.Context) -> None:
        """Follow a view that was turned, moved or zoomed since the last event."""
        frame = frame_in_new_view(context, self._frame)
        if frame is not self._frame:
            pointer = window_io.pointer_seen_anew(self._drag.state.pointer, self._frame, frame)
            self._frame = frame
            self._drag.look(pointer)

    def _show(self, context: bpy.types.Context) -> None:
        """Header, status bar and views, if there is anything new: a timer that only waits draws nothing."""
        drag = self._drag
        news = (drag.state, id(drag.result), drag.note)
        if news == self._shown or drag.progress is not Progress.RUNNING:
            return
        self._shown = news
        label = say(OPERATORS[drag.state.kind].bl_label)
        value = drag.transform.text(say, self._length) if drag.transform is not None else label
        verdict = outcome_text(drag.result) if drag.result is not None else ""
        told = [text for text in (drag.note, write_failure(drag.report)) if text]
        window_io.show(context, drag.state, value, verdict, [*told, *self._notes], self._axes)
        if drag.result is not None:
            display.show_edit(drag.edit, drag.result)

    def _end(self, context: bpy.types.Context) -> set[str]:
        drag = self._drag
        self._leave(context)
        if drag.error is not None:
            return complain(self, drag.error, None)
        if drag.progress is Progress.CANCELLED or drag.transform is None:
            return {"CANCELLED"}
        try:
            return self._register(context)
        except RuntimeError as error:  # what Blender makes of a reported error
            self.report({"ERROR"}, str(error).removeprefix("Error: ").strip())
            return {"CANCELLED"}

    def _register(self, context: bpy.types.Context) -> set[str]:
        """Call the operator of the drag's kind with its values: it makes the undo step."""
        drag = self._drag
        operator = OPERATORS[drag.state.kind]
        values = operator.arguments(drag.transform)
        values |= chosen_properties(drag.state.request, drag.state.proportional, context.scene)
        if drag.progress is Progress.FINISHED:
            edit = drag.edit
            values["outcome"] = drag_results.keep(
                drag_results.Outcome(edit.start_digest, edit.controls, drag.result, drag.report)
            )
            context.window_manager.stiv_last_edit = describe(drag.result, drag.report)
            tell(self, outcome_text(drag.result), write_failure(drag.report))
        keep_proportional(context, drag.state.proportional)
        getattr(bpy.ops.stiv, drag.state.kind)("EXEC_DEFAULT", True, **values)
        return {"FINISHED"}

    def _leave(self, context: bpy.types.Context) -> None:
        window_io.stop_timer(context, self._timer)
        display.end_edit()
        window_io.clear(context)


class STIV_OT_drag(Dragging, bpy.types.Operator):
    """Transform the selection with the mouse; surfaces collide instead of intersecting"""

    bl_idname = "stiv.drag"
    bl_label = "Collision Drag"
    bl_options = {"INTERNAL", "BLOCKING", "GRAB_CURSOR"}  # noqa: RUF012 (Blender reads a set)

    kind: EnumProperty(name="Transform", items=[(kind, kind.title(), "") for kind in OPERATORS], options={"SKIP_SAVE"})
