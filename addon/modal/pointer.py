# SPDX-License-Identifier: GPL-3.0-or-later
"""The position of the pointer that a drag uses, with or without precision."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

PRECISION = 0.1  # fraction of the motion that counts while Shift is held


@dataclass(frozen=True)
class Pointer:
    """The pointer since the start of a drag, in pixels of the region.

    Attributes:
        start: position at the start of the drag.
        last: last position.
        effective: position that the drag uses; differs from `last` after precise motion.
        centre: the pivot in the region, None without a view.
        turn: angle around the centre since the start, radians, counterclockwise, over any number of turns.

    """

    start: tuple[float, float]
    last: tuple[float, float]
    effective: tuple[float, float]
    centre: tuple[float, float] | None = None
    turn: float = 0.0

    @staticmethod
    def at(mouse: tuple[float, float], centre: tuple[float, float] | None = None) -> Pointer:
        """A pointer that has not moved."""
        return Pointer(mouse, mouse, mouse, centre)

    def moved(self, mouse: tuple[float, float], *, precise: bool = False) -> Pointer:
        """The pointer after a motion to `mouse`."""
        fraction = PRECISION if precise else 1.0
        effective = (
            self.effective[0] + fraction * (mouse[0] - self.last[0]),
            self.effective[1] + fraction * (mouse[1] - self.last[1]),
        )
        turn = self.turn + fraction * self._turn_to(mouse)
        return Pointer(self.start, mouse, effective, self.centre, turn)

    def in_new_view(self, start: tuple[float, float], centre: tuple[float, float] | None) -> Pointer:
        """The pointer after the view changed, with the start and the pivot in the new view; `turn` stays."""
        return replace(self, start=start, effective=self.last, centre=centre)

    def _turn_to(self, mouse: tuple[float, float]) -> float:
        if self.centre is None:
            return 0.0
        before = (self.last[0] - self.centre[0], self.last[1] - self.centre[1])
        after = (mouse[0] - self.centre[0], mouse[1] - self.centre[1])
        cross = before[0] * after[1] - before[1] * after[0]
        dot = before[0] * after[0] + before[1] * after[1]
        return math.atan2(cross, dot)
