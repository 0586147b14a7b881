# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds animated and driven properties, and how Auto Keying inserts keyframes."""

from collections.abc import Iterator, Sequence
from typing import Any

import bpy


def driven_paths(data: bpy.types.ID) -> set[str]:
    """Data paths of all drivers of a data-block; muted ones are left out."""
    animation = getattr(data, "animation_data", None)
    return set() if animation is None else {driver.data_path for driver in animation.drivers if not driver.mute}


def keyed_paths(data: bpy.types.ID) -> set[str]:
    """Data paths of all curves of a data-block; muted ones are left out."""
    animation = getattr(data, "animation_data", None)
    actions = () if animation is None else _actions(animation)
    return {curve.data_path for action in actions for curve in channel_curves(action) if not curve.mute}


def is_animated(data: bpy.types.ID) -> bool:
    """Has a data-block an action or NLA tracks?"""
    animation = getattr(data, "animation_data", None)
    return animation is not None and (animation.action is not None or len(animation.nla_tracks) > 0)


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


def own_curves(owner: bpy.types.ID) -> Sequence[Any]:
    """Curves of an object's own action: those of its slot (Blender 4.4 and later), or all of them."""
    animation = owner.animation_data
    if animation is None or animation.action is None:
        return ()
    if not hasattr(animation.action, "layers"):
        return list(animation.action.fcurves)
    strips = [strip for layer in animation.action.layers for strip in layer.strips]
    bags = [strip.channelbag(animation.action_slot) for strip in strips if animation.action_slot is not None]
    return [curve for bag in bags if bag is not None for curve in bag.fcurves]


def keyframe_options(context: bpy.types.Context) -> set[str]:
    """How Auto Keying inserts keyframes, by the preferences and tool settings."""
    edit, tools = context.preferences.edit, context.scene.tool_settings
    chosen = {
        "INSERTKEY_NEEDED": getattr(edit, "use_auto_keyframe_insert_needed", False),
        "INSERTKEY_AVAILABLE": getattr(edit, "use_keyframe_insert_available", False),
        "INSERTKEY_VISUAL": edit.use_visual_keying,
        "INSERTKEY_REPLACE": tools.auto_keying_mode == "REPLACE_KEYS",
        "INSERTKEY_CYCLE_AWARE": tools.use_keyframe_cycle_aware,
    }
    return {name for name, is_on in chosen.items() if is_on}
