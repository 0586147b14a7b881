# SPDX-License-Identifier: GPL-3.0-or-later
"""The state of a drag: everything that its events have said so far."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

from .axis_lock import Constraint
from .edit import Request
from .pointer import Pointer
from .proportional import Proportional
from .typed_numbers import TypedValues


class Phase(Enum):
    """Where a drag is; the last two are final."""

    DRAGGING = "dragging"
    CONFIRMED = "confirmed"
    CANCELLED = "cancelled"


class Effect(Enum):
    """What a step asks of the caller."""

    NONE = "none"
    UPDATE = "update"
    """The goal changed: solve and show."""
    PASS = "pass"
    """The event belongs to the view: leave it to Blender."""
    CONFIRM = "confirm"
    CANCEL = "cancel"


@dataclass(frozen=True)
class State:
    """Everything that the events of a drag have said so far.

    Attributes:
        pointer: where the mouse is.
        request: kind of transform, who gives way, and whether anything does.
        constraint: the axis lock.
        typed: typed numbers.
        proportional: proportional editing.
        snap: whether snapping is switched on; Ctrl held turns it round.
        ctrl: whether Ctrl is held.
        precise: whether Shift is held.
        phase: whether the drag goes on.

    """

    pointer: Pointer
    request: Request = field(default_factory=Request)
    constraint: Constraint = field(default_factory=Constraint)
    typed: TypedValues = field(default_factory=TypedValues)
    proportional: Proportional = field(default_factory=Proportional)
    snap: bool = False
    ctrl: bool = False
    precise: bool = False
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
        """How many numbers can be typed."""
        return 1 if self.kind == "rotate" else len(self.constraint.axes)
