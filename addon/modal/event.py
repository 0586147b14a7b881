# SPDX-License-Identifier: GPL-3.0-or-later
"""An event of keyboard or mouse, as plain data."""

from __future__ import annotations

from dataclasses import dataclass

POINTER_MOVES = frozenset({"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"})
SHIFT_KEYS = frozenset({"LEFT_SHIFT", "RIGHT_SHIFT"})
CTRL_KEYS = frozenset({"LEFT_CTRL", "RIGHT_CTRL"})
WHEEL = frozenset({"WHEELUPMOUSE", "WHEELDOWNMOUSE", "WHEELINMOUSE", "WHEELOUTMOUSE"})
AXIS_BUTTON = "MIDDLEMOUSE"
OTHER_NAVIGATION = frozenset({"TRACKPADPAN", "TRACKPADZOOM", "MOUSEROTATE", "MOUSESMARTZOOM"})


@dataclass(frozen=True)
class Event:
    """An event under Blender's names.

    Attributes:
        type: "MOUSEMOVE", "X", "RET", ...
        value: "PRESS", "RELEASE" or "NOTHING".
        mouse: position of the pointer in pixels of the region, y upwards.
        modifiers: subset of {"shift", "ctrl", "alt", "oskey"} held down.
        text: the character that the key types, empty if none.
        pan: vertical motion of a trackpad, in pixels.
        target: (3,) what the pointer snaps to, for the keys that use it; None without a target.
        axis: index of the axis along which the pointer has moved in the view, for the button that uses it.

    """

    type: str
    value: str = "PRESS"
    mouse: tuple[float, float] = (0.0, 0.0)
    modifiers: frozenset[str] = frozenset()
    text: str = ""
    pan: float = 0.0
    target: tuple[float, float, float] | None = None
    axis: int | None = None

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
        """Whether the event orbits, pans or zooms the view; the middle button does with Alt."""
        if self.type == AXIS_BUTTON:
            return "alt" in self.modifiers
        return self.type in WHEEL or self.type in OTHER_NAVIGATION or self.type.startswith("NDOF_")
