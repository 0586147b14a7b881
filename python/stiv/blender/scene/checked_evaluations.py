# SPDX-License-Identifier: GPL-3.0-or-later
"""Which evaluations of a scene a check reads: the viewport's, and the render's unless it is very large."""

from __future__ import annotations

from collections.abc import Sequence

import bpy

from stiv.blender.scene.evaluations import RENDER, VIEWPORT, find_differences
from stiv.blender.scene.render_size import is_too_large, likely_triangles


def checked_evaluations(context: bpy.types.Context, render: bool = False) -> tuple[str, ...]:
    """The viewport and the render; the viewport alone where the render is too large, unless `render` asks for it."""
    if render or not is_too_large(rendered_triangles(context)):
        return VIEWPORT, RENDER
    return (VIEWPORT,)


def chosen_evaluations(context: bpy.types.Context, guard: str, render: bool = False) -> tuple[str, ...]:
    """The evaluations of a guard: "viewport", "render", "both", or "auto" as `checked_evaluations` has it."""
    if guard == "auto":
        return checked_evaluations(context, render)
    return tuple(each for each in (VIEWPORT, RENDER) if guard in (each, "both"))


def note_on(context: bpy.types.Context, evaluations: Sequence[str]) -> str:
    """What to tell of an evaluation that is not read; "" where all are."""
    if RENDER in evaluations:
        return ""
    return (
        f'scene "{context.scene.name}": the render levels, of about {rendered_triangles(context):,} triangles, were '
        "not tested; --render tests them"
    )


def rendered_triangles(context: bpy.types.Context) -> int:
    """An estimate, without evaluating the render, of the triangles of what is rendered otherwise than shown."""
    different = find_differences(context, (VIEWPORT, RENDER)).render
    graph = context.evaluated_depsgraph_get()
    return sum(
        likely_triangles(ob, ob.evaluated_get(graph), context.scene)
        for ob in context.view_layer.objects
        if ob.session_uid in different
    )
