# SPDX-License-Identifier: GPL-3.0-or-later
"""The axes that a transform may use."""

from __future__ import annotations

from dataclasses import dataclass

AXIS_KEYS = {"X": 0, "Y": 1, "Z": 2}
AXIS_NAMES = "XYZ"


@dataclass(frozen=True)
class AxisLock:
    """A lock to one axis, or to the plane perpendicular to it.

    Attributes:
        axis: index of the axis; None without a lock.
        plane: the lock is to the plane perpendicular to `axis`.
        second: the axes are those of the second orientation: local if the scene's orientation is global, else global.

    """

    axis: int | None = None
    plane: bool = False
    second: bool = False

    @property
    def axes(self) -> tuple[int, ...]:
        """Indices of the axes that may be used, (0, 1, 2) without a lock."""
        if self.axis is None:
            return (0, 1, 2)
        if self.plane:
            return tuple(axis for axis in range(3) if axis != self.axis)
        return (self.axis,)

    @property
    def label(self) -> str:
        """For instance "X" or "YZ"; empty without a lock."""
        return "" if self.axis is None else "".join(AXIS_NAMES[axis] for axis in self.axes)

    def toggled(self, axis: int, *, plane: bool) -> AxisLock:
        """The lock after the key of an axis: repeating it switches to the second orientation, then to no lock."""
        if (self.axis, self.plane) != (axis, plane):
            return AxisLock(axis, plane)
        return AxisLock() if self.second else AxisLock(axis, plane, second=True)
