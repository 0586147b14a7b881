# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.drag`: a drag that begins as any kind of transform, and ends by calling the operator of its final kind."""

from __future__ import annotations

import functools
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import replace

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

from ... import stiv_blender
from ...guard import completion, undo_steps
from ...modal.axis_lock import AxisLock
from ...modal.drag_calls import DragCalls
from ...modal.drag_end import DragEnded, Progress
from ...modal.drag_loop import DragLoop
from ...modal.header_texts import turned_text
from ...modal.pointer import Pointer
from ...modal.request import Request
from ...modal.state import Effect, State
from ...native_module import Mixin
from ...overlay import display, guides
from ...scene.edit_settings import DRAG_BUDGET
from ...scene.frame import frame_in_new_view, orientation_names, read_frame, read_selection
from ...scene.tool_settings import (
    read_proportional,
    read_snap,
    snapping_kinds,
    store_proportional,
    store_snap,
    unsupported_settings,
)
from ...transform import Transform, requested_transform
from ...transform.frame import Frame
from ...transform.pointing import with_view
from ...transform.view import Vector
from ...translations import translate
from ...units import length_text, readers
from .. import last_edit, running, window_io
from ..repair import decisions
from ..reports import (
    end_text,
    left_out_texts,
    message_text,
    outcome_text,
    report_error,
    report_outcome,
    report_raised,
    write_failure,
)
from . import drag_results
from .constraint import constraint_of
from .move import STIV_OT_move
from .options import changed_options, make_influence
from .rotate import STIV_OT_rotate
from .scale import STIV_OT_scale
from .transform_operator import TransformOperator, apply_values, begin_edit, insert_keyframes, make_motion

TICK = 1.0 / 60.0  # least seconds between two solves
NO_POINTER = Pointer.at((0.0, 0.0))
OPERATORS: dict[str, type[TransformOperator]] = {
    operator.kind: operator for operator in (STIV_OT_move, STIV_OT_rotate, STIV_OT_scale)
}


