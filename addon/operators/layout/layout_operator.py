# SPDX-License-Identifier: GPL-3.0-or-later
"""Base of the layout operators: they solve as repair does, at once or in steps, and report names and counts."""

from __future__ import annotations

import json
from dataclasses import asdict

import bpy

from ... import stiv_blender
from ...intersection_texts import as_message
from ...translations import translate
from ..repair.reshape import ReshapeOperator
from ..task_operator import TimeLimitProperty

NAMED = 2  # objects that a message names

DONE_TEXTS = {
    "stiv.drop": "Dropped {} of {}",
    "stiv.settle_contact": "Settled {} of {}",
    "stiv.push_apart": "Moved {} of {}",
    "stiv.place": "Placed {} of {}",
    "stiv.fit_into": "Packed {} of {}",
}
REASON_TEXTS = {
    "nothing below": "{}: nothing below; add a floor",
    "nothing near": "{}: nothing near; raise Max Distance",
    "locked": "{}: its location is locked; unlock it",
    "no surface": "{}: has no surface",
    "stuck": "{}: cannot be moved apart; unlock its location",
    "no room": "{}: does not fit",
}
STATUS_TEXTS = {
    "budget": "time limit reached, nothing changed",
    "cancelled": "cancelled, nothing changed",
}


class LayoutOperator(ReshapeOperator):
    """Base of an operator; a subclass has its properties and `begin`."""

    step_seconds = 0.04  # many short steps, a few of them jobs

    time_limit: TimeLimitProperty(description="Stop after this time with nothing changed; 0 for no limit")

    @classmethod
    def is_available(cls, context: bpy.types.Context) -> bool:
        """In Object Mode, with a selection."""
        return context.mode == "OBJECT" and bool(context.selected_objects)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Remember what depends on the window, then start."""
        self.prepare(context, event)
        return super().invoke(context, event)

    def prepare(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        """Store in properties what the redo panel cannot read again from the context."""

    def _finish(self, context: bpy.types.Context, report: stiv_blender.LayoutReport) -> set[str]:
        context.window_manager.stiv_last_edit = json.dumps(asdict(report))
        texts = layout_texts(report, DONE_TEXTS[type(self).bl_idname])
        context.window_manager.stiv_check.summary = "; ".join(texts)
        if report.status == "budget":
            self.report({"ERROR"}, as_message(texts))
            return {"CANCELLED"}
        self.report({"WARNING"} if report.left else {"INFO"}, as_message(texts))
        return {"FINISHED"} if report.changed else {"CANCELLED"}


def layout_texts(report: stiv_blender.LayoutReport, done: str) -> list[str]:
    """The counts, and the first objects that stay, each with the reason."""
    if report.status in STATUS_TEXTS:
        return [translate(STATUS_TEXTS[report.status])]
    fit = stiv_blender.fit_message
    left = [fit(translate(REASON_TEXTS[reason]), name) for name, reason in report.left[:NAMED]]
    if len(report.left) > NAMED:
        left.append("...")
    if report.changed or not left:
        scaled = [translate("scaled by {}").format(f"{report.scale:.3g}")] if report.scale != 1 else []
        left = [translate(done).format(len(report.changed), report.asked), *scaled, *left]
    return left
