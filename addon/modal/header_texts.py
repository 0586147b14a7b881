# SPDX-License-Identifier: GPL-3.0-or-later
"""Text of the header during a drag, in Blender's own wording; `translate` puts it into the interface's language."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from .axis_lock import AXIS_NAMES, AxisLock
from .proportional import Proportional
from .state import State

Translate = Callable[[str], str]

DIGITS = 4
SEPARATOR = "  |  "
_STATUS_TEXTS = {
    "reached": "clear",
    "corrected": "deflected",
    "blocked": "blocked",
    "budget": "still solving",
    "cancelled": "cancelled",
    "unchanged": "",
    "unguarded": "collisions off",
}
_RESPONSE_TEXTS = {"slide_and_turn": "slide and turn", "deform": "deform"}
_RESPONDER_TEXTS = {"unselected": "yields: others", "all": "yields: both"}


def header_parts(
    state: State,
    value: str,
    status: str,
    notes: Sequence[str] = (),
    orientations: tuple[str, str] = ("", ""),
    translate: Translate = str,
) -> list[str]:
    """Parts of the line, the most important first: value with axis lock, status, proportional editing, modes, notes.

    value: `text` of the transform. orientations: names of those of the first and the second press of an axis key.
    """
    name = orientations[state.axis_lock.second].replace("_", " ")
    first = " ".join(filter(None, [value, axis_text(state.axis_lock, name, translate)]))
    proportional = _proportional_text(state.proportional, translate)
    modes = ", ".join(filter(None, _modes(state, translate)))
    return [part for part in (first, status, proportional, modes, *notes) if part]


def fitted(parts: Sequence[str], fits: Callable[[str], bool]) -> str:
    """One line of the parts that fit; the first is always shown."""
    shown = list(parts[:1])
    for part in parts[1:]:
        shown += [part] if fits(SEPARATOR.join([*shown, part])) else []
    return SEPARATOR.join(shown)


def axis_text(lock: AxisLock, orientation: str, translate: Translate = str) -> str:
    """The axis lock as Blender writes it: "along global X", or "locking global X" for the plane across X."""
    if lock.axis is None:
        return ""
    axis = " ".join(filter(None, (translate(orientation.title()).lower(), AXIS_NAMES[lock.axis])))
    return translate("locking {}" if lock.plane else "along {}").format(axis)


def entry_text(state: State, index: int, value: str) -> str:
    """A value, after the typed text if there is any: "[5|] = 5.000 m"."""
    if not state.typed.active or index >= state.components:
        return value
    typed, is_current = state.typed.numbers[index], index == state.typed.index
    return f"[{typed.text}{'|' if is_current else ''}] = {value}" if typed.active or is_current else value


def progress_text(fraction: float, translate: Translate = str) -> str:
    """The header while a goal is solved to its end; fraction: 0 to 1."""
    return translate("Solving {}, Esc stops").format(f"{fraction:.0%}".replace("%", " %"))


def _proportional_text(proportional: Proportional, translate: Translate) -> str:
    if not proportional.active:
        return ""
    parts = [translate("Proportional Size: {}").format(f"{proportional.size:.2f}")]
    parts.append(translate(proportional.falloff.replace("_", " ").title()))
    return ", ".join([*parts, *([translate("connected")] if proportional.connected else [])])


def _modes(state: State, translate: Translate) -> list[str]:
    """Modes that differ from the defaults."""
    responders = _RESPONDER_TEXTS.get(state.request.responders, "")
    response = _RESPONSE_TEXTS.get(state.request.response, "")
    return [
        translate("precision") if state.precise else "",
        translate("snap") if state.snapping else "",
        translate(responders) if responders else "",
        translate(response) if response else "",
    ]


def result_text(
    status: str, blocking: Sequence[str] = (), translate: Translate = str, fill: Callable[..., str] = str.format
) -> str:
    """The status of a result for the user; `blocking` names the objects that block the edit.

    fill: puts the names into a template.
    """
    if status == "blocked" and blocking:
        return naming(translate("blocked by {}"), translate, fill, blocking)
    text = _STATUS_TEXTS.get(status, status)
    return translate(text) if text else ""


def turned_text(angle: float, translate: Translate = str) -> str:
    """The angle, in radians, by which contact has turned an object; empty below half a degree."""
    degrees = round(math.degrees(angle))
    return translate("turned {}°").format(degrees) if degrees else ""


MAX_NAMES = 3


def listed(names: Sequence[str], translate: Translate = str, most: int = MAX_NAMES) -> str:
    """The first names, and the number of the others."""
    first, others = ", ".join(names[:most]), len(names) - most
    return translate("{} and {} more").format(first, others) if others > 0 else first


def naming(text: str, translate: Translate, fill: Callable[..., str], *lists: Sequence[str]) -> str:
    """A text with the first names of a list at each of its {}, and the number of the others.

    fill: puts the names into a template.
    """
    most = MAX_NAMES if len(lists) == 1 or max(map(len, lists)) <= MAX_NAMES else 1
    places = [listed(["{}"] * len(names), translate, most) for names in lists]
    return fill(text.format(*places), *(name for names in lists for name in names[:most]))


def fixed_text(value: float, digits: int = DIGITS) -> str:
    """A number with `digits` digits, as in Blender's headers, but with trailing zeros: "4.300", "12.34", "0.0000".

    Numbers below 1 have `digits` decimals, and a number that rounds to zero has no sign: no rounding noise.
    """
    whole = len(str(int(abs(value)))) if abs(value) >= 1.0 and math.isfinite(value) else 0
    text = f"{value:.{max(digits - whole, 0)}f}"
    return text if any(digit in text for digit in "123456789") or not text.startswith("-") else text[1:]
