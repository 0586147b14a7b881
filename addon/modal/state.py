# SPDX-License-Identifier: GPL-3.0-or-later
"""The state machine of a drag: `step(state, event)` gives the next state and what is to be done."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import Enum

from .constraint import AXIS_KEYS, Constraint
from .events import POINTER_MOVES, SHIFT_KEYS, Event
from .pointer import Pointer
from .typed_number import TypedNumber, typed_character

CONFIRM_KEYS = frozenset({"RET", "NUMPAD_ENTER", "SPACE", "LEFTMOUSE"})
CANCEL_KEYS = frozenset({"ESC", "RIGHTMOUSE"})


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
    CONFIRM = "confirm"
    CANCEL = "cancel"


@dataclass(frozen=True)
class State:
    """Everything that the events of a drag have said so far."""

    pointer: Pointer
    constraint: Constraint = field(default_factory=Constraint)
    typed: TypedNumber = field(default_factory=TypedNumber)
    precise: bool = False
    phase: Phase = Phase.DRAGGING


def step(state: State, event: Event) -> tuple[State, Effect]:
    """The state after an event. In a final phase nothing happens any more."""
    if state.phase is not Phase.DRAGGING:
        return state, Effect.NONE
    if event.type in POINTER_MOVES:
        return _point(state, event)
    if event.type in SHIFT_KEYS:
        return replace(state, precise=event.pressed), Effect.NONE
    return _press(state, event) if event.pressed else (state, Effect.NONE)


def _point(state: State, event: Event) -> tuple[State, Effect]:
    pointer = state.pointer.moved(event.mouse, precise=event.precise)
    moved = replace(state, pointer=pointer, precise=event.precise)
    # A typed number stands whatever the pointer does; the motion still counts once the number is deleted.
    return moved, Effect.NONE if state.typed.active else Effect.UPDATE


def _press(state: State, event: Event) -> tuple[State, Effect]:
    if event.type in CANCEL_KEYS:
        return replace(state, phase=Phase.CANCELLED), Effect.CANCEL
    if event.type in CONFIRM_KEYS:
        return replace(state, phase=Phase.CONFIRMED), Effect.CONFIRM
    if event.type in AXIS_KEYS and not event.modifiers - {"shift"}:
        constraint = state.constraint.toggled(AXIS_KEYS[event.type], plane="shift" in event.modifiers)
        return replace(state, constraint=constraint), Effect.UPDATE
    return _type(state, typed_character(event))


def _type(state: State, character: str) -> tuple[State, Effect]:
    typed = state.typed.typed(character) if character else state.typed
    if typed == state.typed:
        return state, Effect.NONE
    return replace(state, typed=typed), Effect.UPDATE
