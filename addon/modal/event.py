# SPDX-License-Identifier: GPL-3.0-or-later
"""One event of keyboard or mouse, as plain data, and which of them turn, pan or zoom the view."""

from __future__ import annotations

from dataclasses import dataclass

POINTER_MOVES = frozenset({"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"})
SHIFT_KEYS = frozenset({"LEFT_SHIFT", "RIGHT_SHIFT"})
CTRL_KEYS = frozenset({"LEFT_CTRL", "RIGHT_CTRL"})


@dataclass(frozen=True)
class Event:
    """An event under Blender's names.

    Attributes:
        type: "MOUSEMOVE", "X", "RET", ...
        value: "PRESS", "RELEASE" or "NOTHING".
        mouse: position of the pointer in pixels of the region, y upwards.
        modifiers: subset of {"shift", "ctrl", "alt", "oskey"} held down.
        text: the character that the key types, empty if none.

    """

    type: str
    value: str = "PRESS"
    mouse: tuple[float, float] = (0.0, 0.0)
    modifiers: frozenset[str] = frozenset()
    text: str = ""

    @property
    def pressed(self) -> bool:
        """Whether a key or button went down."""
        return self.value == "PRESS"

    @property
    def precise(self) -> bool:
        """Whether Shift is held, which makes the pointer ten times finer."""
        return "shift" in self.modifiers


WHEEL = frozenset({"WHEELUPMOUSE", "WHEELDOWNMOUSE", "WHEELINMOUSE", "WHEELOUTMOUSE"})
OTHERS = frozenset({"MIDDLEMOUSE", "TRACKPADPAN", "TRACKPADZOOM", "MOUSEROTATE", "MOUSESMARTZOOM"})


def navigates(event: Event) -> bool:
    """Whether an event belongs to the view."""
    return event.type in WHEEL or event.type in OTHERS or event.type.startswith("NDOF_")
