# SPDX-License-Identifier: GPL-3.0-or-later
"""The state machine of a drag: `step(state, event)` returns the next state and the action it requests."""

from __future__ import annotations

from dataclasses import replace

from .axis_lock import AXIS_KEYS
from .event import CTRL_KEYS, POINTER_MOVES, SHIFT_KEYS, Event
from .proportional import LARGER_KEYS, SMALLER_KEYS
from .request import KIND_KEYS, Request
from .state import Effect, Phase, State
from .typed_numbers import expression_character, typed_character

CONFIRM_KEYS = frozenset({"RET", "NUMPAD_ENTER", "SPACE", "LEFTMOUSE"})
CANCEL_KEYS = frozenset({"ESC", "RIGHTMOUSE"})
EXPRESSION_KEYS = frozenset({"EQUAL", "NUMPAD_ASTERIX"})
COLLISIONS_KEY, RESPONDERS_KEY, RESPONSE_KEY, PROPORTIONAL_KEY = "I", "W", "T", "O"


def step(state: State, event: Event) -> tuple[State, Effect]:
    """The state after an event. A final phase ignores events, but a confirmed drag can be stopped."""
    if state.phase is Phase.CONFIRMED and event.pressed and event.type in CANCEL_KEYS:
        return state, Effect.STOP
    if state.phase is not Phase.DRAGGING:
        return state, Effect.NONE
    if event.type in POINTER_MOVES:
        return _point(state, event)
    if event.type in SHIFT_KEYS | CTRL_KEYS:
        return _hold(state, event)
    if state.release and (event.type, event.value) == (state.release, "RELEASE"):
        return replace(state, phase=Phase.CONFIRMED), Effect.CONFIRM
    if event.navigates and not (_resizes(state, event) and event.pressed):
        return state, Effect.PASS
    return _press(state, event) if event.pressed else (state, Effect.NONE)


def _point(state: State, event: Event) -> tuple[State, Effect]:
    pointer = state.pointer.moved(event.mouse, precise=event.precise)
    moved = replace(state, pointer=pointer, precise=event.precise, ctrl="ctrl" in event.modifiers)
    # Typed numbers override the pointer; its motion counts again once they are deleted.
    return moved, Effect.NONE if state.typed.active else Effect.UPDATE


def _hold(state: State, event: Event) -> tuple[State, Effect]:
    """Shift and Ctrl act as long as they are held."""
    shift = event.type in SHIFT_KEYS
    held = replace(state, precise=event.pressed) if shift else replace(state, ctrl=event.pressed)
    changed = held != state and held.snapping | state.snapping and not state.typed.active
    return held, Effect.UPDATE if changed else Effect.NONE


def _press(state: State, event: Event) -> tuple[State, Effect]:
    if event.type in CANCEL_KEYS:
        return replace(state, phase=Phase.CANCELLED), Effect.CANCEL
    if event.type in CONFIRM_KEYS and not (event.type == "SPACE" and state.typed.expression):
        return replace(state, phase=Phase.CONFIRMED), Effect.CONFIRM
    after = _type(state, event) if state.typed.expression else _command(state, event)
    after = replace(after, typed=after.typed.limited(after.components))
    return after, Effect.UPDATE if after != state else Effect.NONE


def _command(state: State, event: Event) -> State:
    """Keys that are commands unless an expression is being typed."""
    shift, others = "shift" in event.modifiers, event.modifiers - {"shift"}
    if not others and event.type in AXIS_KEYS:
        return replace(state, axis_lock=state.axis_lock.toggled(AXIS_KEYS[event.type], plane=shift))
    if event.type == "TAB" and event.modifiers == {"shift"}:
        return replace(state, snap=not state.snap)
    if _resizes(state, event):
        return replace(state, proportional=state.proportional.resized(event.type))
    if not others and event.type == PROPORTIONAL_KEY:
        proportional = state.proportional
        return replace(state, proportional=proportional.with_next_falloff() if shift else proportional.toggled())
    if not event.modifiers and (request := _requested(state.request, event.type)) != state.request:
        return replace(state, request=request)
    return _type(state, event)


def _requested(request: Request, key: str) -> Request:
    """The request after a key; the same for keys that do not change it."""
    if key == COLLISIONS_KEY:
        return replace(request, interference=not request.interference)
    if key == RESPONDERS_KEY:
        return request.with_next_responders()
    if key == RESPONSE_KEY:
        return request.with_next_response()
    return replace(request, kind=KIND_KEYS.get(key, request.kind))


def _resizes(state: State, event: Event) -> bool:
    """Whether the wheel or a page key changes the size of proportional editing; with Alt it zooms the view."""
    return state.proportional.active and not event.modifiers and event.type in LARGER_KEYS | SMALLER_KEYS


def _type(state: State, event: Event) -> State:
    if event.type == "TAB" and not event.modifiers:
        return replace(state, typed=state.typed.moved_on(state.components))
    if not state.typed.expression and not event.modifiers & {"ctrl", "alt"} and _begins_expression(event):
        return replace(state, typed=state.typed.as_expression())
    character = expression_character(event) if state.typed.expression else typed_character(event)
    return replace(state, typed=state.typed.typed(character)) if character else state


def _begins_expression(event: Event) -> bool:
    return event.text in ("=", "*") or (not event.text and event.type in EXPRESSION_KEYS)
