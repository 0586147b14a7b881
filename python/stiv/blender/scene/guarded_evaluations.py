# SPDX-License-Identifier: GPL-3.0-or-later
"""Chooses the evaluations that stay free of intersections: the viewport, the render, or both."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace

import bpy

from stiv.blender.scene.evaluated_scene import EvaluatedScene, VisibleMesh, read_scene
from stiv.blender.scene.evaluation_differences import find_differences
from stiv.blender.scene.evaluations import (
    EVALUATIONS,
    RENDER,
    SHOWN,
    VIEWPORT,
    is_active,
    is_visible,
    signature,
    subdivision_levels,
)
from stiv.blender.scene.merged_modes import merge_modes
from stiv.blender.settings import EditSettings

OF_VIEWPORT = (SHOWN, VIEWPORT)
OF_CHOICE = {"viewport": OF_VIEWPORT, "render": (RENDER,), "both": EVALUATIONS}


@dataclass(frozen=True)
class Guard:
    """The guarded evaluations.

    Attributes:
        choice: "viewport", "render" or "both".
        reason: why "auto" leaves out a render that differs; "" otherwise.
    """

    choice: str
    reason: str = ""

    @property
    def evaluations(self) -> tuple[str, ...]:
        """The evaluations that must stay free of intersections."""
        return OF_CHOICE[self.choice]


def choose_guard(context: bpy.types.Context, settings: EditSettings) -> Guard:
    """Choose the guard of an edit without evaluating anything.

    "auto" guards both if a visible participant is rendered differently, unless the surface has too many triangles.
    """
    if settings.guard != "auto":
        return Guard(settings.guard)
    scene = context.scene
    different = [
        ob for ob in context.view_layer.objects
        if settings.participates(ob.name) and signature(ob, scene, VIEWPORT) != signature(ob, scene, RENDER)
        and not ob.hide_render and is_visible(context, ob)
    ]  # fmt: skip
    if not different:
        return Guard("viewport")
    return _limited(sum(min_rendered_triangles(ob, scene) for ob in different))


def read_guarded_scene(
    context: bpy.types.Context,
    settings: EditSettings,
    accept: Callable[[str], bool] | None = None,
    strands: bool = False,
    static: Collection[str] = (),
) -> tuple[EvaluatedScene, Guard]:
    """Read the guarded evaluations (see `read_scene`) of all participants; equal meshes of both modes are merged."""
    guard = choose_guard(context, settings)
    scene = read_scene(context, accept or settings.participates, guard.evaluations, strands, static)
    scene = replace(scene, meshes=merge_modes(scene.meshes, context.scene))
    if settings.guard != "auto" or guard.choice == "viewport":
        return scene, guard
    limited = _limited(sum(len(mesh.triangles) for mesh in scene.meshes if mesh.strands is None))
    if limited.choice == "both":
        return scene, limited
    return replace(scene, meshes=tuple(_of_viewport(scene.meshes))), limited


def _limited(triangles: int) -> Guard:
    if not is_too_large(triangles):
        return Guard("both")
    return Guard("viewport", f"render not guarded: {MAX_TRIANGLES:,} triangles or more; set Guard to Both")


def _of_viewport(meshes: tuple[VisibleMesh, ...]) -> list[VisibleMesh]:
    kept = (replace(mesh, shown_in=mesh.shown_in & frozenset(OF_VIEWPORT)) for mesh in meshes)
    return [mesh for mesh in kept if mesh.shown_in]


MAX_TRIANGLES = 500_000
SUBDIVIDING = ("SUBSURF", "MULTIRES")


def is_too_large(triangles: int) -> bool:
    """Is a render with this number of triangles left out by default?"""
    return triangles >= MAX_TRIANGLES


def min_rendered_triangles(ob: bpy.types.Object, scene: bpy.types.Scene) -> int:
    """Lower bound of an object's triangles in the render: only subdivisions are counted."""
    if ob.type != "MESH":
        return 0
    levels = sum(
        subdivision_levels(modifier, scene, RENDER)
        for modifier in ob.modifiers
        if modifier.type in SUBDIVIDING and is_active(modifier, ob, RENDER)
    )
    mesh = ob.data  # a face of n corners becomes n quads, and each further level splits these into four
    return 2 * len(mesh.loops) * int(4 ** (levels - 1)) if levels else len(mesh.loops) - 2 * len(mesh.polygons)


def estimate_rendered_triangles(ob: bpy.types.Object, evaluated: bpy.types.Object, scene: bpy.types.Scene) -> int:
    """Estimate an object's triangles in the render from its evaluation in the viewport."""
    faces = len(evaluated.data.polygons) if isinstance(evaluated.data, bpy.types.Mesh) else 0
    return int(faces * 2 * 4 ** max(0, _extra_levels(ob, scene)))


def _extra_levels(ob: bpy.types.Object, scene: bpy.types.Scene) -> int:
    """Additional levels of subdivision in the render."""
    levels = 0
    for modifier in ob.modifiers:
        if modifier.type in SUBDIVIDING:
            if modifier.show_render:
                levels += subdivision_levels(modifier, scene, RENDER)
            if modifier.show_viewport:
                levels -= subdivision_levels(modifier, scene, VIEWPORT)
    return levels


def checked_evaluations(context: bpy.types.Context, render: bool = False) -> tuple[str, ...]:
    """The viewport and the render; only the viewport if the render is too large, unless `render` is true."""
    if render or not is_too_large(rendered_triangles(context)):
        return VIEWPORT, RENDER
    return (VIEWPORT,)


def chosen_evaluations(context: bpy.types.Context, guard: str, render: bool = False) -> tuple[str, ...]:
    """The evaluations of a guard: "viewport", "render", "both", or "auto" (see `checked_evaluations`)."""
    if guard == "auto":
        return checked_evaluations(context, render)
    return tuple(each for each in (VIEWPORT, RENDER) if guard in (each, "both"))


def untested_note(context: bpy.types.Context, evaluations: Sequence[str]) -> str:
    """Message about the render if it is not tested; "" otherwise."""
    if RENDER in evaluations:
        return ""
    return (
        f'scene "{context.scene.name}": the render levels, of about {rendered_triangles(context):,} triangles, were '
        "not tested; --render tests them"
    )


def rendered_triangles(context: bpy.types.Context) -> int:
    """Estimate the triangles of objects that are rendered differently, without evaluating the render."""
    different = find_differences(context, (VIEWPORT, RENDER)).render
    graph = context.evaluated_depsgraph_get()
    return sum(
        estimate_rendered_triangles(ob, ob.evaluated_get(graph), context.scene)
        for ob in context.view_layer.objects
        if ob.session_uid in different
    )
