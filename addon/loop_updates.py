# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps the objects that show Loop subdivisions up with their cages, whatever changes those."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.app.handlers import persistent

from . import native_module
from .scene.edit_settings import refined_object


def refresh_cage(cage: Any) -> bool:
    """Refresh what shows a cage, if anything does; returns whether it had to change.

    A cage that cannot be refined at the moment leaves it as it is; the next edit says why.
    """
    refined = refined_object(cage)
    if refined is None or native_module.problem():
        return False
    from stiv import InputError
    from stiv.blender import LoopSurface, refresh

    try:
        return bool(refresh(cage, refined, LoopSurface(refined.name, cage.stiv.loop.levels, cage.stiv.loop.boundary)))
    except InputError:
        return False


@persistent
def on_update(scene: bpy.types.Scene, graph: bpy.types.Depsgraph) -> None:
    """After each evaluation: the cages whose geometry changed."""
    changed = [update.id.original for update in graph.updates if update.is_updated_geometry]
    for cage in changed:
        if isinstance(cage, bpy.types.Object) and cage.type == "MESH":
            refresh_cage(cage)


@persistent
def on_exchange(*_: Any) -> None:
    """After undo, redo and loading: all cages of the scene. Undo in Edit Mode takes back the cage alone."""
    for cage in bpy.context.scene.objects:
        refresh_cage(cage)


HANDLERS = (
    (bpy.app.handlers.depsgraph_update_post, on_update),
    (bpy.app.handlers.undo_post, on_exchange),
    (bpy.app.handlers.redo_post, on_exchange),
    (bpy.app.handlers.load_post, on_exchange),
)


def register() -> None:
    """Begin."""
    for handlers, handler in HANDLERS:
        handlers.append(handler)


def unregister() -> None:
    """End."""
    for handlers, handler in HANDLERS:
        handlers.remove(handler)
