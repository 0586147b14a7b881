# SPDX-License-Identifier: GPL-3.0-or-later
"""Options that every transform has beside its value; a drag may change them."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.props import (
    BoolProperty,
    BoolVectorProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
)

from ... import stiv_blender
from ...modal.proportional import FALLOFFS, Proportional
from ...modal.request import Request
from ..task_operator import TimeLimitProperty
from .constraint import Constraint

OF_SCENE = "SCENE"
RESPONDERS = (
    ("SCENE", "Scene Setting", "Use the setting of the scene"),
    ("selected", "Selected", "The selection is deflected"),
    ("unselected", "Others", "Everything else is pushed aside"),
    ("all", "Both", "Both sides move"),
)
INTERFERENCE = (
    ("SCENE", "Scene Setting", "Use the setting of the scene"),
    ("ON", "On", "Surfaces collide"),
    ("OFF", "Off", "Surfaces pass through each other"),
)
OBJECT_RESPONSES = (  # with the numbers that files of version 0.1.0 contain
    ("slide", "Slide", "Objects slide along surfaces and keep their rotation", 0),
    ("slide_and_turn", "Slide and Turn", "Objects slide along surfaces and rotate where contact turns them", 2),
    ("deform", "Deform", "Vertices of meshes and points of lattices and curves yield; all else slides", 1),
)
RESPONSES = (
    ("SCENE", "Scene Setting", "Use the setting of the scene"),
    *((name, label, text) for name, label, text, _ in OBJECT_RESPONSES),
)


class TransformOptions:
    """Mixin of the operators."""

    kind: str
    constraint_axis: BoolVectorProperty(
        name="Constraint Axis",
        description="Axes along which the selection may move; none for all",
        size=3,
        subtype="XYZ",
        options={"SKIP_SAVE"},
    )
    orient_matrix: FloatVectorProperty(size=9, default=(1, 0, 0, 0, 1, 0, 0, 0, 1), options={"HIDDEN", "SKIP_SAVE"})
    proportional: BoolProperty(
        name="Proportional Editing",
        description="Move points near the selection with it, in Edit Mode",
        options={"SKIP_SAVE"},
    )
    proportional_size: FloatProperty(
        name="Proportional Size",
        description="Radius of proportional editing",
        subtype="DISTANCE",
        default=1.0,
        min=1e-6,
        options={"SKIP_SAVE"},
    )
    proportional_falloff: EnumProperty(
        name="Proportional Falloff",
        items=[(name, name.replace("_", " ").title(), "") for name in FALLOFFS],
        default="SMOOTH",
        options={"SKIP_SAVE"},
    )
    proportional_connected: BoolProperty(
        name="Connected Only", description="Measure distances along the edges of the cage", options={"SKIP_SAVE"}
    )
    responders: EnumProperty(name="Yields", items=RESPONDERS, default=OF_SCENE, options={"SKIP_SAVE"})
    interference: EnumProperty(name="Collisions", items=INTERFERENCE, default=OF_SCENE, options={"SKIP_SAVE"})
    response: EnumProperty(name="Response", items=RESPONSES, default=OF_SCENE, options={"SKIP_SAVE"})
    time_limit: TimeLimitProperty(
        description="Take the best result within this time; 0 for no limit", options={"HIDDEN", "SKIP_SAVE"}
    )
    outcome: IntProperty(options={"HIDDEN", "SKIP_SAVE"})

    def applies(self, name: str, context: bpy.types.Context) -> bool:
        """Whether a property has an effect now."""
        if name in ("responders", "response"):
            return self.request(context.scene).interference and (name == "responders" or context.mode == "OBJECT")
        if name.startswith("proportional"):
            return context.mode.startswith("EDIT") and (name == "proportional" or self.proportional)
        return True

    def influence(self) -> stiv_blender.Influence | None:
        """The influence of proportional editing, None without it."""
        settings = (self.proportional_size, self.proportional_falloff, self.proportional_connected)
        return make_influence(Proportional(True, self.proportional, *settings))

    def request(self, scene: bpy.types.Scene) -> Request:
        """The request of the edit."""
        responders = scene.stiv.responders if self.responders == OF_SCENE else self.responders
        on = scene.stiv.interference if self.interference == OF_SCENE else self.interference == "ON"
        response = scene.stiv.object_response if self.response == OF_SCENE else self.response
        return Request(self.kind, responders, on, response)

    def constraint(self) -> Constraint:
        """The chosen axes."""
        return Constraint(tuple(self.constraint_axis), np.array(self.orient_matrix).reshape(3, 3))

    def option_values(self) -> tuple[object, ...]:
        """The values of all options, for comparison."""
        settings = (self.proportional_size, self.proportional_falloff, self.proportional_connected)
        chosen = (self.responders, self.interference, self.response, *self.constraint_axis, *self.orient_matrix)
        return (*chosen, *((self.proportional, *settings) if self.proportional else ()))


def make_influence(proportional: Proportional) -> stiv_blender.Influence | None:
    """The influence of proportional editing; None if it is off."""
    if not proportional.active:
        return None
    return stiv_blender.Influence(proportional.size, proportional.falloff, proportional.connected)


def changed_options(
    request: Request, proportional: Proportional, constraint: Constraint, scene: bpy.types.Scene
) -> dict[str, object]:
    """The options at the end of a drag that differ from the defaults, and the settings of proportional editing.

    Those are given also while it is off: the redo panel then turns it on with the size of the scene.
    """
    found: dict[str, object] = {}
    if request.interference != scene.stiv.interference:
        found["interference"] = "ON" if request.interference else "OFF"
    if request.responders != scene.stiv.responders:
        found["responders"] = request.responders
    if constraint.active:
        found["constraint_axis"], found["orient_matrix"] = constraint.chosen, constraint.axes.ravel().tolist()
    if request.response != scene.stiv.object_response:
        found["response"] = request.response
    if proportional.available:
        found["proportional"] = proportional.on
        found["proportional_size"], found["proportional_falloff"] = proportional.size, proportional.falloff
        found["proportional_connected"] = proportional.connected
    return found
