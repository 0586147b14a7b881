# SPDX-License-Identifier: GPL-3.0-or-later
"""Inserts the keyframes that Auto Keying adds after Blender's own transforms, by the preferences and tool settings."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from contextlib import suppress

import bpy

from stiv.blender.controls.object_transform import ROTATION_PROPERTIES
from stiv.blender.scene.animation_curves import keyframe_options


def insert_auto_keyframes(
    context: bpy.types.Context, found: Iterable[tuple[bpy.types.Object | bpy.types.PoseBone, Collection[str]]]
) -> None:
    """Insert keyframes for objects or bones, each with the names of its properties to key; without names, none.

    An active keying set replaces the names if Auto Keying uses nothing else. All of location, rotation and scale
    replace them if the preferences do not ask for needed keyframes only.
    """
    changed = [(owner, names) for owner, names in found if names]
    if not changed or _insert_keying_set(context, [owner for owner, _ in changed]):
        return
    options = keyframe_options(context)
    for owner, names in changed:
        group = owner.name if isinstance(owner, bpy.types.PoseBone) else "Object Transforms"
        rotation = ROTATION_PROPERTIES.get(owner.rotation_mode, "rotation_euler")
        for name in ("location", rotation, "scale"):
            if name in names or "INSERTKEY_NEEDED" not in options:
                owner.keyframe_insert(name, group=group, options=options)


def _insert_keying_set(context: bpy.types.Context, owners: Sequence[bpy.types.Object | bpy.types.PoseBone]) -> bool:
    """Insert keyframes of the active keying set; False if Auto Keying does not use it, or there is no 3D view."""
    tools, chosen = context.scene.tool_settings, context.scene.keying_sets_all.active
    place = _find_view(context)
    if not tools.use_keyframe_insert_keyingset or chosen is None or place is None:
        return False
    bones = [each for each in owners if isinstance(each, bpy.types.PoseBone)]
    objects = list(dict.fromkeys(each.id_data for each in owners))
    window, area = place
    with (
        context.temp_override(window=window, area=area, selected_objects=objects, selected_pose_bones=bones),
        suppress(RuntimeError),  # a set that has no property of these objects
    ):
        bpy.ops.anim.keyframe_insert()
    return True


def _find_view(context: bpy.types.Context) -> tuple[bpy.types.Window, bpy.types.Area] | None:
    """A window and its 3D view, which the keying sets of Blender ask for."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                return window, area
    return None
