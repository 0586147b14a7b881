# SPDX-License-Identifier: GPL-3.0-or-later
"""What a drag needs of an edit of the scene, and what it is begun with: another request needs another edit."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Protocol


class Edit(Protocol):
    """An edit that goals can be given to again and again; `stiv.blender.BlenderEdit` is one."""

    @property
    def interference(self) -> bool:
        """Whether anything gives way."""

    def set_interference(self, on: bool) -> str:
        """Switch it; says why not, or where that led back to."""

    def drag(self, motion: Any, *, time_budget: float) -> Any:
        """Solve for an absolute goal in so many seconds; the same goal again takes up what these ended."""

    def settle(self) -> Any:
        """Solve again from the accepted state."""

    def write(self) -> Any:
        """Show the accepted state."""

    def restore(self) -> None:
        """Put everything back as it was at the start."""


def put_back(edit: Edit, error: Exception) -> None:
    """Restore after an error; where that fails too (the scene is gone), the error says so."""
    try:
        edit.restore()
    except Exception as second:
        error.add_note(f"while restoring: {second}")


KIND_KEYS = {"G": "move", "R": "rotate", "S": "scale"}
RESPONDERS = ("selected", "unselected", "all")


@dataclass(frozen=True)
class Request:
    """`kind`: "move", "rotate" or "scale"; `responders`: who gives way; `interference`: whether anything does."""

    kind: str = "move"
    responders: str = "selected"
    interference: bool = True

    def with_next_responders(self) -> Request:
        """Somebody else gives way."""
        return replace(self, responders=RESPONDERS[(RESPONDERS.index(self.responders) + 1) % len(RESPONDERS)])
