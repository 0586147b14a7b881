# SPDX-License-Identifier: GPL-3.0-or-later
"""Base of the transform operators: `execute` applies values; `invoke` starts a drag, which ends by `execute`."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Any

import bpy

from ... import stiv_blender
from ...intersection_texts import as_message, brief
from ...modal.drag_end import restore_after_error
from ...modal.request import Request
from ...native_module import NeedsNativeModule
from ...scene.edit_settings import edit_settings
from ...scene.frame import read_frame
from ...transform import Transform
from ...transform.frame import Frame
from ...transform.view import Vector
from ...translations import translate, translate_error
from .. import last_edit, running
from ..repair.passing import passing_text
from ..reports import (
    end_text,
    left_out_texts,
    message_text,
    report_error,
    report_outcome,
    report_raised,
    say,
    write_failure,
)
from ..start_step import StartStep
from ..task_operator import TaskOperator
from . import drag_results, redo_limit
from .constraint import Constraint, free_directions
from .options import TransformOptions

MODES = {"OBJECT", "POSE", "EDIT_MESH", "EDIT_LATTICE", "EDIT_CURVE", "EDIT_SURFACE"}


@dataclass(frozen=True)
class EndedEdit:
    """The end of an edit: its result, the report on writing it, the outcome, and what the edit left out."""

    result: stiv_blender.EditResult
    report: stiv_blender.WriteReport
    outcome: str
    left_out: list[str]

    @classmethod
    def of(
        cls,
        context: bpy.types.Context,
        edit: stiv_blender.BlenderEdit,
        result: stiv_blender.EditResult,
        report: stiv_blender.WriteReport,
    ) -> EndedEdit:
        """Call it before the edit finishes, which ends its session."""
        return cls(result, report, end_text(result, edit), left_out_texts(context, edit))


class TransformOperator(TaskOperator, NeedsNativeModule, TransformOptions):
    """Base of an operator; a subclass has a `kind`, its properties, and the methods that raise here."""

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    @classmethod
    def is_available(cls, context: bpy.types.Context) -> bool:
        """In Object Mode, Pose Mode, and Edit Mode of a mesh, a lattice or a curve, while no edit runs."""
        if obstacle := running.obstacle():
            cls.poll_message_set(obstacle)
        return context.mode in MODES and not obstacle

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Start a drag; without a 3D view, apply the values in jobs; without a window, at once.

        The drag is a separate operator without an undo step, since it may end as another kind of transform. It ends
        by calling the operator of that kind, which makes the undo step and appears in the redo panel.
        """
        if bpy.app.background or context.window is None:
            return self.execute(context)
        if context.region_data is None:
            self._start = StartStep()
            return self.start_task(context, self._steps(context))
        try:
            bpy.ops.stiv.drag("INVOKE_DEFAULT", kind=self.kind)
        except RuntimeError as error:
            return report_raised(self, error)
        return {"CANCELLED"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Apply the values of the properties, or reuse the result of a drag with these values."""
        dragged = drag_results.find(self.outcome)
        if dragged is not None and dragged.shown:
            dragged.shown, dragged.values = False, self._values()
            return {"FINISHED"}
        edit, self._start = None, StartStep()
        try:
            transform, frame = self.requested(), read_frame(context)
            edit = self._run(context, begin_edit(context, self.request(context.scene)))
            report_start(self, context, edit)
            same = dragged if dragged is not None and dragged.values == self._values() else None
            motion = self._motion(transform, frame)
            reused = _reused(edit, same, motion)
            steps = self._applied(context, edit, _solve_values(edit, motion, transform, frame))
            ended = reused or self._run(context, steps, self.time_limit)
        except Exception as error:  # nothing may stay half done, whatever went wrong
            return report_error(self, error, edit)
        return self.finish_task(context, ended)

    def finish_task(self, context: bpy.types.Context, result: Any) -> set[str]:
        """Report the end of the edit."""
        ended: EndedEdit = result
        context.window_manager.stiv_last_edit = last_edit.describe(ended.result, ended.report)
        report_outcome(self, ended.outcome, write_failure(ended.report), ended.left_out)
        return {"FINISHED"}

    def stop_task(self, context: bpy.types.Context) -> set[str]:
        """Esc: keep the part of the way that is safe."""
        self._task.cancel()
        return {"RUNNING_MODAL"}

    def requested(self) -> Transform:
        """The transform of the properties."""
        raise NotImplementedError

    def own_values(self) -> tuple[object, ...]:
        """The values of the transform's properties, for comparison."""
        raise NotImplementedError

    @staticmethod
    def arguments(transform: Any) -> dict[str, object]:
        """The properties for a transform of the operator's kind."""
        raise NotImplementedError

    def draw(self, context: bpy.types.Context) -> None:
        """The redo panel: first the values of the transform, as in Blender, then the options."""
        self.layout.use_property_split, self.layout.use_property_decorate = True, False
        described = self.properties.bl_rna.properties
        for name in (*type(self).__annotations__, *TransformOptions.__annotations__):
            if name in described and not described[name].is_hidden and self.applies(name, context):
                self.layout.prop(self, name)

    def _motion(self, transform: Transform, frame: Frame) -> stiv_blender.Motion:
        return make_motion(transform, frame, self.influence(), self.constraint())

    def _applied(
        self,
        context: bpy.types.Context,
        edit: stiv_blender.BlenderEdit,
        steps: stiv_blender.Steps[stiv_blender.EditResult],
    ) -> stiv_blender.Steps[EndedEdit]:
        result = yield from steps
        return (yield from self._written(context, edit, result))

    def _written(
        self, context: bpy.types.Context, edit: stiv_blender.BlenderEdit, result: stiv_blender.EditResult
    ) -> stiv_blender.Steps[EndedEdit]:
        """Steps that write the accepted state, and end the edit."""
        report = yield from edit.write_steps()
        self._start.add(context, edit.start_shown)
        insert_keyframes(context, edit)
        ended = EndedEdit.of(context, edit, report.result or result, report)
        edit.finish()
        return ended

    def _run(self, context: bpy.types.Context, steps: stiv_blender.Steps[Any], seconds: float = 0.0) -> Any:
        """Make all calls of the steps at once, for the redo panel within its limit, else within `seconds` (0: any)."""
        limit = redo_limit.LIMIT if redo_limit.is_redo(self) else seconds
        if limit == 0:
            return stiv_blender.run_steps(steps)
        result, was_stopped = redo_limit.run_within(context, steps, limit)
        if was_stopped:
            say(self, "WARNING", translate("stopped after {} seconds, short of the goal").format(f"{limit:.3g}"))
        return result

    def _steps(self, context: bpy.types.Context) -> stiv_blender.Steps[EndedEdit]:
        """The steps of `execute`."""
        request = self.request(context.scene)
        edit, result = yield from apply_values(self, context, request, self.requested(), self._motion)
        try:
            return (yield from self._written(context, edit, result))
        except Exception as error:
            restore_after_error(edit, error)
            raise

    def _values(self) -> tuple[object, ...]:
        return (*self.own_values(), *self.option_values())


def _reused(
    edit: stiv_blender.BlenderEdit, dragged: drag_results.DragResult | None, motion: stiv_blender.Motion
) -> EndedEdit | None:
    """The end of a drag, written again; None if it began from another state or is not clear here."""
    if dragged is None or dragged.start != edit.start_digest or not edit.resume_from(dragged.controls, motion):
        return None
    report = edit.write()
    if report.passed:
        insert_keyframes(bpy.context, edit)
        return EndedEdit(dragged.result, report, dragged.outcome, left_out_texts(bpy.context, edit))
    edit.restore()
    return None


def insert_keyframes(context: bpy.types.Context, edit: stiv_blender.Edit) -> None:
    """Insert keyframes for posed bones and placed objects if Auto Keying is on."""
    if context.mode in ("OBJECT", "POSE") and context.scene.tool_settings.use_keyframe_insert_auto:
        edit.insert_keyframes(context)


def make_motion(
    transform: Transform,
    frame: Frame,
    influence: stiv_blender.Influence | None,
    constraint: Constraint,
    place: Callable[[Vector, Vector], Vector] | None = None,
) -> stiv_blender.Motion:
    """The motion that an edit takes for a transform in its frame; `place` puts each point where it ends."""
    matrix = transform.matrix(frame)
    free = free_directions(transform, constraint)
    aligned = getattr(transform, "alignment", None)
    align = None if aligned is None else stiv_blender.Alignment(*aligned)
    return stiv_blender.Motion(matrix, frame.pivot, frame.individual, influence, transform.rotation, free, place, align)


def apply_values(
    operator: bpy.types.Operator,
    context: bpy.types.Context,
    request: Request,
    transform: Transform,
    motion_of: Callable[[Transform, Frame], stiv_blender.Motion],
) -> stiv_blender.Steps[tuple[stiv_blender.BlenderEdit, stiv_blender.EditResult]]:
    """Steps that solve for a transform from the present scene, as a script would; the result is not written."""
    frame = read_frame(context)
    edit = yield from begin_edit(context, request)
    try:
        report_start(operator, context, edit)
        result = yield from _solve_values(edit, motion_of(transform, frame), transform, frame)
    except BaseException as error:  # the start may have parted objects that touched
        restore_after_error(edit, error)
        raise
    return edit, result


def _solve_values(
    edit: stiv_blender.BlenderEdit, motion: stiv_blender.Motion, transform: Transform, frame: Frame
) -> stiv_blender.Steps[stiv_blender.EditResult]:
    return edit.apply_steps(motion, path=lambda fraction: transform.fraction(fraction).matrix(frame))


def report_start(operator: bpy.types.Operator, context: bpy.types.Context, edit: stiv_blender.BlenderEdit) -> None:
    """Report the warnings of an edit of typed values, and the objects that it does not guard."""
    for text in edit.summary.warnings:
        operator.report({"WARNING"}, message_text(text))
    if left_out := context.window_manager.stiv_check.left_out:
        operator.report({"INFO"}, as_message(map(brief, left_out.splitlines())))


def begin_edit(
    context: bpy.types.Context, request: Request, time_budget: float = 0.0
) -> stiv_blender.Steps[stiv_blender.BlenderEdit]:
    """Steps that begin an edit of the current scene.

    time_budget: seconds of each solve, 0 for no limit.
    """
    settings = edit_settings(context.scene, request, time_budget)
    without_surface = stiv_blender.find_without_surface(context)
    edit = yield from stiv_blender.BlenderEdit.begin_steps(context, settings, kind=request.kind)
    _note_unguarded(context, edit, without_surface)
    return edit


def _note_unguarded(
    context: bpy.types.Context, edit: stiv_blender.Edit, without_surface: Collection[tuple[str, str]]
) -> None:
    """Show in the panel which objects the edit does not guard, and which intersections it leaves as they are.

    without_surface: found before the start, which may copy a lattice: Blender then evaluates the scene again.
    """
    check = context.window_manager.stiv_check
    unguarded = stiv_blender.unguarded_text(context, edit.guard.evaluations, edit.carried, without_surface)
    check.left_out = "\n".join(filter(None, (unguarded, passing_text(context.scene))))
    if edit.start_notes:  # `summary` has more warnings, but reads every triangle, which is too slow for a drag
        check.summary = "; ".join(map(translate_error, edit.start_notes))
