# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets: values of the scene's settings for a kind of work."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import EnumProperty

from ..translations import translate

PRESETS = (
    ("layout", "Layout", "Place props: objects slide and preserve their shape"),
    ("clothing", "Clothing", "Fit clothes: the selection deforms around bodies, 2 mm away"),
    ("hard_surface", "Hard Surface", "Fit parts: objects slide and stop as close as possible"),
    ("print", "3D Print", "Fit printed parts: 0.2 mm of clearance, tested as rendered"),
    ("animation", "Animation", "Pose and animate: viewport and render stay free of intersections"),
)
# A distance of 0 is chosen automatically.
VALUES: dict[str, dict[str, Any]] = {
    "layout": {"object_response": "slide", "separation": 0.0, "guard": "auto", "smoothness": 0.1},
    "clothing": {"object_response": "deform", "separation": 0.002, "guard": "auto", "smoothness": 0.1},
    "hard_surface": {"object_response": "slide", "separation": 0.0, "guard": "auto", "smoothness": 0.01},
    "print": {"object_response": "slide", "separation": 0.0002, "guard": "render", "smoothness": 0.01},
    "animation": {"object_response": "slide", "separation": 0.0, "guard": "both", "smoothness": 0.1},
}


class STIV_OT_apply_preset(bpy.types.Operator):
    """Set the scene's collision settings for a kind of work"""

    bl_idname = "stiv.apply_preset"
    bl_label = "Apply Preset"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    preset: EnumProperty(name="Preset", description="Kind of work", items=PRESETS)

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """The description of the chosen preset."""
        return next(text for identifier, _, text in PRESETS if identifier == properties.preset)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Set the values."""
        for name, value in VALUES[self.preset].items():
            setattr(context.scene.stiv, name, value)
        name = next(name for identifier, name, _ in PRESETS if identifier == self.preset)
        self.report({"INFO"}, translate("Preset: {}").format(translate(name)))
        return {"FINISHED"}


class STIV_MT_presets(bpy.types.Menu):
    """Settings for a kind of work"""

    bl_idname = "STIV_MT_presets"
    bl_label = "Collision Presets"

    def draw(self, context: bpy.types.Context) -> None:
        """One entry per preset."""
        for identifier, name, _ in PRESETS:
            self.layout.operator(STIV_OT_apply_preset.bl_idname, text=name).preset = identifier


CLASSES = (STIV_OT_apply_preset, STIV_MT_presets)
