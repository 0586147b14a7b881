# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings kept in the .blend: of the scene, and a role for each object."""

import bpy
from bpy.props import EnumProperty, FloatProperty, PointerProperty, StringProperty

ROLES = (
    ("auto", "Automatic", "Controls where the object has some that are understood, otherwise rigid or an obstacle"),
    ("controls", "Controls", "Gives way by its cage vertices or by the points of its lattice"),
    ("rigid", "Rigid", "Gives way as a whole, by moving and turning"),
    ("obstacle", "Obstacle", "Never gives way"),
    ("ignored", "Ignored", "Does not take part: others go through it"),
)
RESPONDERS = (
    ("selected", "Selected", "What is selected gives way, everything else stays where it is"),
    ("unselected", "Unselected", "What is selected goes where it is put, everything else gives way"),
    ("all", "All", "Both sides give way"),
)
OBJECT_RESPONSES = (
    ("rigid", "Rigid", "In Object Mode a selected object keeps its shape"),
    ("deform", "Deform", "In Object Mode a selected object gives way by its cage vertices or lattice points"),
)


class StivSceneSettings(bpy.types.PropertyGroup):
    """How edits of a scene respond to interference."""

    separation: FloatProperty(
        name="Separation",
        description="Distance that surfaces keep; 0 chooses a ten-thousandth of the size of what moves",
        subtype="DISTANCE",
        default=0.0,
        min=0.0,
        soft_max=1.0,
        precision=4,
    )
    responders: EnumProperty(name="Gives way", description="Who gives way", items=RESPONDERS, default="selected")
    object_response: EnumProperty(
        name="Response", description="How objects give way in Object Mode", items=OBJECT_RESPONSES, default="rigid"
    )


class StivObjectSettings(bpy.types.PropertyGroup):
    """How an object takes part."""

    role: EnumProperty(name="Role", description="How the object takes part", items=ROLES, default="auto")


class StivCheckResult(bpy.types.PropertyGroup):
    """What the last check found; not saved."""

    summary: StringProperty(name="Result of the last check", options={"SKIP_SAVE"})


CLASSES = (StivSceneSettings, StivObjectSettings, StivCheckResult)


def register() -> None:
    """Attach the settings to Blender's types."""
    bpy.types.Scene.stiv = PointerProperty(type=StivSceneSettings)
    bpy.types.Object.stiv = PointerProperty(type=StivObjectSettings)
    bpy.types.WindowManager.stiv_check = PointerProperty(type=StivCheckResult)
    bpy.types.WindowManager.stiv_last_edit = StringProperty(name="Last edit, as JSON", options={"SKIP_SAVE", "HIDDEN"})


def unregister() -> None:
    """Take them off again; the values stay in the file."""
    del bpy.types.WindowManager.stiv_last_edit
    del bpy.types.WindowManager.stiv_check
    del bpy.types.Object.stiv
    del bpy.types.Scene.stiv
