# SPDX-License-Identifier: GPL-3.0-or-later
"""The current content of the overlay. Its draw handlers exist only while there is something to draw."""

from __future__ import annotations

import contextlib
import time
import traceback
from collections.abc import Callable, Sequence

import bpy
import numpy as np
from bpy.app.handlers import persistent
from bpy.props import BoolProperty, PointerProperty

from .. import stiv_blender
from ..preferences import overlay_at_start
from ..scene.frame import view_areas
from . import drawing
from .content import Clearance, Content, Floats, Switches

_content = Content()
_handles: list[object] = []
_ghosts: stiv_blender.GhostSource | None = None
_last_step = 0.0


def content() -> Content:
    """The current content."""
    return _content


def _redraw(settings: object = None, context: object = None) -> None:
    """Add or remove the draw handlers, and redraw the views; also called by Blender for the switches."""
    if _content and _is_on():
        _add_handlers()
    else:
        _remove_handlers()
    for area in view_areas(bpy.context):
        area.tag_redraw()


def SwitchProperty(name: str, description: str, default: bool = True) -> object:  # noqa: N802 (as Blender's own)
    """A switch that redraws the overlay and is not saved."""
    return BoolProperty(name=name, description=description, default=default, options={"SKIP_SAVE"}, update=_redraw)


class StivOverlaySettings(bpy.types.PropertyGroup):
    """The switches of the overlay."""

    show: SwitchProperty(
        name="Overlay", description="Show contacts, intersecting faces, clearance and speed in the 3D view"
    )
    contacts: SwitchProperty(name="Contacts", description="Highlight the faces that hold up a drag, on both sides")
    goal: SwitchProperty(name="Goal", description="Show where the moved objects would be without collisions")
    intersections: SwitchProperty(name="Intersections", description="Show intersecting faces that the last check found")
    clearance: SwitchProperty(name="Clearance", description="Show the closest pair of objects and its distance")
    while_dragging: SwitchProperty(
        name="Clearance While Dragging",
        description="Measure the closest pair at each step of a drag, which slows it down",
        default=False,
    )
    speed: SwitchProperty(name="Speed", description="Show the milliseconds and frames per second of an edit")


def show_edit(edit: stiv_blender.Edit, result: stiv_blender.EditResult, matrix: Floats | None = None) -> None:
    """Show a result that a drag has written: its contacts, the goal and its time.

    matrix: (4, 4) motion of whole objects to the goal; None if only parts of them move.
    """
    global _last_step, _ghosts
    if not _is_on():
        return
    now, switches = time.monotonic(), bpy.context.window_manager.stiv_overlay
    if _ghosts is None or not _ghosts.belongs_to(edit):
        _ghosts = stiv_blender.GhostSource(edit)
    _content.ghost = _ghosts.ghost(result, matrix) if switches.goal else None
    _content.contacts = stiv_blender.contact_region(edit.assembly, result) if switches.contacts else None
    _content.clearance = _contact_clearance(_content.contacts)
    if switches.while_dragging:
        with contextlib.suppress(ValueError):  # the next solve has begun already: the next result is measured
            _content.clearance = clearance_of(edit.least_distance())
    _content.milliseconds = 1000.0 * result.timings["total"]
    _content.frames = 1.0 / (now - _last_step) if 0.0 < now - _last_step < 1.0 else None
    _last_step = now
    _redraw()


def end_edit() -> None:
    """Remove the content of a drag."""
    global _ghosts
    _ghosts = None
    _content.contacts = _content.ghost = _content.milliseconds = _content.frames = _content.clearance = None
    _redraw()


def show_pairs(context: bpy.types.Context, pairs: Sequence[stiv_blender.FacePair]) -> None:
    """Show intersecting faces until the scene changes."""
    context.view_layer.update()  # includes their selection, which must not count as a change
    _content.intersecting = stiv_blender.triangles_of(context, pairs)
    _redraw()


def show_alert(lines: tuple[str, ...]) -> None:
    """Show the problem of the live guard in red, until it is replaced; no lines remove it."""
    if lines != _content.alert:
        _content.alert = lines
        _redraw()


def show_clearance(found: stiv_blender.LeastDistance | None) -> None:
    """Show the closest pair until the scene changes."""
    _content.clearance = clearance_of(found)
    _redraw()


def clearance_of(found: stiv_blender.LeastDistance | None) -> Clearance | None:
    """The closest pair as content."""
    return None if found is None else Clearance(found.points[0], found.points[1], found.distance, found.bodies)


def _contact_clearance(found: stiv_blender.ContactRegion | None) -> Clearance | None:
    """The closest contact as content."""
    if found is None or found.closest is None:
        return None
    first, second = found.closest
    return Clearance(first, second, float(np.linalg.norm(first - second)))


def clear() -> None:
    """Remove all content."""
    global _content, _ghosts
    _content, _ghosts = Content(), None
    drawing.forget()
    _remove_handlers()


def _is_on() -> bool:
    settings = getattr(bpy.context.window_manager, "stiv_overlay", None)  # None before registration
    return settings is not None and settings.show


def _add_handlers() -> None:
    if not _handles and not bpy.app.background:
        for draw, when in ((drawing.draw_shapes, "POST_VIEW"), (drawing.draw_text, "POST_PIXEL")):
            _handles.append(bpy.types.SpaceView3D.draw_handler_add(_draw, (draw,), "WINDOW", when))


def _remove_handlers() -> None:
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")


def _draw(draw: Callable[[Content, Switches], None]) -> None:
    if not bpy.context.space_data.overlay.show_overlays:
        return
    try:
        draw(_content, bpy.context.window_manager.stiv_overlay)
    except Exception:  # printed once, not at every redraw
        traceback.print_exc()
        clear()


@persistent
def _on_update(scene: bpy.types.Scene, graph: bpy.types.Depsgraph) -> None:
    """Remove the results of a check when the scene changes."""
    stale = len(_content.intersecting) > 0 or _content.clearance is not None
    if stale and any(each.is_updated_geometry or each.is_updated_transform for each in graph.updates):
        _content.intersecting = _content.intersecting[:0]
        _content.clearance = None
        _redraw()


@persistent
def _on_load(*_unused: object) -> None:
    clear()


CLASSES = (StivOverlaySettings,)
HANDLERS = {"depsgraph_update_post": _on_update, "load_pre": _on_load}


def register() -> None:
    """Add the switches and the handlers."""
    bpy.types.WindowManager.stiv_overlay = PointerProperty(type=StivOverlaySettings)
    bpy.context.window_manager.stiv_overlay.show = overlay_at_start(bpy.context)
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    """Remove content, handlers and switches."""
    clear()
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).remove(handler)
    del bpy.types.WindowManager.stiv_overlay
