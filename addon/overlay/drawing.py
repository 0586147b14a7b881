# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the overlay with the colours of the theme."""

from __future__ import annotations

import blf
import bpy
import gpu
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from gpu_extras.batch import batch_for_shader

from ..translations import translate
from ..units import length_text
from .content import Content, Shape, Switches, shapes_of, texts_of

LINE_WIDTH = 2.0
CORNER = (20, 60)  # pixels from the lower left corner, beside the toolbar
TEXT_SIZE = 12
LABEL_OFFSET = 12  # pixels from the middle of a line to its distance

_batches: dict[str, tuple[object, gpu.types.GPUBatch]] = {}  # by shape, each with the points that it was made of


def colours(context: bpy.types.Context) -> dict[str, tuple[float, float, float]]:
    """Colours by use."""
    theme = context.preferences.themes[0]
    return {
        "contact": tuple(theme.view_3d.vertex_select)[:3],
        "goal": tuple(theme.view_3d.object_active)[:3],
        "clearance": tuple(theme.view_3d.transform)[:3],
        "intersecting": tuple(theme.console.line_error)[:3],
        "text": tuple(theme.view_3d.space.text_hi)[:3],
    }


def draw_shapes(content: Content, switches: Switches) -> None:
    """Draw faces and lines in the 3D view, over everything else."""
    colour = colours(bpy.context)
    gpu.state.blend_set("ALPHA")
    gpu.state.line_width_set(LINE_WIDTH)
    try:
        for name, shape in shapes_of(content, switches).items():
            _draw(name, shape, colour[shape.colour])
    finally:
        gpu.state.line_width_set(1.0)
        gpu.state.blend_set("NONE")


def draw_text(content: Content, switches: Switches) -> None:
    """Draw the numbers in the lower left corner, below the alert, and the distance beside the clearance."""
    context = bpy.context
    scale, colour = context.preferences.system.ui_scale, colours(context)
    blf.size(0, TEXT_SIZE * scale)
    left = toolbar_edge(context.area, context.region) + CORNER[0] * scale
    lines = [(text, "intersecting") for text in content.alert]
    lines += [(text, "text") for text in texts_of(content, switches, _length_text, translate)]
    for number, (text, kind) in enumerate(reversed(lines)):
        _write(text, colour[kind], left, (CORNER[1] + 1.5 * TEXT_SIZE * number) * scale)
    if content.clearance is not None and switches.clearance:
        middle = (content.clearance.first + content.clearance.second) / 2
        seen = location_3d_to_region_2d(context.region, context.region_data, middle)
        if seen is not None:
            offset = LABEL_OFFSET * scale
            _write(_length_text(content.clearance.distance), colour["clearance"], seen[0] + offset, seen[1] + offset)


def forget() -> None:
    """Release the memory of the shapes drawn last."""
    _batches.clear()


def _write(text: str, colour: tuple[float, float, float], x: float, y: float) -> None:
    blf.color(0, *colour, 1.0)
    blf.position(0, x, y, 0)
    blf.draw(0, text)


def toolbar_edge(area: bpy.types.Area, region: bpy.types.Region) -> int:
    """Pixels at the left of a region that the toolbar covers."""
    tools = [each for each in area.regions if each.type == "TOOLS" and each.width > 1 and each.alignment == "LEFT"]
    return max([0, *(int(each.x + each.width - region.x) for each in tools)])


def _draw(name: str, shape: Shape, colour: tuple[float, float, float]) -> None:
    shader = gpu.shader.from_builtin("SMOOTH_COLOR" if len(shape.strengths) else "UNIFORM_COLOR")
    source = shape.points if shape.points.base is None else shape.points.base
    made_of, batch = _batches.get(name, (None, None))
    if batch is None or made_of is not source:
        batch = _batch(shader, shape, colour)
        _batches[name] = (source, batch)
    shader.bind()
    if not len(shape.strengths):
        shader.uniform_float("color", (*colour, shape.alpha))
    gpu.state.face_culling_set("BACK" if shape.culled else "NONE")
    batch.draw(shader)
    gpu.state.face_culling_set("NONE")


def _batch(shader: gpu.types.GPUShader, shape: Shape, colour: tuple[float, float, float]) -> gpu.types.GPUBatch:
    values = {"pos": shape.points.astype("float32")}
    if len(shape.strengths):
        values["color"] = np.empty((len(shape.points), 4), "float32")
        values["color"][:, :3], values["color"][:, 3] = colour, shape.alpha * shape.strengths
    indices = shape.indices if len(shape.indices) else None
    return batch_for_shader(shader, shape.kind, values, indices=indices)


def _length_text(value: float) -> str:
    return length_text(value, bpy.context.scene.unit_settings)
