# SPDX-License-Identifier: GPL-3.0-or-later
"""A correction that runs in jobs: progress in the header, and Esc, while the guard's timer advances it."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from .. import stiv_blender
from ..modal.event import AXIS_BUTTON, OTHER_NAVIGATION, WHEEL
from ..operators import running, window_io
from ..scene.frame import view_areas
from ..translations import translate
from .correction import Outcome

TICK = 0.05  # seconds between two looks at the progress
NAVIGATION = WHEEL | OTHER_NAVIGATION | {AXIS_BUTTON}


@dataclass
class Work:
    """A correction, and whether the user has stopped it."""

    task: stiv_blender.Task[Outcome]
    stopped: bool = False

    def stop(self) -> None:
        """Ask the job to end at once; the guard's timer restores the scene."""
        self.stopped = True
        self.task.cancel()


_shown: Work | None = None  # whose progress the window shows


def begin(window: bpy.types.Window, work: Work) -> None:
    """Show the progress, and take all input of the window but navigation until `end`."""
    global _shown
    if _shown is not None or bpy.app.background:
        return
    _shown = work
    area = next((each for each in window.screen.areas if each.type == "VIEW_3D"), window.screen.areas[0])
    region = next(each for each in area.regions if each.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.stiv.guard_wait("INVOKE_DEFAULT")


def end(context: bpy.types.Context) -> None:
    """Restore cursor, header and status bar; the operator ends with the next event."""
    global _shown
    if _shown is not None:
        _shown = None
        running.end()
        window_io.show_wait_cursor(context, False)
        window_io.clear(context)


class STIV_OT_guard_wait(bpy.types.Operator):
    """Show the progress of the live guard, which Esc stops"""

    bl_idname = "stiv.guard_wait"
    bl_label = "Live Guard"
    bl_options = {"INTERNAL", "BLOCKING"}  # noqa: RUF012 (Blender reads a set)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Begin to watch."""
        self._timer = window_io.start_timer(context, TICK)
        window_io.show_wait_cursor(context, True)
        context.window_manager.modal_handler_add(self)
        running.begin(self)
        self._show(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the progress; Esc stops."""
        if _shown is None:
            window_io.stop_timer(context, self._timer)
            return {"FINISHED"}
        if event.type == "ESC" and event.value == "PRESS":
            _shown.stop()
            end(context)
        elif event.type == "TIMER":
            self._show(context)
        return {"PASS_THROUGH"} if event.type in NAVIGATION else {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator: a file is loaded, the window closes."""
        if _shown is not None:
            _shown.stop()
        window_io.stop_timer(context, self._timer)
        end(context)

    def _show(self, context: bpy.types.Context) -> None:
        if _shown is not None and view_areas(context):
            window_io.show_progress(context, _shown.task.progress.fraction, translate(self.bl_label))


CLASSES = (STIV_OT_guard_wait,)
