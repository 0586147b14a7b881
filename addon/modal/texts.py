# SPDX-License-Identifier: GPL-3.0-or-later
"""What header and status bar say during a drag."""

from __future__ import annotations

from collections.abc import Sequence

from .state import State

_VERDICTS = {
    "reached": "clear",
    "corrected": "gives way",
    "blocked": "blocked",
    "budget": "not settled yet",
    "cancelled": "cancelled",
    "unchanged": "",
}


def header_text(state: State, transform: str, verdict: str, notes: Sequence[str] = ()) -> str:
    """One line: the value, the lock, the typed text, what became of it."""
    parts = [transform]
    if state.constraint.label:
        parts.append(f"along {state.constraint.label}")
    if state.typed.active:
        parts.append(f"[{state.typed.text}|]")
    if state.precise:
        parts.append("precise")
    return "  |  ".join(part for part in ["  ".join(parts), verdict, *notes] if part)


def status_text(state: State) -> str:
    """The keys that do something now."""
    keys = ["Enter, Space, Left Mouse: confirm", "Esc, Right Mouse: cancel", "X Y Z: axis", "Shift+X/Y/Z: plane"]
    keys.append("0-9 . -: value" if not state.typed.active else "Backspace: delete")
    if not state.typed.active:
        keys.append("Shift: precise")
    return "    ".join(keys)


def verdict_text(status: str, blocking: Sequence[str] = ()) -> str:
    """What a result's status means to the user; `blocking` are names of objects in the way."""
    verdict = _VERDICTS.get(status, status)
    return f"{verdict} by {', '.join(blocking)}" if status == "blocked" and blocking else verdict
