# SPDX-License-Identifier: GPL-3.0-or-later
"""The undo step to which Ctrl+Z returns after an operator that has copied objects in an edit mode."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext

import bpy

from .. import stiv_blender
from ..guard import completion, undo_steps

ShowsStart = Callable[[], AbstractContextManager[None]]  # inside, and the present state again afterwards


class StartStep:
    """Stores the whole file in that step once the operator has succeeded, and before Blender adds the operator's own.

    An operator with a step of its own cannot replace another step. A timer does it while the operator waits. From
    scripts, which do not wait, the operator adds a step instead.
    """

    def __init__(self, sets: bool = False) -> None:
        """Call it when the operator begins. sets: it changes settings, which no step of an edit mode holds."""
        self._sets = sets
        self._copies = stiv_blender.copies_made()
        self._window: bpy.types.Window | None = None
        self._is_done = self._is_cancelled = False

    def is_needed(self, context: bpy.types.Context) -> bool:
        """Whether the operator has copied objects in an edit mode, or changes settings there."""
        is_due = self._sets or self._copies != stiv_blender.copies_made()
        return is_due and context.mode.startswith("EDIT")

    def add(self, context: bpy.types.Context, start_shown: ShowsStart = nullcontext) -> None:
        """Add a step if needed."""
        if self.is_needed(context):
            with start_shown():
                undo_steps.add_start()
            completion.completed()

    def wait(self, context: bpy.types.Context, start_shown: ShowsStart = nullcontext) -> bool:
        """Whether the step is complete, if needed; the first call starts the timer."""
        if not self.is_needed(context):
            return True
        if self._window is None:
            self._window, self._start_shown = context.window, start_shown
            bpy.app.timers.register(self._complete, first_interval=0.0)
        return self._is_done

    def cancel(self) -> None:
        """Let the timer store nothing: the operator ends."""
        self._is_cancelled = True

    def _complete(self) -> None:
        if self._is_cancelled or self._window is None:
            return
        try:
            with self._start_shown():
                undo_steps.complete_active(self._window)
            completion.completed()
        finally:
            self._is_done = True
