# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.morph`: moves values of the active object's shape keys until surfaces touch."""

from __future__ import annotations

import json

import bpy
from bpy.props import BoolProperty, CollectionProperty

from ... import stiv_blender
from ...modal.header_texts import result_text
from ...native_module import NeedsNativeModule
from ...properties import StivKeyValue
from ...scene.edit_settings import edit_settings
from ...translations import translate
from ..reports import message_text, report_error, say
from ..task_operator import TimeLimitProperty
from . import redo_limit
from .morph_in_steps import MorphInSteps

REDO_TIME_LIMIT = 10.0  # seconds: Blender waits while the redo panel repeats a morph


class STIV_OT_morph(MorphInSteps, NeedsNativeModule, bpy.types.Operator):
    """Move shape key values until surfaces touch"""

    bl_idname = "stiv.morph"
    bl_label = "Collision Morph"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    keys: CollectionProperty(name="Shape Keys", type=StivKeyValue)
    others_yield: BoolProperty(name="Others Yield", description="Let the other shape keys of the object respond")
    time_limit: TimeLimitProperty(
        description="Take the best result within this time; 0 for no limit", options={"HIDDEN", "SKIP_SAVE"}
    )

    _is_invoked = False  # the dialog calls the next `execute`

    @classmethod
    def is_available(cls, context: bpy.types.Context) -> bool:
        """In Object Mode, with an active object that has shape keys."""
        data = None if context.active_object is None else context.active_object.data
        return bool(context.mode == "OBJECT" and getattr(data, "shape_keys", None) is not None)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the sliders of the shape keys in a dialog."""
        self.keys.clear()
        for block in stiv_blender.movable_keys(context.active_object):
            row = self.keys.add()
            row.name, row.value = block.name, block.value
        self._is_invoked = True
        result: set[str] = context.window_manager.invoke_props_dialog(self)
        return result

    def draw(self, context: bpy.types.Context) -> None:
        """A slider for each key, and the options."""
        self.layout.use_property_split, self.layout.use_property_decorate = True, False
        for row in self.keys:
            self.layout.prop(row, "value", text=row.name, translate=False)
        self.layout.prop(self, "others_yield")
        self.layout.prop(self, "time_limit")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Move the keys whose value differs from the given one, and report; or take the result of a drag.

        From the dialog in steps, with progress in the header; at once from scripts and from the redo panel.
        """
        in_steps, self._is_invoked = self._is_invoked and not bpy.app.background, False
        ob = context.active_object
        present = {block.name: block.value for block in ob.data.shape_keys.key_blocks}
        self._before = {(ob.name, key): value for key, value in present.items()}
        dragged = _take_dragged()
        if dragged is not None:
            return self.finish_task(context, dragged)
        values = {row.name: row.value for row in self.keys if row.value != present.get(row.name)}
        if not values:
            self.report({"INFO"}, translate("No value changes"))
            return {"CANCELLED"}
        try:
            settings = edit_settings(context.scene, time_budget=self._time_budget())
            morph = stiv_blender.MorphTask(context, {ob.name: values}, settings, others_yield=self.others_yield)
            if in_steps:
                return self.start_morph(context, morph)
            found = stiv_blender.run_steps(morph.solve_steps())
        except Exception as error:  # nothing may stay half done, whatever went wrong
            return report_error(self, error)
        return self.finish_task(context, found)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender closes the dialog, or ends the running morph."""
        if not self._is_invoked:
            super().cancel(context)

    def finish_task(self, context: bpy.types.Context, result: stiv_blender.MorphReport) -> set[str]:
        """Report."""
        values = {key: value for (_, key), value in result.values.items()}
        described = {"status": result.status, "blocking": result.blocking, "values": values}
        context.window_manager.stiv_last_edit = json.dumps(described)
        for note in filter(None, (*result.start_notes, result.torn_seam_note)):
            self.report({"WARNING"}, message_text(note))
        if late := _late_text(result, self._before):
            self.report({"WARNING"}, late)
        elif text := result_text(result.status, result.blocking, translate, stiv_blender.fit_message):
            say(self, "INFO", text)
        return {"FINISHED"}

    def _time_budget(self) -> float:
        if not redo_limit.is_redo(self):
            return float(self.time_limit)
        return min(self.time_limit or REDO_TIME_LIMIT, REDO_TIME_LIMIT)


def _late_text(found: stiv_blender.MorphReport, before: dict[tuple[str, str], float]) -> str:
    """The text on a morph that the time limit ended; empty for others. before: values by object and key."""
    if found.status != "budget":
        return ""
    if any(before.get(slider, value) != value for slider, value in found.values.items()):
        return translate("time limit reached, result so far kept; run it again to continue")
    return translate("time limit reached, nothing changed")


def register_drag(result: stiv_blender.MorphReport, **properties: object) -> None:
    """Call the operator for the result of a drag, which makes the undo step. Raises RuntimeError."""
    global _dragged
    _dragged = result
    bpy.ops.stiv.morph("EXEC_DEFAULT", True, **properties)


_dragged: stiv_blender.MorphReport | None = None  # shown already, and not yet registered


def _take_dragged() -> stiv_blender.MorphReport | None:
    global _dragged
    found, _dragged = _dragged, None
    return found
