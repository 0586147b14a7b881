# SPDX-License-Identifier: GPL-3.0-or-later
"""The state of a drag, determined by its events."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

from .axis_lock import AxisLock
from .pointer import Pointer
from .proportional import Proportional
from .request import Request
from .typed_numbers import TypedValues


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
        snap: whether snapping is turned on; Ctrl inverts it.
        ctrl: whether Ctrl is held.
        precise: whether Shift is held.
        release: the button whose release confirms, since it was held when the drag began; empty if none.
        phase: whether the drag continues.

    """

    pointer: Pointer
    request: Request = field(default_factory=Request)
    axis_lock: AxisLock = field(default_factory=AxisLock)
    typed: TypedValues = field(default_factory=TypedValues)
    proportional: Proportional = field(default_factory=Proportional)
    snap: bool = False
    ctrl: bool = False
    precise: bool = False
    release: str = ""
    phase: Phase = Phase.DRAGGING

    @property
    def kind(self) -> str:
        """Kind of transform."""
        return self.request.kind

    @property
    def snapping(self) -> bool:
        """Whether the goal snaps."""
        return self.snap != self.ctrl

    @property
    def components(self) -> int:
        """Number of values that can be typed."""
        return 1 if self.kind == "rotate" else len(self.axis_lock.axes)
