# SPDX-License-Identifier: GPL-3.0-or-later
"""Proportional editing during a drag."""

from __future__ import annotations

from dataclasses import dataclass, replace

FALLOFFS = ("SMOOTH", "SPHERE", "ROOT", "INVERSE_SQUARE", "SHARP", "LINEAR", "CONSTANT", "RANDOM")
GROWTH, FINE_GROWTH = 1.1, 1.01  # factors of the size for one notch of the wheel, and with Shift
PAN_GROWTH = 0.005  # of the size for each pixel of a pan on a trackpad
LARGER_KEYS = frozenset({"PAGE_UP", "WHEELDOWNMOUSE", "NUMPAD_PLUS"})  # as in Blender's own transforms
SMALLER_KEYS = frozenset({"PAGE_DOWN", "WHEELUPMOUSE", "NUMPAD_MINUS"})


@dataclass(frozen=True)
class Proportional:
    """Settings of proportional editing.

    Attributes:
        available: whether the mode has it: in Edit Mode.
        on: whether it is turned on.
        size: radius in world units.
        falloff: one of FALLOFFS.
        connected: distances are measured along the edges of the cage.

    """

    available: bool = False
    on: bool = False
    size: float = 1.0
    falloff: str = "SMOOTH"
    connected: bool = False

    @property
    def active(self) -> bool:
        """Whether points near the selection move with it."""
        return self.available and self.on

    def toggled(self) -> Proportional:
        """Turned on or off, if available."""
        return replace(self, on=self.available and not self.on)

    def with_next_falloff(self) -> Proportional:
        """With the next falloff of the list."""
        return replace(self, falloff=FALLOFFS[(FALLOFFS.index(self.falloff) + 1) % len(FALLOFFS)])

    def with_other_distances(self) -> Proportional:
        """With distances along the edges instead of in space, or the other way round."""
        return replace(self, connected=not self.connected)

    def resized(self, key: str, *, fine: bool = False) -> Proportional:
        """With the size changed by one notch of the wheel or one press of a page key."""
        growth = FINE_GROWTH if fine else GROWTH
        return replace(self, size=self.size * (growth if key in LARGER_KEYS else 1.0 / growth))

    def panned(self, pixels: float) -> Proportional:
        """With the size changed by a pan on a trackpad."""
        return replace(self, size=self.size * max(1.0 + PAN_GROWTH * pixels, 1.0 / GROWTH))
