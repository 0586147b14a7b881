# SPDX-License-Identifier: GPL-3.0-or-later
"""Updates the objects that show Loop subdivisions whenever their cages change."""

from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from . import native_module, stiv_blender
from .scene.edit_settings import loop_surface, refined_object


def refresh_cage(cage: bpy.types.Object) -> bool:
    """Update the Loop subdivision of a cage, if it has one; returns whether it changed.

    An invalid cage leaves it unchanged; the next edit reports the reason.
    """
    refined = refined_object(cage)
    if refined is None or native_module.problem():
        return False
    try:
        return stiv_blender.refresh(cage, refined, loop_surface(cage))
    except stiv_blender.InputError:
        return False


@persistent
def on_update(scene: bpy.types.Scene, graph: bpy.types.Depsgraph) -> None:
    """After each evaluation: the cages whose geometry changed."""
    changed = [update.id.original for update in graph.updates if update.is_updated_geometry]
    for cage in changed:
        if isinstance(cage, bpy.types.Object) and cage.type == "MESH":
            refresh_cage(cage)


@persistent
def on_exchange(*_: object) -> None:
    """After undo, redo and loading: all cages of the scene. Undo in Edit Mode restores only the cage."""
    for cage in bpy.context.scene.objects:
        refresh_cage(cage)


HANDLERS = (
    (bpy.app.handlers.depsgraph_update_post, on_update),
    (bpy.app.handlers.undo_post, on_exchange),
    (bpy.app.handlers.redo_post, on_exchange),
    (bpy.app.handlers.load_post, on_exchange),
)


def register() -> None:
    """Add the handlers."""
    for handlers, handler in HANDLERS:
        handlers.append(handler)


def unregister() -> None:
    """Remove the handlers."""
    for handlers, handler in HANDLERS:
        handlers.remove(handler)
