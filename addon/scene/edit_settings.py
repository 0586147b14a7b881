# SPDX-License-Identifier: GPL-3.0-or-later
"""From the properties of a scene to the plain settings of an edit."""

from __future__ import annotations

from typing import Any

import bpy

from ..modal.edit import Request
from ..preferences import threads

DRAG_BUDGET = 0.04  # seconds that one solve of a drag may take where its tick does not say otherwise: when it settles


def edit_settings(scene: Any, request: Request | None = None, time_budget: float = 0.0) -> Any:
    """`stiv.blender.EditSettings` of a scene; a request has the last word. `time_budget` in seconds, 0 for none."""
    from stiv.blender import EditSettings, Exclusions  # the add-on registers without the native module

    chosen = scene.stiv
    return EditSettings(
        separation=chosen.separation,
        responders=chosen.responders if request is None else request.responders,
        object_response=chosen.object_response,
        guard=chosen.guard,
        smoothness=round(chosen.smoothness, 6),  # of single precision: 0.1 shall be the core's 0.1
        constraints=chosen.constraints,
        interference=chosen.interference if request is None else request.interference,
        excluded=Exclusions.from_json(chosen.excluded),
        time_budget=time_budget,
        threads=threads(bpy.context),
        **object_choices(scene),
    )


def object_choices(scene: Any) -> dict[str, Any]:
    """`roles`, `deformations`, `handles`, `weights`, `pair_separations` and `loops` of `stiv.blender.EditSettings`."""
    from stiv.blender import Handles, LoopSurface, WeightGroup  # the add-on registers without the native module

    chosen = {thing.name: thing.stiv for thing in scene.objects}
    return {
        "roles": {name: each.role for name, each in chosen.items() if each.role != "auto"},
        "deformations": {name: each.deformation for name, each in chosen.items() if each.deformation != "auto"},
        "handles": {
            name: Handles(groups_of(each), each.anchor, each.rest, each.pull)
            for name, each in chosen.items()
            if groups_of(each) or each.anchor or each.rest != "follows" or each.pull != 0
        },
        "weights": {
            name: WeightGroup(each.weight_group, each.weight_invert, tuple(each.weight_axes))
            for name, each in chosen.items()
            if each.weight_group
        },
        "pair_separations": tuple(
            (row.first.name, row.second.name, row.separation)
            for row in scene.stiv.pair_separations
            if all(each is not None and each.name in chosen for each in (row.first, row.second))
        ),
        "loops": {
            thing.name: LoopSurface(refined.name, thing.stiv.loop.levels, thing.stiv.loop.boundary)
            for thing in scene.objects
            if (refined := refined_object(thing)) is not None and refined.name in scene.objects
        },
    }


def groups_of(chosen: Any) -> tuple[str, ...]:
    """Names of the vertex groups that are handles; rows that are still empty are none."""
    return tuple(row.name for row in chosen.handles if row.name)


def refined_object(thing: Any) -> Any:
    """The object that shows a cage's Loop subdivision; None where it shows itself.

    A copy of a cage still names the object of the first one, but is not its parent.
    """
    refined = thing.stiv.loop.object
    return refined if refined is not None and refined.parent == thing else None
