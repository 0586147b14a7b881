# SPDX-License-Identifier: GPL-3.0-or-later
"""From the properties of a scene to the plain settings of an edit."""

from __future__ import annotations

from typing import Any

import bpy

from .modal.request import Request
from .object_choices import object_choices
from .preferences import threads

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
