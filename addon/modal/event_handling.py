# SPDX-License-Identifier: GPL-3.0-or-later
"""The state machine of a drag: `step(state, event)` returns the next state and the action it requests."""

from __future__ import annotations

from dataclasses import replace

from .axis_lock import AXIS_KEYS, AxisLock
from .event import AXIS_BUTTON, CTRL_KEYS, POINTER_MOVES, SHIFT_KEYS, WHEEL, Event
from .pointer import Pointer
from .proportional import LARGER_KEYS, SMALLER_KEYS
from .request import KIND_KEYS, Request
from .state import Effect, Phase, State
from .typed_numbers import expression_character, typed_character

CONFIRM_KEYS = frozenset({"RET", "NUMPAD_ENTER", "SPACE", "LEFTMOUSE"})
CANCEL_KEYS = frozenset({"ESC", "RIGHTMOUSE"})
EXPRESSION_KEYS = frozenset({"EQUAL", "NUMPAD_ASTERIX"})
COLLISIONS_KEY, RESPONDERS_KEY, RESPONSE_KEY, PROPORTIONAL_KEY = "I", "W", "T", "O"
UNLOCK_KEY, BASE_KEY, SNAP_POINT_KEY = "C", "B", "A"
TARGET_KEYS = CONFIRM_KEYS | {BASE_KEY, SNAP_POINT_KEY}  # events of these need a target
NUMPAD_SIZE_KEYS = frozenset({"NUMPAD_PLUS", "NUMPAD_MINUS"})  # with Alt; without, they are typed


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
    if state.release and not state.picking_base and (event.type, event.value) == (state.release, "RELEASE"):
        return replace(state, phase=Phase.CONFIRMED), Effect.CONFIRM
    if event.type == AXIS_BUTTON and not event.navigates:
        return _pick_axis(state, event)
    if event.navigates and not _resizes(state, event):
        return state, _navigation(event)
    if event.type == "TRACKPADPAN":
        return replace(state, proportional=state.proportional.panned(event.pan)), Effect.UPDATE
    return _press(state, event) if event.pressed else (state, Effect.NONE)


def _navigation(event: Event) -> Effect:
    """With Alt, Blender's own keys do something else."""
    held = event.pressed and "alt" in event.modifiers
    return Effect.NAVIGATE if held and event.type in WHEEL | {AXIS_BUTTON} else Effect.PASS


def _point(state: State, event: Event) -> tuple[State, Effect]:
    pointer = state.pointer.moved(event.mouse, precise=event.precise)
    moved = replace(state, pointer=pointer, precise=event.precise, ctrl="ctrl" in event.modifiers)
    if state.picking_axis:
        moved = _locked_to(moved, event.axis)
    # Typed numbers override the pointer; its motion counts again once they are deleted.
    return moved, Effect.NONE if state.typed.active else Effect.UPDATE


def _pick_axis(state: State, event: Event) -> tuple[State, Effect]:
    """The button starts to pick the axis that the pointer follows, and ends with its release."""
    if not event.pressed:
        return replace(state, picking_axis=""), Effect.NONE
    picking = replace(state, picking_axis="plane" if "shift" in event.modifiers else "axis")
    if state.axis_lock.axis is None:
        return _locked_to(picking, event.axis), Effect.UPDATE
    return replace(picking, axis_lock=AxisLock()), Effect.UPDATE  # picked again as soon as the pointer moves


def _locked_to(state: State, axis: int | None) -> State:
    lock = AxisLock(axis, plane=state.picking_axis == "plane") if axis is not None else AxisLock()
    locked = replace(state, axis_lock=lock)
    return replace(locked, typed=locked.typed.limited(locked.components))


def _hold(state: State, event: Event) -> tuple[State, Effect]:
    """Shift and Ctrl act as long as they are held."""
    shift = event.type in SHIFT_KEYS
    held = replace(state, precise=event.pressed) if shift else replace(state, ctrl=event.pressed)
    changed = held != state and held.snapping | state.snapping and not state.typed.active
    return held, Effect.UPDATE if changed else Effect.NONE


