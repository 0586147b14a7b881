# SPDX-License-Identifier: GPL-3.0-or-later
"""Which axes a transform may use."""

from __future__ import annotations

from dataclasses import dataclass

AXIS_KEYS = {"X": 0, "Y": 1, "Z": 2}
AXIS_NAMES = "XYZ"


@dataclass(frozen=True)
class Constraint:
    """An axis lock. `axis` None: free; `plane`: everything but `axis`."""

    axis: int | None = None
    plane: bool = False

    @property
    def axes(self) -> tuple[int, ...]:
        """The axes that are left, (0, 1, 2) when free."""
        if self.axis is None:
            return (0, 1, 2)
        if self.plane:
            return tuple(axis for axis in range(3) if axis != self.axis)
        return (self.axis,)

    @property
    def label(self) -> str:
        """For instance "X" or "YZ", empty when free."""
        return "" if self.axis is None else "".join(AXIS_NAMES[axis] for axis in self.axes)

    def toggled(self, axis: int, *, plane: bool) -> Constraint:
        """Lock to an axis or a plane; the same lock once more lets go."""
        wanted = Constraint(axis, plane)
        return Constraint() if wanted == self else wanted
