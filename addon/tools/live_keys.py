# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys that take the place of Blender's own transforms while these collide: the same keys, read from the user's keymap.

An operator of these keys does nothing where the scene's switch is off: then Blender continues with its own key.
"""

from __future__ import annotations

import bpy

from ..operators.transform.start_drag import BLENDER_OPERATORS

KEYMAPS = (
    "Object Mode",
    "Mesh",
    "Lattice",
    "Curve",
    "Pose",
    "3D View",
    "3D View Tool: Move",
    "3D View Tool: Rotate",
    "3D View Tool: Scale",
    "3D View Tool: Tweak",
    "3D View Tool: Tweak (fallback)",
)
OPERATOR = "stiv.live_transform"
KINDS = {f"transform.{name}": kind for kind, name in BLENDER_OPERATORS.items()}
EVENT = ("type", "value", "any", "shift", "ctrl", "alt", "oskey", "key_modifier", "direction", "repeat")
COPIED = frozenset({"release_confirm"})  # a key with any other property is another command

_added: list[tuple[bpy.types.KeyMap, bpy.types.KeyMapItem]] = []


def add() -> None:
    """Add a key for each one with which the user starts a transform; those added before are removed."""
    remove()
    configurations = bpy.context.window_manager.keyconfigs
    if configurations.addon is None or configurations.user is None:
        return
    for name in KEYMAPS:
        keymap = configurations.user.keymaps.get(name)
        items = [item for item in keymap.keymap_items if _is_transform(item)] if keymap is not None else []
        for item in reversed(items):  # Blender puts the last one first
            _add_like(item, configurations.addon.keymaps, keymap)


def remove() -> None:
    """Remove all keys: Blender's own are reached again."""
    for keymap, item in _added:
        keymap.keymap_items.remove(item)
    _added.clear()


def _is_transform(item: bpy.types.KeyMapItem) -> bool:
    return item.idname in KINDS and item.active and set(item.properties.keys()) <= COPIED


def _add_like(item: bpy.types.KeyMapItem, keymaps: bpy.types.KeyMaps, like: bpy.types.KeyMap) -> None:
    keymap = keymaps.new(name=like.name, space_type=like.space_type, region_type=like.region_type)
    added = keymap.keymap_items.new(OPERATOR, item.type, item.value)
    for name in EVENT:
        setattr(added, name, getattr(item, name))
    added.properties.kind = KINDS[item.idname]
    added.properties.release_confirm = bool(item.properties.get("release_confirm", False))
    _added.append((keymap, added))
