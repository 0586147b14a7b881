# SPDX-License-Identifier: GPL-3.0-or-later
"""When the overlay is drawn: handlers stay only while there is something to draw."""

from __future__ import annotations

import time
import traceback
from typing import Any

import bpy
from bpy.app.handlers import persistent
from bpy.props import BoolProperty, PointerProperty

from ..preferences import overlay_at_start
from . import drawing
from .content import Clearance, Content

_content = Content()
_handles: list[Any] = []
_last_step = 0.0


def content() -> Content:
    """What is drawn now."""
    return _content


def _redraw(settings: Any = None, context: Any = None) -> None:
    """Draw while there is something to draw and the overlay is on; called by Blender for switches too."""
    if _content and _is_on():
        _begin()
    else:
        _end()
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


class StivOverlaySettings(bpy.types.PropertyGroup):
    """What the overlay shows; not saved."""

    show: BoolProperty(
        name="Overlay",
        description="Show contacts, intersecting faces, clearance and speed in the 3D view",
        default=True,
        options={"SKIP_SAVE"},
        update=_redraw,
    )
    contacts: BoolProperty(
        name="Contacts",
        description="Show contacts that block an edit, and the blocked directions",
        default=True,
        options={"SKIP_SAVE"},
        update=_redraw,
    )
    intersections: BoolProperty(
        name="Intersections",
        description="Show intersecting faces that the last check found",
        default=True,
        options={"SKIP_SAVE"},
        update=_redraw,
    )
    clearance: BoolProperty(
        name="Clearance",
        description="Show the closest pair of objects and its distance",
        default=True,
        options={"SKIP_SAVE"},
        update=_redraw,
    )
    while_dragging: BoolProperty(
        name="Clearance While Dragging",
        description="Measure the closest pair at each step of a drag, which slows it down",
        default=False,
        options={"SKIP_SAVE"},
        update=_redraw,
    )
    speed: BoolProperty(
        name="Speed",
        description="Show the milliseconds and frames per second of an edit",
        default=True,
        options={"SKIP_SAVE"},
        update=_redraw,
    )


def show_edit(edit: Any, result: Any) -> None:
    """A step of a drag: its contacts, and how long it took. edit: a `stiv.blender.BlenderEdit`."""
    global _last_step
    if not _is_on():
        return
    from stiv.blender import contacts_of  # the add-on registers without the native module

    now = time.monotonic()
    found = contacts_of(edit, result)
    _content.contacts = (found.points, found.blocked)
    if bpy.context.window_manager.stiv_overlay.while_dragging:
        _content.clearance = clearance_of(edit.least_distance())
    _content.milliseconds = 1000.0 * result.timings["total"]
    _content.frames = 1.0 / (now - _last_step) if 0.0 < now - _last_step < 1.0 else None
    _last_step = now
    _redraw()


def end_edit() -> None:
    """A drag is over."""
    _content.contacts = _content.milliseconds = _content.frames = _content.clearance = None
    _redraw()


def show_pairs(context: Any, pairs: Any) -> None:
    """Faces that a check found to meet; they go with the next change of the scene."""
    from stiv.blender import triangles_of

    context.view_layer.update()  # selecting them is a change too
    _content.intersecting = triangles_of(context, pairs)
    _redraw()


def show_alert(lines: tuple[str, ...]) -> None:
    """What the live guard could not correct, in red until others are given; none takes them away."""
    if lines != _content.alert:
        _content.alert = lines
        _redraw()


def show_clearance(found: Any) -> None:
    """The nearest pair, a `stiv.LeastDistance` or None; goes with the next change of the scene."""
    _content.clearance = clearance_of(found)
    _redraw()


def clearance_of(found: Any) -> Clearance | None:
    """What was measured, to be drawn."""
    return None if found is None else Clearance(found.points[0], found.points[1], found.distance, found.bodies)


def clear() -> None:
    """Nothing is drawn any more."""
    global _content
    _content = Content()
    _end()


def _is_on() -> bool:
    settings = getattr(bpy.context.window_manager, "stiv_overlay", None)  # None before registration
    return settings is not None and settings.show


def _begin() -> None:
    if not _handles and not bpy.app.background:
        for draw, when in ((drawing.draw_shapes, "POST_VIEW"), (drawing.draw_text, "POST_PIXEL")):
            _handles.append(bpy.types.SpaceView3D.draw_handler_add(_draw, (draw,), "WINDOW", when))


def _end() -> None:
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")


def _draw(draw: Any) -> None:
    if not bpy.context.space_data.overlay.show_overlays:
        return
    try:
        draw(_content, bpy.context.window_manager.stiv_overlay)
    except Exception:  # once, not at every picture
        traceback.print_exc()
        clear()


@persistent
def _on_update(scene: Any, graph: Any) -> None:
    """What was found in a scene says nothing of a changed one."""
    stale = len(_content.intersecting) > 0 or _content.clearance is not None
    if stale and any(each.is_updated_geometry or each.is_updated_transform for each in graph.updates):
        _content.intersecting = _content.intersecting[:0]
        _content.clearance = None
        _redraw()


@persistent
def _on_load(*_unused: Any) -> None:
    clear()


CLASSES = (StivOverlaySettings,)
HANDLERS = {"depsgraph_update_post": _on_update, "load_pre": _on_load}


def register() -> None:
    """Attach the switches, and listen for changes."""
    bpy.types.WindowManager.stiv_overlay = PointerProperty(type=StivOverlaySettings)
    bpy.context.window_manager.stiv_overlay.show = overlay_at_start(bpy.context)
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    """Leave nothing."""
    clear()
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).remove(handler)
    del bpy.types.WindowManager.stiv_overlay
