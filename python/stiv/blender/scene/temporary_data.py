# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts the data-blocks that come and go for an evaluation.

While one of Blender's edit modes is active, its next undo step then stores the whole file.
"""

from __future__ import annotations

from collections.abc import Callable

_count = 0
_listener: Callable[[], None] | None = None


def copies_made() -> int:
    """How often data-blocks were made for an evaluation."""
    return _count


def note_copies() -> None:
    """Count data-blocks that are made now, and tell the listener."""
    global _count
    _count += 1
    if _listener is not None:
        _listener()


def on_copies(listener: Callable[[], None] | None) -> None:
    """Call a function whenever data-blocks are made for an evaluation; None for no function."""
    global _listener
    _listener = listener
