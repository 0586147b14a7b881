# SPDX-License-Identifier: GPL-3.0-or-later
"""What the transform operators share: values through `execute`; `invoke` starts a drag, which calls `execute` back."""

from __future__ import annotations

from typing import Any

import bpy

from ...native_module import NeedsNativeModule
from ...scene.edit_settings import DRAG_BUDGET, edit_settings
from ...scene.frame import read_frame
from ...transform.frame import Frame
from ..last_edit import describe
from ..reports import complain, outcome_text, tell, write_failure
from . import drag_results
from .options import Choices

MODES = {"OBJECT", "EDIT_MESH", "EDIT_LATTICE"}


class TransformOperator(NeedsNativeModule, Choices):
    """Base of an operator; a subclass has `kind`, `given`, `arguments` and its properties."""

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)
    kind: str

    @classmethod
    def fits(cls, context: bpy.types.Context) -> bool:
        """In Object Mode, and in Edit Mode of a mesh or a lattice."""
        return context.mode in MODES

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Start a drag; without a 3D view, apply the values.

        The drag is an operator of its own without an undo step, since it may end as another kind of transform. It ends
        by calling the operator of that kind, which makes the one undo step and is what the redo panel shows.
        """
        if context.region_data is None:
            return self.execute(context)
        try:
            bpy.ops.stiv.drag("INVOKE_DEFAULT", kind=self.kind)
        except RuntimeError as error:  # what Blender makes of a reported error
            self.report({"ERROR"}, str(error).removeprefix("Error: ").strip())
        return {"CANCELLED"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Apply the values of the properties, or take up again what a drag with these values came to."""
        outcome = drag_results.find(self.outcome)
        if outcome is not None and outcome.shown:
            outcome.shown, outcome.values = False, self._values()
            return {"FINISHED"}
        edit = None
        try:
            transform, frame = self.given(), read_frame(context)
            edit = begin_edit(context, self.request(context.scene))
            for text in edit.summary.warnings:
                self.report({"WARNING"}, text)
            if context.window_manager.stiv_check.left_out:
                self.report({"INFO"}, context.window_manager.stiv_check.left_out)
            known = outcome if outcome is not None and outcome.values == self._values() else None
            result, report = self._repeated(edit, known) or self._applied(edit, transform, frame)
            context.window_manager.stiv_last_edit = describe(result, report)
        except Exception as error:  # nothing may be left half done, whatever went wrong
            return complain(self, error, edit)
        tell(self, outcome_text(result), write_failure(report))
        return {"FINISHED"}

    def draw(self, context: bpy.types.Context) -> None:
        """The redo panel: the transform's own values first, as in Blender's, then what a drag may have chosen."""
        self.layout.use_property_split, self.layout.use_property_decorate = True, False
        described = self.properties.bl_rna.properties
        for name in (*type(self).__annotations__, *Choices.__annotations__):
            if name in described and not described[name].is_hidden:
                self.layout.prop(self, name)

    def _repeated(self, edit: Any, outcome: drag_results.Outcome | None) -> tuple[Any, Any] | None:
        """Result and report of a drag's outcome taken up again; None where it is not that start, or no longer free."""
        if outcome is None or outcome.start != edit.start_digest or not edit.take_up(outcome.controls):
            return None
        report = edit.write()
        if report.passed:
            return outcome.result, report
        edit.restore()
        return None

    def _applied(self, edit: Any, transform: Any, frame: Frame) -> tuple[Any, Any]:
        motion = make_motion(transform, frame, self.influence())
        result = edit.apply(motion, path=lambda fraction: transform.part(fraction).matrix(frame))
        report = edit.write()
        return report.result or result, report

    def _values(self) -> tuple[Any, ...]:
        return (*self.own_values(), *self.choices())


def begin_edit(context: bpy.types.Context, request: Any) -> Any:
    """`stiv.blender.BlenderEdit` of a request."""
    from stiv.blender import BlenderEdit  # the add-on registers without the native module

    return _told(context, BlenderEdit.begin(context, edit_settings(context.scene, request), kind=request.kind))


def begin_drag(context: bpy.types.Context, request: Any) -> Any:
    """The same for a drag: at once in large scenes, and with a limit to the time of each solve."""
    from stiv.blender import begin_nearby  # the add-on registers without the native module

    return _told(context, begin_nearby(context, edit_settings(context.scene, request, DRAG_BUDGET), kind=request.kind))


def _told(context: bpy.types.Context, edit: Any) -> Any:
    from stiv.blender.verify.left_out import text_not_guarded  # the add-on registers without the native module

    found = text_not_guarded(context, edit.guard.evaluations, edit.carried)
    context.window_manager.stiv_check.left_out = found
    if edit.dropped:  # the summary's other warnings look at every triangle, for which a drag has no time
        context.window_manager.stiv_check.summary = edit.dropped
    return edit


def make_motion(transform: Any, frame: Frame, influence: Any) -> Any:
    """`stiv.blender.Motion` of a transform in its frame."""
    from stiv.blender import Motion  # the add-on registers without the native module

    matrix = transform.matrix(frame)
    return Motion(matrix, frame.pivot, frame.individual, influence, rotation=transform.rotation)
