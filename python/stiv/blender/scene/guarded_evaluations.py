# SPDX-License-Identifier: GPL-3.0-or-later
"""Which evaluations of a scene an edit keeps free of intersections: those of the viewport, of the render, or both."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import bpy

from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.evaluated_scene import EvaluatedScene, VisibleMesh, is_visible, read_scene
from stiv.blender.scene.evaluations import EVALUATIONS, RENDER, SHOWN, VIEWPORT, signature
from stiv.blender.scene.render_size import MOST_TRIANGLES, is_too_large, least_triangles
from stiv.blender.settings import EditSettings

OF_VIEWPORT = (SHOWN, VIEWPORT)
OF_CHOICE = {"viewport": OF_VIEWPORT, "render": (RENDER,), "both": EVALUATIONS}


@dataclass(frozen=True)
class Guard:
    """What is guarded.

    Attributes:
        choice: "viewport", "render" or "both".
        reason: why "auto" left the render out although it differs; empty otherwise.
    """

    choice: str
    reason: str = ""

    @property
    def evaluations(self) -> tuple[str, ...]:
        """The evaluations that must stay free of intersections."""
        return OF_CHOICE[self.choice]


def choose_guard(context: bpy.types.Context, settings: EditSettings) -> Guard:
    """The guard of an edit, as far as it can be told without evaluating anything.

    "auto" guards both where a visible object that participates is rendered otherwise than shown, unless the surface
    has too many triangles.
    """
    if settings.guard != "auto":
        return Guard(settings.guard)
    scene = context.scene
    different = [
        ob for ob in context.view_layer.objects
        if settings.takes_part(ob.name) and signature(ob, scene, VIEWPORT) != signature(ob, scene, RENDER)
        and not ob.hide_render and is_visible(context, ob)
    ]  # fmt: skip
    if not different:
        return Guard("viewport")
    return _limited(sum(least_triangles(ob, scene) for ob in different))


def read_guarded_scene(
    context: bpy.types.Context,
    settings: EditSettings,
    accept: Callable[[str], bool] | None = None,
    box_of: Callable[[str], tuple[Floats, Floats] | None] = lambda name: None,
    strands: bool = False,
) -> tuple[EvaluatedScene, Guard]:
    """Read the evaluations that the settings guard, as of `read_scene`; objects without a part in it are left out."""
    guard = choose_guard(context, settings)
    scene = read_scene(context, accept or settings.takes_part, box_of, guard.evaluations, strands)
    if settings.guard != "auto" or guard.choice == "viewport":
        return scene, guard
    limited = _limited(sum(len(mesh.triangles) for mesh in scene.meshes if mesh.strands is None))
    if limited.choice == "both":
        return scene, limited
    return replace(scene, meshes=tuple(_of_viewport(scene.meshes))), limited


def _limited(triangles: int) -> Guard:
    if not is_too_large(triangles):
        return Guard("both")
    return Guard("viewport", f"render not guarded: {MOST_TRIANGLES:,} triangles or more; set Guard to Both")


def _of_viewport(meshes: tuple[VisibleMesh, ...]) -> list[VisibleMesh]:
    kept = (replace(mesh, exists_in=mesh.exists_in & frozenset(OF_VIEWPORT)) for mesh in meshes)
    return [mesh for mesh in kept if mesh.exists_in]
