# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.popup`: opens a popup when the mouse rests. Blender closes a popup that a moving mouse leaves, often unseen."""

from __future__ import annotations

from collections.abc import Callable

import bpy

from .. import running, window_io
from ..reports import say

TICK = 0.05  # seconds between two looks at the mouse
REST = 5  # ticks without a motion after which the mouse rests: slow drawing delays motions, but ticks with them
LONGEST = 60  # ticks after which the popup opens under a moving mouse
CANCELLING = frozenset({"ESC", "RIGHTMOUSE"})
MOTIONS = frozenset({"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"})

Draw = Callable[[bpy.types.UIPopupMenu, bpy.types.Context], None]


class STIV_OT_popup(bpy.types.Operator):
    """Show why the edit cannot start, and the ways out"""

    bl_idname = "stiv.popup"
    bl_label = "Collision Popup"
    bl_options = {"INTERNAL"}  # noqa: RUF012 (Blender reads a set)

    waiting: tuple[Draw, str] | None = None  # the content and the title of the next popup

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Begin to wait."""
        if STIV_OT_popup.waiting is None:
            return {"CANCELLED"}
        self._still = self._waited = 0  # ticks since the last motion, and since the beginning
        self._timer = window_io.start_timer(context, TICK)
        context.window_manager.modal_handler_add(self)
        running.begin(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Wait for the mouse to rest."""
        if event.type == "TIMER":
            self._still, self._waited = self._still + 1, self._waited + 1
        elif event.type in MOTIONS:
            self._still = 0
        next_step = decide(event.type, event.value, self._still, self._waited)
        if next_step == "wait":
            return {"PASS_THROUGH"}
        self.cancel(context)
        shown, STIV_OT_popup.waiting = STIV_OT_popup.waiting, None
        if shown is None or next_step == "cancel":
            return {"CANCELLED"}
        context.window_manager.popup_menu(shown[0], title=shown[1], icon="ERROR")
        say(self, "INFO", shown[1])  # stays in the status bar when the popup is closed
        return {"FINISHED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Stop the timer; Blender calls this when it ends the operator, for instance to load a file."""
        running.end()
        window_io.stop_timer(context, self._timer)


def decide(kind: str, value: str, still: int, waited: int) -> str:
    """The next step after an event: "wait", "open" or "cancel".

    A pressed key or button belongs to the edit that could not start, and must reach nothing else.

    Args:
        kind: the event's type.
        value: the event's value.
        still: ticks since the mouse moved.
        waited: ticks since the beginning.
    """
    if kind == "TIMER":
        return "open" if still >= REST or waited >= LONGEST else "wait"
    if kind in MOTIONS or value != "PRESS":
        return "wait"
    return "cancel" if kind in CANCELLING else "open"


def open_popup(draw: Draw, title: str) -> None:
    """Open a popup when the mouse rests, or when a key or a button is pressed."""
    STIV_OT_popup.waiting = draw, title
    bpy.ops.stiv.popup("INVOKE_DEFAULT")
