# SPDX-License-Identifier: GPL-3.0-or-later
"""How many triangles a render has, estimated without it, and from how many on it is left out unless asked for."""

from __future__ import annotations

import bpy

from stiv.blender.scene.evaluations import RENDER, VIEWPORT, is_active, subdivision_levels

MOST_TRIANGLES = 500_000
SUBDIVIDING = ("SUBSURF", "MULTIRES")


def is_too_large(triangles: int) -> bool:
    """Is a render of so many triangles left out unless it is asked for?"""
    return triangles >= MOST_TRIANGLES


def least_triangles(ob: bpy.types.Object, scene: bpy.types.Scene) -> int:
    """How many triangles an object has when rendered, other modifiers than subdivisions left out."""
    if ob.type != "MESH":
        return 0
    levels = sum(
        subdivision_levels(modifier, scene, RENDER)
        for modifier in ob.modifiers
        if modifier.type in SUBDIVIDING and is_active(modifier, ob, RENDER)
    )
    mesh = ob.data  # a face of n corners becomes n quads, each of them four more
    return 2 * len(mesh.loops) * int(4 ** (levels - 1)) if levels else len(mesh.loops) - 2 * len(mesh.polygons)


def likely_triangles(ob: bpy.types.Object, evaluated: bpy.types.Object, scene: bpy.types.Scene) -> int:
    """How many triangles an object has when rendered, by what the viewport evaluates it to."""
    faces = len(evaluated.data.polygons) if isinstance(evaluated.data, bpy.types.Mesh) else 0
    return int(faces * 2 * 4 ** max(0, _extra_levels(ob, scene)))


def _extra_levels(ob: bpy.types.Object, scene: bpy.types.Scene) -> int:
    """By how many levels the render is subdivided beyond the viewport."""
    levels = 0
    for modifier in ob.modifiers:
        if modifier.type in SUBDIVIDING:
            if modifier.show_render:
                levels += subdivision_levels(modifier, scene, RENDER)
            if modifier.show_viewport:
                levels -= subdivision_levels(modifier, scene, VIEWPORT)
    return levels
