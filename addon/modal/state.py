# SPDX-License-Identifier: GPL-3.0-or-later
"""The state of a drag, determined by its events."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import Enum

from .axis_lock import AxisLock
from .pointer import Pointer
from .proportional import Proportional
from .request import Request
from .typed_numbers import TypedValues

Point = tuple[float, float, float]


class Phase(Enum):
    """The phase of a drag; the last two are final."""

    DRAGGING = "dragging"
    CONFIRMED = "confirmed"
    CANCELLED = "cancelled"


class Effect(Enum):
    """The action that a step requests of the caller."""

    NONE = "none"
    UPDATE = "update"
    """The goal changed: solve and show."""
    PASS = "pass"
    """The event belongs to the view: leave it to Blender."""
    NAVIGATE = "navigate"
    """The event would turn, shift or zoom the view without Alt."""
    CONFIRM = "confirm"
    CANCEL = "cancel"
    STOP = "stop"
    """Confirmed, but the solve toward the goal should stop: keep the last accepted state."""


@dataclass(frozen=True)
class State:
    """The state of a drag.

    Attributes:
        pointer: the pointer since the start.
        request: kind of transform, which side yields, and whether surfaces collide.
        axis_lock: the axes that the transform may use.
        typed: typed numbers.
        proportional: proportional editing.
        snap: the kinds of transform that snap; Ctrl inverts it.
        ctrl: whether Ctrl is held.
        precise: whether Shift is held.
        release: the button whose release confirms, since it was held when the drag began; empty if none.
        phase: whether the drag continues.
        picking_axis: "axis" or "plane" while the motion of the pointer chooses the lock; otherwise empty.
        trackball: a rotation follows the pointer about both axes of the view.
        snap_points: targets added to that under the pointer: the selection moves to their mean.
        picking_base: whether the pointer picks the point of the selection that moves onto the target.
        base: (3,) that point, None before it is picked.

    """

    pointer: Pointer
    request: Request = field(default_factory=Request)
    axis_lock: AxisLock = field(default_factory=AxisLock)
    typed: TypedValues = field(default_factory=TypedValues)
    proportional: Proportional = field(default_factory=Proportional)
    snap: frozenset[str] = frozenset()
    ctrl: bool = False
    precise: bool = False
    release: str = ""
    phase: Phase = Phase.DRAGGING
    picking_axis: str = ""
    trackball: bool = False
    snap_points: tuple[Point, ...] = ()
    picking_base: bool = False
    base: Point | None = None

    @property
    def kind(self) -> str:
        """Kind of transform."""
        return self.request.kind

    @property
    def snapping(self) -> bool:
        """Whether the goal snaps."""
        return (self.kind in self.snap) != self.ctrl

    @property
    def components(self) -> int:
        """Number of values that can be typed."""
        if self.kind == "rotate":
            return 2 if self.trackball else 1
        return len(self.axis_lock.axes)


def same_goal(first: State | None, second: State | None) -> bool:
    """Whether two states differ at most by the confirmation."""
    return first is not None and second is not None and replace(first, phase=second.phase) == second
