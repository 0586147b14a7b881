# SPDX-License-Identifier: GPL-3.0-or-later
"""What header and status bar say during a drag; `say` puts a text into the language of the interface."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from .proportional import Proportional
from .state import State

Say = Callable[[str], str]

_VERDICT_WORDS = {
    "reached": "clear",
    "corrected": "deflected",
    "blocked": "blocked",
    "budget": "still solving",
    "cancelled": "cancelled",
    "unchanged": "",
    "unguarded": "collisions off",
}
_RESPONDER_WORDS = {"unselected": "yields: others", "all": "yields: both"}


def header_text(
    state: State,
    transform: str,
    verdict: str,
    notes: Sequence[str] = (),
    axes: tuple[str, str] = ("", ""),
    say: Say = str,
) -> str:
    """One line: the value, the lock, the typed text, what became of it. `axes` names both choices of axes."""
    parts = [transform]
    if state.constraint.label:
        name = axes[state.constraint.second].title()
        parts.append(
            say("along {}").format(f"{say(name)} {state.constraint.label}" if name else state.constraint.label)
        )
    if state.typed.active:
        parts.append(state.typed.text(state.components))
    parts.extend(text for text in (_proportional_text(state.proportional, say), *_modes(state, say)) if text)
    return "  |  ".join(part for part in ["  ".join(parts), verdict, *notes] if part)


def _proportional_text(proportional: Proportional, say: Say) -> str:
    if not proportional.active:
        return ""
    parts = [say("proportional {}").format(f"{proportional.size:.4g}")]
    parts.append(say(proportional.falloff.replace("_", " ").title()))
    return " ".join([*parts, *([say("connected")] if proportional.connected else [])])


def _modes(state: State, say: Say) -> list[str]:
    """What is not as usual."""
    who = _RESPONDER_WORDS.get(state.request.responders, "")
    return [say("precision") if state.precise else "", say("snap") if state.snapping else "", say(who) if who else ""]


def status_text(state: State, say: Say = str) -> str:
    """The keys that do something now."""
    if state.typed.expression:
        keys = [say("Enter: confirm"), say("Esc: cancel"), say("+ - * / ( ) and units: expression")]
        return "    ".join([*keys, say("Tab: next axis"), say("Backspace: delete")])
    keys = [say("Enter, Space, Left Mouse: confirm"), say("Esc, Right Mouse: cancel"), say("G R S: transform")]
    keys += [say("X Y Z: axis"), say("Shift+X/Y/Z: plane")]
    if state.typed.active:
        keys += [say("Tab: next axis"), say("=: expression"), say("Backspace: delete")]
    else:
        keys += [say("0-9 . - =: value"), say("Shift: precision"), say("Ctrl: snap")]
    if state.proportional.available:
        keys.append(say("O: proportional"))
    if state.proportional.active:
        keys += [say("Wheel, Page Up/Down: size"), say("Shift+O: falloff")]
    return "    ".join([*keys, say("W: yields"), say("I: collisions")])


def verdict_text(status: str, blocking: Sequence[str] = (), say: Say = str) -> str:
    """What a result's status means to the user; `blocking` are names of objects in the way."""
    if status == "blocked" and blocking:
        return say("blocked by {}").format(", ".join(blocking))
    word = _VERDICT_WORDS.get(status, status)
    return say(word) if word else ""


DECIMALS = 4


def decimal_text(value: float, decimals: int = DECIMALS) -> str:
    """A number with at most so many digits after the point, without trailing zeros; rounding noise becomes "0"."""
    text = f"{value:.{decimals}f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text == "-0" else text
