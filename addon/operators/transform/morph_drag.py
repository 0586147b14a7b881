# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.morph_drag`: drags values of shape keys with the mouse, and ends by calling `stiv.morph`."""

from __future__ import annotations

import bpy

from ... import stiv_blender
from ...modal.header_texts import result_text
from ...modal.morph_state import KeyRange, MorphState, hints, step
from ...modal.state import Effect
from ...native_module import NeedsNativeModule
from ...scene.edit_settings import edit_settings
from ...scene.frame import view_areas
from ...translations import translate
from .. import running, window_io
from ..reports import message_text, report_error, report_raised
from .morph import STIV_OT_morph, register_drag

TICK = 1.0 / 60.0  # least seconds between two solves
BUDGET = 0.038  # seconds of a solve: a frame of 24 a second, less events and headers
RANGE_WIDTH = 300.0  # pixels that drag a key through its range, at scale 1


class STIV_OT_morph_drag(NeedsNativeModule, bpy.types.Operator):
    """Drag the value of the active shape key until surfaces touch"""

    bl_idname = "stiv.morph_drag"
    bl_label = "Collision Morph Drag"
    bl_options = {"BLOCKING", "GRAB_CURSOR"}  # noqa: RUF012 (Blender reads a set)

    @classmethod
    def is_available(cls, context: bpy.types.Context) -> bool:
        """As `stiv.morph`, while no edit runs."""
        if obstacle := running.obstacle():
            cls.poll_message_set(obstacle)
        return STIV_OT_morph.is_available(context) and not obstacle

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Begin the drag; if it is rejected, nothing changes."""
        ob = context.active_object
        self._object = ob.name
        self._start = {block.name: block.value for block in ob.data.shape_keys.key_blocks}
        keys = tuple(
            KeyRange(block.name, block.slider_min, block.slider_max, block.value)
            for block in stiv_blender.movable_keys(ob)
        )
        names = [each.name for each in keys]
        active = ob.active_shape_key.name if ob.active_shape_key is not None else ""
        if not names:
            text = translate("{}: no shape key can be moved; add one")
            self.report({"ERROR"}, stiv_blender.fit_message(text, ob.name))
            return {"CANCELLED"}
        width = RANGE_WIDTH * context.preferences.system.ui_scale
        mouse = window_io.plain_event(event, context.region).mouse
        self._state = MorphState.at(keys, names.index(active) if active in names else 0, mouse, width)
        try:
            self._begin(context)
        except Exception as error:
            return report_error(self, error)
        self._mode = context.mode
        self._result: stiv_blender.EditResult | None = None
        self._pending, self._timer = False, window_io.start_timer(context, TICK)
        context.window_manager.modal_handler_add(self)
        running.begin(self)
        self._show(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Take an event; solve with each tick."""
        try:
            return self._take(context, event)
        except Exception as error:  # Blender would keep an operator running that raises
            self._restore()
            self._leave(context)
            return report_error(self, error)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the drag: a file is loaded, the window closes."""
        self._restore()
        self._leave(context)

    def _take(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "TIMER":
            if self._pending:
                self._solve(context)
            return {"RUNNING_MODAL"}
        before = self._state
        self._state, effect = step(before, window_io.plain_event(event, context.region))
        if effect is Effect.PASS:
            return {"PASS_THROUGH"}
        if effect is Effect.CANCEL or context.mode != self._mode:
            self._restore()
            self._leave(context)
            return {"CANCELLED"}
        if effect is Effect.CONFIRM:
            return self._confirm(context)
        if effect is Effect.UPDATE:
            self._pending = True
            if set(self._state.goals) != set(before.goals) or self._state.others_yield != before.others_yield:
                self._begin(context)
            self._show(context)
        return {"RUNNING_MODAL"}

    def _begin(self, context: bpy.types.Context) -> None:
        """Begin an edit of the keys dragged so far; from the start, since others may yield no more."""
        self._restore()
        self._edit = stiv_blender.MorphEdit.begin(
            context, self._goals, edit_settings(context.scene), others_yield=self._state.others_yield
        )

    @property
    def _goals(self) -> dict[str, dict[str, float]]:
        return {self._object: dict(self._state.goals)}

    def _solve(self, context: bpy.types.Context) -> None:
        self._result, done = self._edit.advance(self._edit.goals(self._goals), BUDGET)
        self._pending = not done
        self._failure = self._edit.show()
        self._show(context)

    def _values(self) -> dict[str, float]:
        sliders = self._edit.sliders
        return {each.key: float(value) for each, value in zip(sliders, self._edit.values, strict=True)}

    def _confirm(self, context: bpy.types.Context) -> set[str]:
        """Solve to the end, then let `stiv.morph` make the undo step."""
        found, _ = self._edit.advance(self._edit.goals(self._goals))
        self._edit.settle()
        self._edit.show()
        self._edit.insert_keyframes(context)
        self._leave(context)
        goals = {name: value for name, value in self._state.goals.items() if value != self._start[name]}
        if not goals:
            return {"CANCELLED"}
        rows = [{"name": name, "value": value} for name, value in goals.items()]
        values = {(self._object, key): value for key, value in self._values().items()}
        note = self._edit.torn_seam_note
        result = stiv_blender.MorphReport(found.status, values, tuple(found.blocking), torn_seam_note=note)
        try:
            register_drag(result, keys=rows, others_yield=self._state.others_yield)
        except RuntimeError as error:
            return report_raised(self, error)
        return {"FINISHED"}

    def _restore(self) -> None:
        """Write the values of the start."""
        ob = bpy.data.objects.get(self._object)
        blocks = {} if ob is None or ob.data.shape_keys is None else ob.data.shape_keys.key_blocks
        for name, value in self._start.items():
            if name in blocks and blocks[name].value != value:
                blocks[name].value = value
        bpy.context.view_layer.update()

    def _show(self, context: bpy.types.Context) -> None:
        state, result, fill = self._state, self._result, stiv_blender.fit_message
        status = "" if result is None else result_text(result.status, tuple(result.blocking), translate, fill)
        notes = [state.error, message_text(getattr(self, "_failure", ""))]
        modes = translate("others yield") if state.others_yield else ""
        parts = [translate(STIV_OT_morph.bl_label), state.text(self._values()), status, modes, *notes]
        window_io.write_header(context, [each for each in parts if each])
        window_io.write_keys(context, hints(translate))
        for area in view_areas(context):
            area.tag_redraw()

    def _leave(self, context: bpy.types.Context) -> None:
        running.end()
        window_io.stop_timer(context, self._timer)
        window_io.clear(context)
