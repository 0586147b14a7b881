# SPDX-License-Identifier: GPL-3.0-or-later
"""The switch beside Snap: while it is on, Blender's own transforms collide. It belongs to the scene, like Snap."""

from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from ..scene.frame import view_areas
from . import hidden_gizmos, live_keys


def switched() -> None:
    """Called when the switch of a scene changes. Each view hides or shows Blender's gizmos when it is drawn."""
    if any(scene.stiv.live_transforms for scene in bpy.data.scenes):
        live_keys.add()
    else:
        live_keys.remove()
        hidden_gizmos.show_all()
    for area in view_areas(bpy.context):
        area.tag_redraw()


@persistent
def _before_file(*_unused: object) -> None:
    """Before a file is saved or loaded: its views have the user's gizmos."""
    hidden_gizmos.show_all()


@persistent
def _on_load(*_unused: object) -> None:
    """At startup, Blender loads its keymaps after the file. A module has none, and hangs if it ends with a timer."""
    if bpy.app.background:
        switched()
    elif not bpy.app.timers.is_registered(switched):
        bpy.app.timers.register(switched, first_interval=0.0)


HANDLERS = {"save_pre": _before_file, "load_pre": _before_file, "load_post": _on_load}


def register() -> None:
    """Add the handlers, and the keys if the scene has the switch on."""
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)
    if not bpy.app.background:  # nobody presses keys there
        _on_load()


def unregister() -> None:
    """Restore Blender's keys and gizmos."""
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).remove(handler)
    if bpy.app.timers.is_registered(switched):
        bpy.app.timers.unregister(switched)
    live_keys.remove()
    hidden_gizmos.show_all()
