# SPDX-License-Identifier: GPL-3.0-or-later
"""The state of a shape key drag: events change the goals of the keys, without bpy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from .event import POINTER_MOVES, SHIFT_KEYS, Event
from .event_handling import CANCEL_KEYS, CONFIRM_KEYS, RESPONDERS_KEY
from .header_texts import Translate, fixed_text
from .key_hints import CANCEL, CONFIRM, KeyHint
from .pointer import Pointer
from .state import Effect
from .typed_numbers import TypedNumber, typed_character

NEXT_KEYS = {"DOWN_ARROW": 1, "UP_ARROW": -1, "TAB": 1}


@dataclass(frozen=True)
class KeyRange:
    """A shape key: the limits of its slider, and its value at the start."""

    name: str
    lower: float
    upper: float
    start: float


@dataclass(frozen=True)
class MorphState:
    """Keys that the pointer drags, each in its turn.

    Attributes:
        keys: those that can be dragged.
        index: the one that the pointer drags.
        pointer: since this key is dragged.
        width: pixels of the way that drags a key through its range.
        goals: of the keys dragged so far, by name.
        base: goal of the present key where the pointer began.
        typed: replaces the pointer.
        others_yield: the other keys respond.
        error: of the typed text; "" if it is a number.
    """

    keys: tuple[KeyRange, ...]
    index: int
    pointer: Pointer
    width: float
    goals: Mapping[str, float] = field(default_factory=dict)
    base: float = 0.0
    typed: TypedNumber = field(default_factory=TypedNumber)
    others_yield: bool = False
    error: str = ""

    @staticmethod
    def at(keys: tuple[KeyRange, ...], index: int, mouse: tuple[float, float], width: float) -> MorphState:
        """Before the first motion."""
        start = keys[index].start
        return MorphState(keys, index, Pointer.at(mouse), width, {keys[index].name: start}, start)

    @property
    def key(self) -> KeyRange:
        """The key that the pointer drags."""
        return self.keys[self.index]

    def text(self, shown: Mapping[str, float]) -> str:
        """The keys dragged so far with the values shown; typed text before that of the present one."""
        parts = []
        for name in self.goals:
            value = fixed_text(shown.get(name, self.goals[name]))
            typed = f"[{self.typed.text}|] = " if name == self.key.name and self.typed.active else ""
            parts.append(f"{name}: {typed}{value}")
        return ", ".join(parts)


def step(state: MorphState, event: Event) -> tuple[MorphState, Effect]:
    """The state after an event, and what it requests."""
    if event.type in POINTER_MOVES:
        moved = replace(state, pointer=state.pointer.moved(event.mouse, precise=event.precise))
        return (moved, Effect.NONE) if state.typed.active else (_with_goal(moved), Effect.UPDATE)
    if event.navigates:
        return state, Effect.PASS
    if not event.pressed or event.type in SHIFT_KEYS:
        return state, Effect.NONE
    if event.type in CANCEL_KEYS:
        return state, Effect.CANCEL
    if event.type in CONFIRM_KEYS:
        return state, Effect.CONFIRM
    if event.type == RESPONDERS_KEY and not event.modifiers:
        return replace(state, others_yield=not state.others_yield), Effect.UPDATE
    if event.type in NEXT_KEYS and not event.modifiers:
        return _next(state, NEXT_KEYS[event.type]), Effect.UPDATE
    character = typed_character(event)
    if not character:
        return state, Effect.NONE
    return _with_goal(replace(state, typed=state.typed.typed(character))), Effect.UPDATE


def hints(translate: Translate = str) -> list[KeyHint]:
    """The keys for the status bar."""
    return [
        KeyHint(CONFIRM, translate("Confirm")),
        KeyHint(CANCEL, translate("Cancel")),
        KeyHint(("EVENT_UP_ARROW", "EVENT_DOWN_ARROW"), translate("Shape Key")),
        KeyHint(("EVENT_W",), translate("Others Yield")),
        KeyHint(("EVENT_SHIFT",), translate("Precision")),
    ]


def _next(state: MorphState, by: int) -> MorphState:
    """Drag another key from its present goal; the goals of the others stay."""
    index = (state.index + by) % len(state.keys)
    key = state.keys[index]
    base = state.goals.get(key.name, key.start)
    goals = {**state.goals, key.name: base}
    pointer = Pointer.at(state.pointer.last)
    return replace(state, index=index, pointer=pointer, goals=goals, base=base, typed=TypedNumber(), error="")


def _with_goal(state: MorphState) -> MorphState:
    """The goal of the present key by the typed number or the pointer, within the limits of its slider."""
    key, error = state.key, ""
    try:
        value = state.typed.value()
    except ValueError as invalid:
        value, error = state.goals[key.name], str(invalid)
    if value is None:
        way = (state.pointer.effective[0] - state.pointer.start[0]) / state.width
        value = state.base + way * (key.upper - key.lower)
    value = min(max(value, key.lower), key.upper)
    return replace(state, goals={**state.goals, key.name: value}, error=error)
