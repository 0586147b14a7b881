# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds the target or the axis under the pointer to the events of the keys that use it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..modal.event import AXIS_BUTTON, Event
from ..modal.event_handling import TARGET_KEYS
from ..modal.pointer import Pointer
from ..modal.state import State
from .frame import Frame
from .snapping import Snap

AXIS_PIXELS = 30.0  # length of an axis in the view when it is compared with the motion of the pointer


def with_view(event: Event, state: State, frame: Frame, snap: Snap) -> Event:
    """The event with the target under the pointer, or with the axis along which the pointer has moved."""
    if state.picking_axis or event.type == AXIS_BUTTON:
        return replace(event, axis=followed_axis(state.pointer.moved(event.mouse), frame))
    if event.type not in TARGET_KEYS or not event.pressed or not (state.picking_base or state.snapping):
        return event
    found = snap.target(state, frame)
    return event if found is None else replace(event, target=tuple(found.position.tolist()))


def followed_axis(pointer: Pointer, frame: Frame) -> int | None:
    """The axis whose direction in the view is closest to the motion of the pointer; None before it has moved."""
    view = frame.view
    at = view.project(frame.pivot) if view is not None else None
    motion = np.subtract(pointer.last, pointer.start)
    if view is None or at is None or not motion.any():
        return None
    aside = view.at_depth_of((at[0] + AXIS_PIXELS, at[1]), frame.pivot)
    length = float(np.linalg.norm(aside - view.at_depth_of(at, frame.pivot)))
    away = []
    for axis in frame.axes.T:
        end = view.project(frame.pivot + length * axis)
        direction = np.subtract(end, at) if end is not None else np.zeros(2)
        size = float(np.linalg.norm(direction))
        across = abs(direction[0] * motion[1] - direction[1] * motion[0])
        away.append(across / size if size > 1e-3 else np.inf)
    return int(np.argmin(away))
