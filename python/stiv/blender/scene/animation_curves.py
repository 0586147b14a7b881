# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds animated and driven properties."""

from collections.abc import Iterator
from typing import Any

import bpy


def animated_paths(data: bpy.types.ID) -> set[str]:
    """Data paths of all curves and drivers of a data-block; muted ones are left out."""
    animation = getattr(data, "animation_data", None)
    if animation is None:
        return set()
    paths = {driver.data_path for driver in animation.drivers if not driver.mute}
    for action in _actions(animation):
        paths.update(curve.data_path for curve in channel_curves(action) if not curve.mute)
    return paths


def _actions(animation: bpy.types.AnimData) -> Iterator[bpy.types.Action]:
    if animation.action is not None:
        yield animation.action
    if animation.use_nla:
        for track in animation.nla_tracks:
            for strip in track.strips:
                if not (track.mute or strip.mute) and strip.action is not None:
                    yield strip.action


def channel_curves(action: Any) -> Iterator[Any]:
    """Curves of an action: those of its layers (Blender 4.4 and later), or its plain list."""
    if not hasattr(action, "layers"):
        yield from action.fcurves
        return
    for layer in action.layers:
        for strip in layer.strips:
            for bag in strip.channelbags:
                yield from bag.fcurves
