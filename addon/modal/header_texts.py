# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts of header and status bar during a drag; `translate` puts a text into the language of the interface."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from .proportional import Proportional
from .state import State

Translate = Callable[[str], str]

DECIMALS = 4
_STATUS_TEXTS = {
    "reached": "clear",
    "corrected": "deflected",
    "blocked": "blocked",
    "budget": "still solving",
    "cancelled": "cancelled",
    "unchanged": "",
    "unguarded": "collisions off",
}
_RESPONDER_TEXTS = {"unselected": "yields: others", "all": "yields: both"}


def header_text(
    state: State,
    transform: str,
    status: str,
    notes: Sequence[str] = (),
    orientations: tuple[str, str] = ("", ""),
    translate: Translate = str,
) -> str:
    """One line: value, axis lock, typed text, status. `orientations` names those of the first and second axis key."""
    parts = [transform]
    if state.axis_lock.label:
        name = orientations[state.axis_lock.second].title()
        axes = f"{translate(name)} {state.axis_lock.label}" if name else state.axis_lock.label
        parts.append(translate("along {}").format(axes))
    if state.typed.active:
        parts.append(state.typed.text(state.components))
    parts.extend(filter(None, (_proportional_text(state.proportional, translate), *_modes(state, translate))))
    return "  |  ".join(part for part in ["  ".join(parts), status, *notes] if part)


def _proportional_text(proportional: Proportional, translate: Translate) -> str:
    if not proportional.active:
        return ""
    parts = [translate("proportional {}").format(f"{proportional.size:.4g}")]
    parts.append(translate(proportional.falloff.replace("_", " ").title()))
    return " ".join([*parts, *([translate("connected")] if proportional.connected else [])])


def _modes(state: State, translate: Translate) -> list[str]:
    """Modes that differ from the defaults."""
    responders = _RESPONDER_TEXTS.get(state.request.responders, "")
    return [
        translate("precision") if state.precise else "",
        translate("snap") if state.snapping else "",
        translate(responders) if responders else "",
    ]


def status_text(state: State, translate: Translate = str) -> str:
    """The keys that have an effect now."""
    if state.typed.expression:
        keys = [translate("Enter: confirm"), translate("Esc: cancel"), translate("+ - * / ( ) and units: expression")]
        return "    ".join([*keys, translate("Tab: next axis"), translate("Backspace: delete")])
    keys = [translate("Enter, Space, Left Mouse: confirm"), translate("Esc, Right Mouse: cancel")]
    keys += [translate("G R S: transform"), translate("X Y Z: axis"), translate("Shift+X/Y/Z: plane")]
    if state.typed.active:
        keys += [translate("Tab: next axis"), translate("=: expression"), translate("Backspace: delete")]
    else:
        keys += [translate("0-9 . - =: value"), translate("Shift: precision"), translate("Ctrl: snap")]
    if state.proportional.available:
        keys.append(translate("O: proportional"))
    if state.proportional.active:
        keys += [translate("Wheel, Page Up/Down: size"), translate("Shift+O: falloff")]
    return "    ".join([*keys, translate("W: yields"), translate("I: collisions")])


def result_text(status: str, blocking: Sequence[str] = (), translate: Translate = str) -> str:
    """The status of a result for the user; `blocking` names the objects that block the edit."""
    if status == "blocked" and blocking:
        return translate("blocked by {}").format(", ".join(blocking))
    text = _STATUS_TEXTS.get(status, status)
    return translate(text) if text else ""


def decimal_text(value: float, decimals: int = DECIMALS) -> str:
    """A number with at most `decimals` digits after the point, without trailing zeros; rounding noise becomes "0"."""
    text = f"{value:.{decimals}f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text == "-0" else text
