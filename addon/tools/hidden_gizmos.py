# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's transform gizmos, hidden in 3D views while those of the extension replace them.

Blender stores the flags with the screen. They are the user's in every saved file: `show_all` restores them before.
"""

from __future__ import annotations

from collections.abc import Iterable

import bpy

TOOL = "show_gizmo_tool"
OBJECT = {
    "move": "show_gizmo_object_translate",
    "rotate": "show_gizmo_object_rotate",
    "scale": "show_gizmo_object_scale",
}

_chosen: dict[int, dict[str, bool]] = {}  # by the address of a space: the user's values of the flags hidden there


def chosen(space: bpy.types.SpaceView3D, name: str) -> bool:
    """The user's value of a flag, hidden or not."""
    return bool(_chosen.get(space.as_pointer(), {}).get(name, getattr(space, name)))


def hide_only(space: bpy.types.SpaceView3D, names: Iterable[str]) -> None:
    """Hide the gizmos of some flags in a view, and restore the other flags."""
    found, wanted = _chosen.setdefault(space.as_pointer(), {}), set(names)
    for name in wanted:
        _hide(space, name, found)
    for name in found.keys() - wanted:
        setattr(space, name, found.pop(name))


def _hide(space: bpy.types.SpaceView3D, name: str, found: dict[str, bool]) -> None:
    shown = getattr(space, name)
    if name not in found:
        # Tool gizmos are shown unless the user hides them: a view without was split from one where they are hidden.
        found[name] = shown or name == TOOL
    elif shown:  # the user clicked on the switch, which looks off
        found[name] = not found[name]
    if shown:
        setattr(space, name, False)


def show_all() -> None:
    """Restore the flags of all views."""
    for screen in bpy.data.screens:
        for area in screen.areas:
            for space in area.spaces:
                if space.type == "VIEW_3D":
                    hide_only(space, ())
    _chosen.clear()
