# SPDX-License-Identifier: GPL-3.0-or-later
"""Which axes a transform may use, and whose."""

from __future__ import annotations

from dataclasses import dataclass

AXIS_KEYS = {"X": 0, "Y": 1, "Z": 2}
AXIS_NAMES = "XYZ"


@dataclass(frozen=True)
class Constraint:
    """An axis lock.

    Attributes:
        axis: None: free.
        plane: everything but `axis`.
        second: the axes are not those of the scene's orientation, but the second choice: local where the scene says
            global, and global where it says anything else.

    """

    axis: int | None = None
    plane: bool = False
    second: bool = False

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
        """Lock to an axis or a plane; the same lock once more takes the second choice of axes, then lets go."""
        if (self.axis, self.plane) != (axis, plane):
            return Constraint(axis, plane)
        return Constraint() if self.second else Constraint(axis, plane, second=True)
