# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties that every transform has beside its value: what a drag may have chosen."""

from __future__ import annotations

from typing import Any

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from ...modal.edit import Request
from ...modal.proportional import FALLOFFS, Proportional

AS_SCENE = "SCENE"
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


class Choices:
    """Mixed into the operators."""

    proportional: BoolProperty(
        name="Proportional Editing", description="Move points near the selection with it, in Edit Mode"
    )
    proportional_size: FloatProperty(
        name="Proportional Size",
        description="Radius of proportional editing",
        subtype="DISTANCE",
        default=1.0,
        min=1e-6,
    )
    proportional_falloff: EnumProperty(
        name="Proportional Falloff",
        items=[(name, name.replace("_", " ").title(), "") for name in FALLOFFS],
        default="SMOOTH",
    )
    proportional_connected: BoolProperty(
        name="Connected Only", description="Measure distances along the edges of the cage"
    )
    responders: EnumProperty(name="Yields", items=RESPONDERS, default=AS_SCENE, options={"SKIP_SAVE"})
    interference: EnumProperty(name="Collisions", items=INTERFERENCE, default=AS_SCENE, options={"SKIP_SAVE"})
    outcome: IntProperty(options={"HIDDEN", "SKIP_SAVE"})

    def influence(self) -> Any:
        """`stiv.blender.Influence` of the properties, None without proportional editing."""
        chosen = (self.proportional_size, self.proportional_falloff, self.proportional_connected)
        return make_influence(Proportional(True, self.proportional, *chosen))

    def request(self, scene: Any) -> Request:
        """What the edit is begun with."""
        responders = scene.stiv.responders if self.responders == AS_SCENE else self.responders
        on = scene.stiv.interference if self.interference == AS_SCENE else self.interference == "ON"
        return Request(self.kind, responders, on)

    def choices(self) -> tuple[Any, ...]:
        """All of them, to be compared."""
        chosen = (self.proportional_size, self.proportional_falloff, self.proportional_connected)
        return (self.responders, self.interference, *((self.proportional, *chosen) if self.proportional else ()))


def make_influence(proportional: Proportional) -> Any:
    """`stiv.blender.Influence` of proportional editing; None where it is off."""
    from stiv.blender import Influence  # the add-on registers without the native module

    if not proportional.active:
        return None
    return Influence(proportional.size, proportional.falloff, proportional.connected)


def chosen_properties(request: Request, proportional: Proportional, scene: Any) -> dict[str, Any]:
    """The properties that say what a drag ended with."""
    found: dict[str, Any] = {}
    if request.interference != scene.stiv.interference:
        found["interference"] = "ON" if request.interference else "OFF"
    if request.responders != scene.stiv.responders:
        found["responders"] = request.responders
    if proportional.active:
        found["proportional"] = True
        found["proportional_size"], found["proportional_falloff"] = proportional.size, proportional.falloff
        found["proportional_connected"] = proportional.connected
    return found
