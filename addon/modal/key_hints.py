# SPDX-License-Identifier: GPL-3.0-or-later
"""The keys of a drag for the status bar: Blender's icons with a word each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from .header_texts import Translate
from .state import State


@dataclass(frozen=True)
class KeyHint:
    """Names of the icons of keys and buttons, and what they do."""

    icons: tuple[str, ...]
    label: str


CONFIRM, CANCEL = ("EVENT_RETURN", "MOUSE_LMB"), ("EVENT_ESC", "MOUSE_RMB")
AXES = ("EVENT_X", "EVENT_Y", "EVENT_Z")


def key_hints(state: State, translate: Translate = str) -> list[KeyHint]:
    """The keys that have an effect now, the most important first."""
    if state.typed.active:
        return _typing_hints(state, translate)
    hints = [
        KeyHint(CONFIRM, translate("Confirm")),
        KeyHint(CANCEL, translate("Cancel")),
        KeyHint(AXES, translate("Axis")),
        KeyHint(("EVENT_SHIFT", *AXES), translate("Plane")),
        KeyHint(("EVENT_CTRL",), translate("Snap")),
        KeyHint(("EVENT_W",), translate("Yields")),
        KeyHint(("EVENT_T",), translate("Response")),
        KeyHint(("EVENT_I",), translate("Collisions")),
    ]
    if state.proportional.available:
        hints.append(KeyHint(("EVENT_O",), translate("Proportional")))
    if state.proportional.active:
        hints.append(KeyHint(("EVENT_PAGEUP", "EVENT_PAGEDOWN"), translate("Size")))
        hints.append(KeyHint(("EVENT_SHIFT", "EVENT_O"), translate("Falloff")))
    hints.append(KeyHint(("EVENT_SHIFT",), translate("Precision")))
    hints.append(KeyHint(("EVENT_G", "EVENT_R", "EVENT_S"), translate("Transform")))
    return hints


def _typing_hints(state: State, translate: Translate) -> list[KeyHint]:
    hints = [
        KeyHint(("EVENT_RETURN",), translate("Confirm")),
        KeyHint(("EVENT_ESC",), translate("Cancel")),
        KeyHint(("EVENT_TAB",), translate("Next Axis")),
        KeyHint(("EVENT_BACKSPACE",), translate("Delete")),
    ]
    if state.typed.expression:
        return hints
    return [*hints, KeyHint(("EVENT_EQUAL",), translate("Expression")), KeyHint(("EVENT_MINUS",), translate("Negate"))]


def stop_hints(translate: Translate = str) -> list[KeyHint]:
    """The keys while a goal is solved to its end."""
    return [KeyHint(("EVENT_ESC",), translate("Stop"))]


def hints_that_fit(hints: Sequence[KeyHint], width: float, width_of: Callable[[KeyHint], float]) -> list[KeyHint]:
    """The first hints that fit a width together."""
    shown, left = [], width
    for hint in hints:
        left -= width_of(hint)
        if left < 0.0:
            break
        shown.append(hint)
    return shown
