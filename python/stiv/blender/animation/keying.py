# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys corrected bones and objects at each frame of the spans that change; curves outside of them keep their shape."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.animation.animated_parts import AnimatedPart, Values
from stiv.blender.animation.clip import Clip
from stiv.blender.scene.animation_curves import own_curves
from stiv.blender.scene.arrays import Floats

Span = tuple[int, int]


def check_curves(parts: Sequence[AnimatedPart]) -> None:
    """Refuse curves that keys of single frames would change elsewhere. Raises InputError by name."""
    for part in parts:
        for curve in _curves(part):
            if any(not modifier.mute for modifier in curve.modifiers):
                raise InputError(f"{part.name}: its curve has a modifier; bake the action")
            if curve.lock:
                raise InputError(f"{part.name}: its channels are locked; unlock them in the Dope Sheet")
        ob = part.owner.find()
        if ob.animation_data.action_blend_type != "REPLACE" or ob.animation_data.action_influence < 1:
            raise InputError(f"{ob.name}: its action has an influence or blends; bake it")


def key_corrections(clip: Clip, frames: Sequence[int], values: Floats) -> None:
    """Write keyframes of the parts with corrections, (F, k). An action with other users is copied first."""
    changed = np.array([[own.any() for own in clip.split(row)] for row in values])
    times = [_times_to_key(part, frames, changed[:, k]) for k, part in enumerate(clip.parts)]
    poses = _poses(clip, frames, values, sorted({time for each in times for time in each}))
    for part, own in zip(clip.parts, times, strict=True):
        if own:
            _own_action(part.owner.find())
    for k, (part, own) in enumerate(zip(clip.parts, times, strict=True)):
        if own:
            _key(part, [(time, poses[time][k]) for time in own])


def _poses(clip: Clip, frames: Sequence[int], values: Floats, times: Sequence[float]) -> dict[float, list[Values]]:
    """Values of all parts at these times; outside of the frames, those of the animation."""
    poses = {}
    for time in times:
        correction = np.zeros(clip.count)
        if frames[0] <= time <= frames[-1]:
            correction = np.array([np.interp(time, frames, column) for column in values.T])
        poses[time] = clip.pose(time, correction)
    return poses


def _times_to_key(part: AnimatedPart, frames: Sequence[int], changed: Any) -> list[float]:
    """Whole frames from the last key before each change to the first key after it, and the keys among them."""
    if not changed.any():
        return []
    keys = sorted({float(key.co[0]) for curve in _curves(part) for key in curve.keyframe_points})
    times: set[float] = set()
    for place in np.flatnonzero(changed).tolist():
        first = max((key for key in keys if key < frames[place]), default=float(frames[0]))
        last = min((key for key in keys if key > frames[place]), default=float(frames[-1]))
        times |= {first, last, *(float(each) for each in range(int(np.ceil(first)), int(last) + 1))}
    return sorted({*times, *(key for key in keys if min(times) <= key <= max(times) and _is_inside(key, times))})


def _is_inside(key: float, times: set[float]) -> bool:
    return np.floor(key) in times and np.ceil(key) in times


def _own_action(ob: bpy.types.Object) -> None:
    """Give an object an action of its own, if others use it."""
    animation = ob.animation_data
    action = animation.action
    if action.users - action.use_fake_user <= 1:
        return
    slot = getattr(animation, "action_slot", None)
    identifier = None if slot is None else slot.identifier
    animation.action = action.copy()
    if identifier is not None:
        animation.action_slot = animation.action.slots[identifier]


def _key(part: AnimatedPart, rows: Sequence[tuple[float, Values]]) -> None:
    """Key values at ascending times, with linear interpolation between neighbouring frames."""
    _freeze_handles(part, {rows[0][0], rows[-1][0], *_ends([time for time, _ in rows])})
    holder, group = part.find(), part.bone or "Object Transforms"
    for time, values in rows:
        part.write(values)
        for name in part.properties:
            holder.keyframe_insert(name, frame=time, group=group)
    times = [time for time, _ in rows]
    followed = {time for time, after in pairwise(times) if after - time <= 1}
    for curve in _curves(part):
        for key in curve.keyframe_points:
            if key.co[0] in followed:
                key.interpolation = "LINEAR"
        curve.update()


def _ends(times: Sequence[float]) -> Iterator[float]:
    """Both ends of each gap of more than a frame."""
    for time, after in pairwise(times):
        if after - time > 1:
            yield from (time, after)


def _freeze_handles(part: AnimatedPart, times: set[float]) -> None:
    """Keep the handles of keys at the ends of spans, which would turn toward the new keys."""
    for curve in _curves(part):
        for key in curve.keyframe_points:
            if key.co[0] in times:
                key.handle_left_type = key.handle_right_type = "FREE"


def _curves(part: AnimatedPart) -> list[Any]:
    """The curves of the properties that the correction of a part changes."""
    paths = {part.path(name) for name in part.properties}
    return [curve for curve in own_curves(part.owner.find()) if curve.data_path in paths]
