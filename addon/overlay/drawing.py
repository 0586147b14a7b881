# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the overlay with the colours of the theme."""

from __future__ import annotations

import blf
import bpy
import gpu
from gpu_extras.batch import batch_for_shader

from ..translations import translate
from ..units import length_text
from .content import Content, Floats, Switches, lines_of, texts_of

ARROW = 0.06  # length of an arrow as a fraction of the view distance
LINE_WIDTH = 2.0
FACE_ALPHA = 0.5
CORNER = (20, 60)  # pixels from the lower left corner, beside the toolbar
TEXT_SIZE = 12
CLEARANCE_DECIMALS = 6  # clearances are much smaller than motions


def colours(context: bpy.types.Context) -> dict[str, tuple[float, float, float]]:
    """Colours by use."""
    theme = context.preferences.themes[0]
    return {
        "contact": tuple(theme.view_3d.vertex_select)[:3],
        "blocked": tuple(theme.view_3d.object_active)[:3],
        "clearance": tuple(theme.view_3d.transform)[:3],
        "intersecting": tuple(theme.console.line_error)[:3],
        "text": tuple(theme.view_3d.space.text_hi)[:3],
    }


def draw_shapes(content: Content, switches: Switches) -> None:
    """Draw triangles and lines in the 3D view."""
    context, shader = bpy.context, gpu.shader.from_builtin("UNIFORM_COLOR")
    colour, length = colours(context), ARROW * context.region_data.view_distance
    gpu.state.blend_set("ALPHA")
    gpu.state.line_width_set(LINE_WIDTH)
    try:
        if len(content.intersecting) and switches.intersections:
            _draw(shader, "TRIS", content.intersecting.reshape(-1, 3), (*colour["intersecting"], FACE_ALPHA))
        for name, points in lines_of(content, switches, length).items():
            _draw(shader, "LINES", points, (*colour[name], 1.0))
    finally:
        gpu.state.line_width_set(1.0)
        gpu.state.blend_set("NONE")


def draw_text(content: Content, switches: Switches) -> None:
    """Draw the numbers in the lower left corner, below the alert."""
    context = bpy.context
    scale, colour = context.preferences.system.ui_scale, colours(context)
    blf.size(0, TEXT_SIZE * scale)
    left = toolbar_edge(context.area, context.region) + CORNER[0] * scale
    lines = [(text, "intersecting") for text in content.alert]
    lines += [(text, "text") for text in texts_of(content, switches, _length_text, translate)]
    for number, (text, kind) in enumerate(reversed(lines)):
        blf.color(0, *colour[kind], 1.0)
        blf.position(0, left, (CORNER[1] + 1.5 * TEXT_SIZE * number) * scale, 0)
        blf.draw(0, text)


def toolbar_edge(area: bpy.types.Area, region: bpy.types.Region) -> int:
    """Pixels at the left of a region that the toolbar covers."""
    tools = [each for each in area.regions if each.type == "TOOLS" and each.width > 1 and each.alignment == "LEFT"]
    return max([0, *(int(each.x + each.width - region.x) for each in tools)])


def _draw(shader: gpu.types.GPUShader, kind: str, points: Floats, colour: tuple[float, ...]) -> None:
    batch = batch_for_shader(shader, kind, {"pos": points.astype("float32")})
    shader.bind()
    shader.uniform_float("color", colour)
    batch.draw(shader)


def _length_text(value: float) -> str:
    return length_text(value, bpy.context.scene.unit_settings, CLEARANCE_DECIMALS)
