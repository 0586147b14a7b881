# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds keys between frames to the frames that are tested."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import bpy

from stiv.blender.scene.animation_curves import channel_curves


def add_subframe_keys(frames: Sequence[float]) -> list[float]:
    """Ascending frames, with all fractional keys of the file's animations between the first and the last.

    Between keys with linear interpolation nothing rotates. Linear motion between these frames therefore follows an
    animation with fractional keys exactly.
    """
    if not frames:
        return []
    keys = {time for time in _key_times() if frames[0] < time < frames[-1] and time != round(time)}
    return sorted({*frames, *keys})


def _key_times() -> Iterator[float]:
    for animation in _animations():
        if animation.action is not None:
            yield from _times(animation.action)
        if animation.use_nla:
            for track in animation.nla_tracks:
                for strip in track.strips:
                    yield from _strip_times(strip)


def _animations() -> Iterator[bpy.types.AnimData]:
    data = bpy.data
    for collection in (
        data.objects, data.shape_keys, data.meshes, data.curves, data.hair_curves, data.lattices, data.armatures,
        data.metaballs, data.node_groups,
    ):  # fmt: skip
        yield from (block.animation_data for block in collection if block.animation_data is not None)


def _times(action: bpy.types.Action) -> Iterator[float]:
    for curve in channel_curves(action):
        if not curve.mute:
            yield from (key.co[0] for key in curve.keyframe_points)


def _strip_times(strip: Any) -> Iterator[float]:
    """Keys of a strip's action in scene time, for each repetition."""
    if strip.mute or strip.action is None:
        return
    first, last = strip.action_frame_start, strip.action_frame_end
    for time in _times(strip.action):
        if first <= time <= last:
            along = (last - time) if strip.use_reverse else (time - first)
            start = strip.frame_start + along * strip.scale
            length = (last - first) * strip.scale
            yield from (start + number * length for number in range(max(1, round(strip.repeat))))