class DragOperator(Mixin):
    """The operator without its registration.

    `kind` is the kind of transform at the start; `axis` (0 to 2, -1 for none) and `plane` lock it as an `AxisLock`.
    `release` names the button that is held, and whose release confirms; empty if none.
    """

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Begin the drag; if the edit is rejected, nothing changes. A long start continues in jobs."""
        if obstacle := running.obstacle():
            self.report({"ERROR"}, obstacle)
            return {"CANCELLED"}
        try:
            self._start(context, event)
        except Exception as error:
            return decisions.offer(context, error) or report_error(self, error)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Pass an event on, show the result, clean up at the end."""
        effect = Effect.NONE
        try:
            effect = self._advance(context, event)
            self._show(context)
        except Exception as error:  # Blender would keep an operator running that raises
            self._drag.abort(error)
        if self._drag.progress.ended:
            return self._end(context)
        return {"PASS_THROUGH"} if effect is Effect.PASS else {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the drag: a file is loaded, the window closes."""
        self._drag.abort(DragEnded(translate("Blender ended the drag")))
        self._leave(context)

    def _start(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        scene = context.scene
        selection = read_selection(context)
        self._frame = read_frame(context, selection)
        self._orientations = orientation_names(context)
        self._notes = unsupported_settings(context)
        self._snap = read_snap(context, selection)
        self._readers = readers(scene)
        self._length = functools.partial(length_text, units=scene.unit_settings)
        held = window_io.press_position(event, context.region) if self.release else None
        mouse = held or window_io.plain_event(event, context.region).mouse
        pointer = Pointer.at(mouse, window_io.centre(self._frame))
        request = Request(self.kind, scene.stiv.responders, scene.stiv.interference, scene.stiv.object_response)
        proportional, snap = read_proportional(context), snapping_kinds(context)
        axis_lock = AxisLock(self.axis, self.plane) if self.axis >= 0 else AxisLock()
        state = State(pointer, request, axis_lock, proportional=proportional, snap=snap, release=self.release)
        self._launch(context, state, lambda request: begin_edit(context, request, DRAG_BUDGET))

    def _launch(
        self,
        context: bpy.types.Context,
        state: State,
        begin: Callable[[Request], stiv_blender.Steps[stiv_blender.Edit]],
    ) -> None:
        self._mode = context.mode
        self._shown: tuple[object, ...] | None = None
        calls = DragCalls(
            begin,
            lambda state: requested_transform(state, self._frame, self._readers, self._snap),
            self._motion,
            lambda transform, state: self._apply_values(context, transform, state),
            stiv_blender.Task,
        )
        with ExitStack() as twins:  # removed before an undo step is stored
            twins.enter_context(stiv_blender.kept_twins())
            self._drag = DragLoop(calls, state)
            self._twins = twins.pop_all()
        self._waits, self._percent = False, -1
        self._show_waiting(context)
        self._timer = window_io.start_timer(context, TICK)
        context.window_manager.modal_handler_add(self)
        running.begin(self)

    def _motion(self, transform: Transform, state: State) -> stiv_blender.Motion:
        influence, constraint = make_influence(state.proportional), constraint_of(state, self._frame)
        return make_motion(transform, self._frame, influence, constraint, self._snap.place(state, self._frame))

    def _apply_values(
        self, context: bpy.types.Context, transform: Transform, state: State
    ) -> stiv_blender.Steps[tuple[stiv_blender.Edit, stiv_blender.EditResult]]:
        def motion_of(transform: Transform, frame: Frame) -> stiv_blender.Motion:
            return make_motion(transform, frame, make_influence(state.proportional), constraint_of(state, frame))

        return apply_values(self, context, state.request, transform, motion_of)

    def _advance(self, context: bpy.types.Context, event: bpy.types.Event) -> Effect:
        if context.mode != self._mode:
            self._drag.abort(DragEnded(translate("the mode changed during the drag")))
            return Effect.NONE
        self._follow_view(context)
        if event.type == "TIMER":
            self._drag.tick()
            return Effect.NONE
        plain = window_io.plain_event(event, context.region)
        effect = self._drag.handle(with_view(plain, self._drag.state, self._frame, self._snap))
        if effect is Effect.NAVIGATE:
            window_io.navigate(event)
        if event.type == "MOUSEMOVE":  # the latest motion: solve now, and redraw once
            self._drag.tick()
        return effect

    def _follow_view(self, context: bpy.types.Context) -> None:
        """Update the frame and the pointer if the view has changed since the last event."""
        frame = frame_in_new_view(context, self._frame)
        if frame is not self._frame:
            pointer = window_io.pointer_in_new_view(self._drag.state.pointer, self._frame, frame)
            self._frame = frame
            self._drag.change_view(pointer)

    def _show(self, context: bpy.types.Context) -> None:
        """Update header, status bar and views if anything has changed; an idle timer draws nothing."""
        drag, writer = self._drag, self._drag.writer
        self._show_waiting(context)
        chosen = drag.progress is Progress.RUNNING or drag.progress is Progress.STARTING
        guides.show(guides.guides_of(drag.state, self._frame) if chosen else None, context.region)
        if drag.progress is not Progress.RUNNING or drag.edit is None or drag.shows_soon:
            return
        label = translate(OPERATORS[drag.state.kind].bl_label)
        value = drag.transform.text(drag.state, self._frame, translate, self._length) if drag.transform else label
        status = outcome_text(drag.result, drag.edit) if drag.result is not None else ""
        news = (replace(drag.state, pointer=NO_POINTER), value, status, id(writer.written), drag.note)
        if news == self._shown:  # a moved pointer alone is drawn with its result
            return
        self._shown = news
        turned = turned_text(writer.turned, translate)
        note = message_text(drag.note)  # a longer one would not fit the header, and be left out
        notes = [text for text in (turned, note, write_failure(writer.report)) if text]
        window_io.show(context, drag.state, value, status, [*notes, *self._notes], self._orientations)
        if writer.written is not None and writer.written is drag.result:
            display.show_edit(drag.edit, writer.written, self._motion_of_all())
        elif writer.written is None and writer.report is not None:  # Blender shows another state than the result's
            display.end_edit()

    def _show_waiting(self, context: bpy.types.Context) -> None:
        """The wait cursor during a long start, and the progress of a start and of the last solve."""
        waits = self._drag.progress is Progress.STARTING
        if waits != self._waits:
            self._waits = waits
            window_io.show_wait_cursor(context, waits)
        percent = round(100 * self._drag.fraction)
        if (waits or self._drag.progress is Progress.FINISHING) and percent != self._percent:
            self._percent = percent
            label = translate(OPERATORS[self._drag.state.kind].bl_label)
            window_io.show_progress(context, self._drag.fraction, label)

    def _motion_of_all(self) -> Vector | None:
        """The motion of whole objects to the goal, (4, 4); None if each has its own, or only parts of them move."""
        if self._drag.transform is None or self._frame.individual or self._mode != "OBJECT":
            return None
        if getattr(self._drag.transform, "alignment", None) is not None:
            return None
        return self._drag.transform.matrix(self._frame)

    def _end(self, context: bpy.types.Context) -> set[str]:
        drag = self._drag
        self._leave(context)
        if drag.error is not None:
            return decisions.offer(context, drag.error) or report_error(self, drag.error)
        if drag.progress is Progress.CANCELLED or drag.transform is None:
            return {"CANCELLED"}
        try:
            return self._register(context)
        except RuntimeError as error:
            return report_raised(self, error)

    def _register(self, context: bpy.types.Context) -> set[str]:
        """Call the operator of the drag's final kind with its values, which makes the undo step."""
        drag = self._drag
        values = OPERATORS[drag.state.kind].arguments(drag.transform)
        values |= changed_options(
            drag.state.request, drag.state.proportional, constraint_of(drag.state, self._frame), context.scene
        )
        edit, result, report = drag.edit, drag.result, drag.writer.report
        if edit is not None and result is not None and report is not None:
            if context.mode.startswith("EDIT"):  # undo returns to the step of the start
                with edit.start_shown():
                    undo_steps.complete_active(context.window)
                completion.completed()
            insert_keyframes(context, edit)
            outcome = self._outcome(edit, result)
            dragged = drag_results.DragResult(edit.start_digest, edit.controls, result, report, outcome=outcome)
            values["outcome"] = drag_results.store(dragged)
            context.window_manager.stiv_last_edit = last_edit.describe(result, report)
            report_outcome(self, outcome, write_failure(report), left_out_texts(context, edit, edit.passenger_note))
            edit.finish()
        store_proportional(context, drag.state.proportional)
        store_snap(context, drag.state)
        getattr(bpy.ops.stiv, drag.state.kind)("EXEC_DEFAULT", True, **values)
        return {"FINISHED"}

    def _outcome(self, edit: stiv_blender.Edit, result: stiv_blender.EditResult) -> str:
        """The message at the end. Nothing solves on, even if the last solve used up its time."""
        if self._drag.stopped:
            return translate("stopped")
        if result.status == "budget":
            text = translate("stopped after {} seconds, short of the goal")
            return text.format(round(self._drag.seconds_confirmed))
        return end_text(result, edit)

    def _leave(self, context: bpy.types.Context) -> None:
        running.end()
        self._twins.close()
        if self._waits:
            window_io.show_wait_cursor(context, False)
        window_io.stop_timer(context, self._timer)
        display.end_edit()
        guides.show(None)
        window_io.clear(context)


class STIV_OT_drag(DragOperator, bpy.types.Operator):
    """Transform the selection with the mouse; surfaces collide instead of intersecting"""

    bl_idname = "stiv.drag"
    bl_label = "Collision Drag"
    bl_options = {"INTERNAL", "BLOCKING", "GRAB_CURSOR"}  # noqa: RUF012 (Blender reads a set)

    kind: EnumProperty(name="Transform", items=[(kind, kind.title(), "") for kind in OPERATORS], options={"SKIP_SAVE"})
    axis: IntProperty(default=-1, min=-1, max=2, options={"HIDDEN", "SKIP_SAVE"})
    plane: BoolProperty(options={"HIDDEN", "SKIP_SAVE"})
    release: StringProperty(options={"HIDDEN", "SKIP_SAVE"})
