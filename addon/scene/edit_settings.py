# SPDX-License-Identifier: GPL-3.0-or-later
"""From the properties of a scene and its objects to the settings of an edit. Defaults are left out."""

from __future__ import annotations

from typing import Any

import bpy

from .. import stiv_blender
from ..modal.request import Request
from ..preferences import threads

DRAG_BUDGET = 0.5  # seconds of a solve that has no budget from the loop of a drag: when it settles, in a job


def edit_settings(
    scene: bpy.types.Scene, request: Request | None = None, time_budget: float = 0.0
) -> stiv_blender.EditSettings:
    """The settings of an edit of a scene; those of a request take precedence.

    time_budget: seconds of each solve, 0 for no limit.
    """
    chosen = scene.stiv
    return stiv_blender.EditSettings(
        separation=chosen.separation,
        responders=chosen.responders if request is None else request.responders,
        object_response=chosen.object_response if request is None else request.response,
        slide_out_of_axis=chosen.slide_out_of_axis,
        joint_region=chosen.joint_region,
        guard=chosen.guard,
        smoothness=round(chosen.smoothness, 6),  # single precision: 0.1 becomes the core's 0.1
        tight=chosen.tight,
        constraints=chosen.constraints,
        interference=chosen.interference if request is None else request.interference,
        excluded=stiv_blender.Exclusions.from_json(chosen.excluded),
        time_budget=time_budget,
        threads=threads(bpy.context),
        **_object_settings(scene),
    )


def _object_settings(scene: bpy.types.Scene) -> dict[str, Any]:
    """The settings by object name, and those of pairs of objects."""
    chosen = {obj.name: obj.stiv for obj in scene.objects}
    return {
        "roles": {name: each.role for name, each in chosen.items() if each.role != "auto"},
        "deformations": {name: each.deformation for name, each in chosen.items() if each.deformation != "auto"},
        "handles": {
            name: stiv_blender.Handles(_handle_groups(each), each.anchor, each.rest, each.pull)
            for name, each in chosen.items()
            if _handle_groups(each) or each.anchor or each.rest != "follows" or each.pull != 0
        },
        "weights": {
            name: stiv_blender.WeightGroup(each.weight_group, each.weight_invert, tuple(each.weight_axes))
            for name, each in chosen.items()
            if each.weight_group
        },
        "ignored_pairs": passing_pairs(scene),
        "pair_separations": tuple(
            (row.first.name, row.second.name, row.separation)
            for row in scene.stiv.pair_separations
            if all(each is not None and each.name in chosen for each in (row.first, row.second))
        ),
        "loops": {
            obj.name: loop_surface(obj)
            for obj in scene.objects
            if (refined := refined_object(obj)) is not None and refined.name in scene.objects
        },
    }


def passing_pairs(scene: bpy.types.Scene) -> tuple[tuple[str, str], ...]:
    """Names of the objects of each pair that nothing tests against each other."""
    rows = scene.stiv.passing_pairs
    names = set(scene.objects.keys()) if rows else set()
    return tuple(
        (row.first.name, row.second.name)
        for row in rows
        if all(each is not None and each.name in names for each in (row.first, row.second))
    )


def _handle_groups(chosen: bpy.types.PropertyGroup) -> tuple[str, ...]:
    """Names of the vertex groups that are handles, without empty rows."""
    return tuple(row.name for row in chosen.handles if row.name)


def refined_object(obj: bpy.types.Object) -> bpy.types.Object | None:
    """The object that shows the Loop subdivision of a cage; None without one.

    A copy of a cage still names the object of the original cage, but is not its parent.
    """
    refined = obj.stiv.loop.object
    return refined if refined is not None and refined.parent == obj else None


def loop_surface(cage: bpy.types.Object) -> stiv_blender.LoopSurface:
    """The Loop subdivision of a cage that has one."""
    loop = cage.stiv.loop
    return stiv_blender.LoopSurface(loop.object.name, loop.levels, loop.boundary)