def _press(state: State, event: Event) -> tuple[State, Effect]:
    if event.type in CANCEL_KEYS:
        return replace(state, phase=Phase.CANCELLED), Effect.CANCEL
    if state.picking_base:
        return _pick_base(state, event)
    if event.type in CONFIRM_KEYS and not (event.type == "SPACE" and state.typed.expression):
        return replace(state, phase=Phase.CONFIRMED), Effect.CONFIRM
    after = _type(state, event) if state.typed.expression else _command(state, event)
    after = replace(after, typed=after.typed.limited(after.components))
    return after, Effect.UPDATE if after != state else Effect.NONE


def _command(state: State, event: Event) -> State:
    """Keys that are commands unless an expression is being typed."""
    shift, others = "shift" in event.modifiers, event.modifiers - {"shift"}
    if not others and event.type in AXIS_KEYS:
        lock = AxisLock() if state.picking_axis else state.axis_lock
        return replace(state, axis_lock=lock.toggled(AXIS_KEYS[event.type], plane=shift), picking_axis="")
    if event.type == "TAB" and event.modifiers == {"shift"}:
        return replace(state, snap=state.snap ^ {state.kind})
    if event.type == SNAP_POINT_KEY and event.modifiers in ({"ctrl"}, {"alt"}, frozenset()):
        return _mark(state, event)
    if event.type == BASE_KEY and not event.modifiers:
        return replace(state, picking_base=True, base=None, snap_points=(), snap=state.snap | {state.kind})
    if event.type == UNLOCK_KEY and not event.modifiers:
        return replace(state, axis_lock=AxisLock(), picking_axis="")
    changed = _proportional(state, event)
    if changed is not None:
        return changed
    if event.type == "R" and not event.modifiers and state.kind == "rotate":
        return replace(state, trackball=not state.trackball)
    if not event.modifiers and (request := _requested(state.request, event.type)) != state.request:
        return replace(state, request=request, trackball=False)
    return _type(state, event)


def _proportional(state: State, event: Event) -> State | None:
    """The state after a key of proportional editing; None for other keys."""
    proportional = state.proportional
    if _resizes(state, event):
        changed = proportional.resized(event.type, fine=state.precise or "shift" in event.modifiers)
    elif event.type == PROPORTIONAL_KEY and event.modifiers <= {"shift"}:
        changed = proportional.with_next_falloff() if event.modifiers else proportional.toggled()
    elif event.type == UNLOCK_KEY and event.modifiers == {"alt"} and proportional.active:
        changed = proportional.with_other_distances()
    else:
        return None
    return replace(state, proportional=changed)


def _mark(state: State, event: Event) -> State:
    """Add the target under the pointer to the points that the selection moves to, or remove the last one."""
    if "alt" in event.modifiers:
        return replace(state, snap_points=state.snap_points[:-1])
    return state if event.target is None else replace(state, snap_points=(*state.snap_points, event.target))


def _pick_base(state: State, event: Event) -> tuple[State, Effect]:
    """While the pointer picks the snap base: points may be added, and a confirmation takes their mean."""
    after = state
    if event.type == SNAP_POINT_KEY:
        after = _mark(state, event)
    elif event.type in CONFIRM_KEYS | {BASE_KEY} and event.target is not None:
        points = (*state.snap_points, event.target)
        x, y, z = (sum(coordinates) / len(points) for coordinates in zip(*points, strict=True))
        pointer = Pointer.at(state.pointer.last, state.pointer.centre)
        after = replace(state, picking_base=False, base=(x, y, z), snap_points=(), pointer=pointer)
    return after, Effect.UPDATE if after != state else Effect.NONE


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
    """Whether an event changes the size of proportional editing; with Alt, the wheel zooms the view."""
    if not state.proportional.active:
        return False
    if event.type in NUMPAD_SIZE_KEYS:
        return event.pressed and event.modifiers == {"alt"}
    if event.type == "TRACKPADPAN":
        return "alt" not in event.modifiers
    return event.pressed and event.modifiers <= {"shift"} and event.type in LARGER_KEYS | SMALLER_KEYS


def _type(state: State, event: Event) -> State:
    if event.type == "TAB" and not event.modifiers:
        return replace(state, typed=state.typed.moved_on(state.components))
    if not state.typed.expression and not event.modifiers & {"ctrl", "alt"} and _begins_expression(event):
        return replace(state, typed=state.typed.as_expression())
    character = expression_character(event) if state.typed.expression else typed_character(event)
    return replace(state, typed=state.typed.typed(character)) if character else state


def _begins_expression(event: Event) -> bool:
    return event.text in ("=", "*") or (not event.text and event.type in EXPRESSION_KEYS)
