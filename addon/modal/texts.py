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
    "unguarded": "interference ignored",
}


def header_text(
    state: State, transform: str, verdict: str, notes: Sequence[str] = (), axes: tuple[str, str] = ("", "")
) -> str:
    """One line: the value, the lock, the typed text, what became of it. `axes` names both choices of axes."""
    parts = [transform]
    if state.constraint.label:
        parts.append(f"along {axes[state.constraint.second].title()} {state.constraint.label}".replace("  ", " "))
    if state.typed.active:
        parts.append(state.typed.text(state.components))
    parts.extend(text for text in (state.proportional.text, *_modes(state)) if text)
    return "  |  ".join(part for part in ["  ".join(parts), verdict, *notes] if part)


def _modes(state: State) -> list[str]:
    """What is not as usual."""
    who = "" if state.request.responders == "selected" else f"gives way: {state.request.responders}"
    return ["precise" if state.precise else "", "snap" if state.snapping else "", who]


def status_text(state: State) -> str:
    """The keys that do something now."""
    if state.typed.expression:
        keys = ["Enter: confirm", "Esc: cancel", "+ - * / ( ) and units: expression", "Tab: next", "Backspace: delete"]
        return "    ".join(keys)
    keys = ["Enter, Space, Left Mouse: confirm", "Esc, Right Mouse: cancel", "G R S: kind", "X Y Z: axis"]
    keys.append("Shift+X/Y/Z: plane")
    if state.typed.active:
        keys += ["Tab: next", "=: expression", "Backspace: delete"]
    else:
        keys += ["0-9 . - =: value", "Shift: precise", "Ctrl: snap"]
    if state.proportional.available:
        keys += ["O: proportional", *(["Wheel, Page: size", "Shift+O: falloff"] if state.proportional.on else [])]
    return "    ".join([*keys, "W: who gives way", "I: interference"])


def verdict_text(status: str, blocking: Sequence[str] = ()) -> str:
    """What a result's status means to the user; `blocking` are names of objects in the way."""
    verdict = _VERDICTS.get(status, status)
    return f"{verdict} by {', '.join(blocking)}" if status == "blocked" and blocking else verdict
