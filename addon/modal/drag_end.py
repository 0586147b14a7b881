# SPDX-License-Identifier: GPL-3.0-or-later
"""The status of a drag, and its end after an error or an event outside it."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..stiv_blender import Edit


class Progress(Enum):
    """The status of a drag after an event."""

    STARTING = "starting"
    RUNNING = "running"
    FINISHING = "finishing"
    """Confirmed: the goal is solved for to the end, until Esc stops it."""
    FINISHED = "finished"
    CANCELLED = "cancelled"

    @property
    def ended(self) -> bool:
        """Whether the drag takes no more events."""
        return self in (Progress.FINISHED, Progress.CANCELLED)


class DragEnded(RuntimeError):  # noqa: N818 (it is not an error)
    """An event outside the drag ended it."""


def restore_after_error(edit: Edit, error: BaseException) -> None:
    """Restore the start; if that fails too because the scene is gone, `error` gets a note."""
    try:
        edit.restore()
    except Exception as second:
        error.add_note(f"while restoring: {second}")
