# SPDX-License-Identifier: GPL-3.0-or-later
"""The modal edit that runs now, in any window: there is at most one, and none outlives the extension."""

from __future__ import annotations

from typing import Protocol

import bpy

from ..translations import translate


class ModalEdit(Protocol):
    """A modal operator that restores the scene when Blender cancels it."""

    def cancel(self, context: bpy.types.Context) -> None:
        """Restore the start, and remove timer and texts."""


_running: ModalEdit | None = None


def begin(edit: ModalEdit) -> None:
    """Note that an edit runs, until `end`."""
    global _running
    _running = edit


def end() -> None:
    """Note that the edit has ended."""
    global _running
    _running = None


def obstacle() -> str:
    """Why no other edit can start; empty if none runs.

    Each edit restores its own start on Esc. Two at once, in two windows, would undo what the other has confirmed.
    """
    return "" if _running is None else translate("Another window runs an edit; finish it first")


def cancel(context: bpy.types.Context) -> None:
    """Restore the start of the running edit. Blender drops an operator without a call when its class is removed."""
    if _running is not None:
        _running.cancel(context)
        end()
