# SPDX-License-Identifier: GPL-3.0-or-later
"""An event of keyboard or mouse, as plain data."""

from __future__ import annotations

from dataclasses import dataclass

POINTER_MOVES = frozenset({"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"})
SHIFT_KEYS = frozenset({"LEFT_SHIFT", "RIGHT_SHIFT"})
CTRL_KEYS = frozenset({"LEFT_CTRL", "RIGHT_CTRL"})
WHEEL = frozenset({"WHEELUPMOUSE", "WHEELDOWNMOUSE", "WHEELINMOUSE", "WHEELOUTMOUSE"})
OTHER_NAVIGATION = frozenset({"MIDDLEMOUSE", "TRACKPADPAN", "TRACKPADZOOM", "MOUSEROTATE", "MOUSESMARTZOOM"})


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

    @property
    def navigates(self) -> bool:
        """Whether the event orbits, pans or zooms the view, and is left to Blender during a drag."""
        return self.type in WHEEL or self.type in OTHER_NAVIGATION or self.type.startswith("NDOF_")
