# SPDX-License-Identifier: GPL-3.0-or-later
"""What the transform operators share: values through `execute`, a drag through `invoke` and `modal`."""

from __future__ import annotations

import traceback
from typing import Any

import bpy

from .. import availability, scene_frame
from ..modal.drag import Drag, DragEnded, Progress, put_back
from ..modal.pointer import Pointer
from ..modal.state import State
from ..settings import DRAG_BUDGET, edit_settings
from . import interface
from .last_edit import describe
from .messages import outcome_text, write_failure

MODES = {"OBJECT", "EDIT_MESH", "EDIT_LATTICE"}
TICK = 1.0 / 60.0  # seconds between two solves at least


class TransformOperator:
    """Base of an operator; a subclass has `kind`, `given`, `measure`, `keep` and its properties."""

    bl_options = {"REGISTER", "UNDO", "BLOCKING", "GRAB_CURSOR"}  # noqa: RUF012 (Blender reads a set)
    kind: str

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """In Object Mode, and in Edit Mode of a mesh or a lattice, with the native module."""
        if availability.problem():
            cls.poll_message_set(availability.problem())
            return False
        return context.mode in MODES

    def frame(self, context: bpy.types.Context) -> scene_frame.Frame:
        """Pivot, axes and view."""
        return scene_frame.read_frame(context)

    def prepare(self, context: bpy.types.Context) -> None:
        """Before a drag: take from the scene what `execute` takes from properties."""

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Apply the values of the properties."""
        edit = None
        try:
            transform, frame = self.given(), self.frame(context)
            edit = self._begin(context)
            result = edit.apply(transform.matrix(frame), path=lambda fraction: transform.part(fraction).matrix(frame))
            report = edit.write()
            result = report.result or result
            context.window_manager.stiv_last_edit = describe(result, report)
        except Exception as error:  # nothing may be left half done, whatever went wrong
            return self._refuse(error, edit)
        self._tell(outcome_text(result), write_failure(report))
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Start a drag; without a 3D view, apply the values."""
        if context.region_data is None:
            return self.execute(context)
        self.prepare(context)
        try:
            frame = self.frame(context)
            edit = self._begin(context, time_budget=DRAG_BUDGET)
        except Exception as error:
            return self._refuse(error, None)
        self._start(context, event, frame, edit)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Pass an event on, show what became of it, clear up at the end."""
        try:
            self._advance(context, event)
            self._show(context)
        except Exception as error:  # Blender would keep an operator running that raises
            self._drag.abort(error)
        return {"RUNNING_MODAL"} if self._drag.progress is Progress.RUNNING else self._end(context)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the drag: a file is loaded, the window closes."""
        self._drag.abort(DragEnded("the drag was ended by Blender"))
        self._leave(context)

    def _begin(self, context: bpy.types.Context, time_budget: float = 0.0) -> Any:
        from stiv.blender import BlenderEdit  # the add-on registers without the native module

        return BlenderEdit.begin(context, edit_settings(context.scene, time_budget), kind=self.kind)

    def _start(self, context: bpy.types.Context, event: bpy.types.Event, frame: scene_frame.Frame, edit: Any) -> None:
        pointer = Pointer.at(interface.plain_event(event, context.region).mouse, interface.centre(frame))
        self._drag = Drag(
            edit, lambda state: self.measure(state, frame), lambda transform: transform.matrix(frame), State(pointer)
        )
        self._mode = context.mode
        self._notes = scene_frame.notes(context)
        self._shown: Any = None
        self._timer = context.window_manager.event_timer_add(TICK, window=context.window)
        context.window_manager.modal_handler_add(self)

    def _advance(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        if context.mode != self._mode:
            self._drag.abort(DragEnded("the mode changed during the drag"))
        elif event.type == "TIMER":
            self._drag.tick()
        else:
            self._drag.handle(interface.plain_event(event, context.region))

    def _show(self, context: bpy.types.Context) -> None:
        """Header, status bar and views, if there is anything new: a timer that only waits draws nothing."""
        drag = self._drag
        news = (drag.state, id(drag.result), drag.note)
        if news == self._shown or drag.progress is not Progress.RUNNING:
            return
        self._shown = news
        value = drag.transform.text() if drag.transform is not None else self.bl_label
        verdict = outcome_text(drag.result) if drag.result is not None else ""
        told = [text for text in (drag.note, write_failure(drag.report)) if text]
        interface.show(context, drag.state, value, verdict, [*told, *self._notes])

    def _end(self, context: bpy.types.Context) -> set[str]:
        drag = self._drag
        self._leave(context)
        if drag.error is not None:
            return self._refuse(drag.error, None)
        if drag.progress is Progress.CANCELLED:
            return {"CANCELLED"}
        if drag.transform is not None:
            self.keep(drag.transform)
        if drag.progress is Progress.VALUE_GIVEN:
            return self.execute(context)  # so that a typed value, a script and the redo panel give the same
        if drag.result is not None:
            context.window_manager.stiv_last_edit = describe(drag.result, drag.report)
            self._tell(outcome_text(drag.result), write_failure(drag.report))
        return {"FINISHED"}

    def _leave(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        interface.clear(context)

    def _tell(self, outcome: str, failure: str) -> None:
        if failure:
            self.report({"WARNING"}, failure)
        elif outcome:
            self.report({"INFO"}, outcome)

    def _refuse(self, error: Exception, edit: Any) -> set[str]:
        """Report an error with nothing changed. The trace of what nobody expected is printed."""
        from stiv.blender import SceneChangedError

        if edit is not None:
            put_back(edit, error)
        if not isinstance(error, ValueError | SceneChangedError | DragEnded):
            traceback.print_exception(error)
        self.report({"ERROR"}, "; ".join([str(error) or type(error).__name__, *getattr(error, "__notes__", ())]))
        return {"CANCELLED"}
