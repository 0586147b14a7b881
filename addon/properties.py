# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings kept in the .blend: of the scene and of each object."""

import bpy
from bpy.props import (
    BoolProperty,
    BoolVectorProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from . import loop_updates
from .operators.last_edit import note_written

OVERRIDABLE = {"LIBRARY_OVERRIDABLE"}  # may be chosen for a library override too

ROLES = (
    ("auto", "Automatic", "Controls where the object has some that are understood, otherwise rigid or an obstacle"),
    ("controls", "Controls", "Gives way by its cage vertices or by the points of its lattice"),
    ("rigid", "Rigid", "Gives way as a whole, by moving and turning"),
    ("obstacle", "Obstacle", "Never gives way"),
    ("ignored", "Ignored", "Does not take part: others go through it"),
)
DEFORMATIONS = (
    ("auto", "Automatic", "As the scene's response says; in Edit Mode by its vertices or points"),
    ("vertices", "Vertices", "By the vertices of its cage, or the points of a lattice"),
    ("laplacian", "Soft", "By handles; the rest follows and keeps its details (Laplacian editing)"),
    ("arap", "Soft, Turning", "By handles; the rest follows as rigidly as possible, and turns"),
    ("lattice", "Lattice", "By the points of the lattice that deforms it"),
    ("rigid", "Rigid", "As a whole, keeping its shape"),
)
RESTS = (
    ("follows", "Follows", "What is neither a handle nor anchored follows the handles"),
    ("stays", "Stays", "Everything but the handles stays where it is"),
)
BOUNDARIES = (
    ("all", "All", "Corners are rounded"),
    ("preserve_corners", "Keep Corners", "Corners stay where they are"),
)
CONSTRAINTS = (
    ("per_patch", "One a Patch", "Each region of contact gives way by itself"),
    ("single", "One for All", "One constraint for all regions: less work a round, more rounds, a less even response"),
)
RESPONDERS = (
    ("selected", "Selected", "What is selected gives way, everything else stays where it is"),
    ("unselected", "Unselected", "What is selected goes where it is put, everything else that can gives way"),
    ("all", "All", "Both sides give way"),
)
GUARDS = (
    ("auto", "Automatic", "Both where the render differs and the surface stays under 500K triangles"),
    ("viewport", "Viewport", "What the viewport shows in Object Mode and Edit Mode"),
    ("render", "Render", "What is rendered"),
    ("both", "Both", "What the viewport shows and what is rendered"),
)
OBJECT_RESPONSES = (
    ("rigid", "Rigid", "In Object Mode a selected object keeps its shape"),
    ("deform", "Deform", "In Object Mode a selected object gives way by its cage vertices or lattice points"),
)


def _guard_switched(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    from .guard import watcher  # which reads these settings

    watcher.switched(context)


def _exclusions_changed(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    from .guard import watcher

    watcher.exclusions_changed(context)


def _loop_changed(loop: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    loop_updates.refresh_cage(loop.id_data)


class StivPairSeparation(bpy.types.PropertyGroup):
    """Two objects, or one twice, that keep a distance of their own."""

    first: PointerProperty(name="First", type=bpy.types.Object)
    second: PointerProperty(name="Second", type=bpy.types.Object)
    separation: FloatProperty(
        name="Separation", description="Distance that the two keep", subtype="DISTANCE", default=0.01, min=1e-6,
        soft_max=1.0, precision=4,
    )  # fmt: skip


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
    pair_separations: CollectionProperty(type=StivPairSeparation, name="Separation of Pairs")
    interference: BoolProperty(
        name="Interference",
        description="Let surfaces give way; otherwise they may go through each other, and nothing is tested",
        default=True,
    )
    live_guard: BoolProperty(
        name="Live Guard",
        description="Correct what any tool of Blender does, so that nothing goes through anything",
        default=False,
        update=_guard_switched,
    )
    responders: EnumProperty(name="Gives way", description="Who gives way", items=RESPONDERS, default="selected")
    object_response: EnumProperty(
        name="Response", description="How objects give way in Object Mode", items=OBJECT_RESPONSES, default="rigid"
    )
    guard: EnumProperty(name="Guard", description="What is kept free of intersections", items=GUARDS, default="auto")
    smoothness: FloatProperty(
        name="Smoothness",
        description="0.1 gives way smoothly, 0.01 tightly: nearer to the shape, less even",
        default=0.1,
        min=1e-4,
        max=10.0,
        soft_min=0.01,
        soft_max=1.0,
        precision=3,
    )
    constraints: EnumProperty(
        name="Constraints", description="What a response is found by", items=CONSTRAINTS, default="per_patch"
    )
    excluded: StringProperty(
        name="Excluded Pairs",
        description="Pairs of faces that may intersect, as JSON",
        options={"HIDDEN"},
        update=_exclusions_changed,
    )


class StivHandleGroup(bpy.types.PropertyGroup):
    """A handle: `name` is that of a vertex group, empty while none is chosen."""


class StivLoop(bpy.types.PropertyGroup):
    """On a cage of triangles: the object that shows its Loop subdivision, none while there is none."""

    object: PointerProperty(name="Refined object", type=bpy.types.Object, options={"HIDDEN"})
    levels: IntProperty(
        name="Levels", description="Each cuts a triangle into four", default=2, min=1, max=3,
        update=_loop_changed,
    )  # fmt: skip
    boundary: EnumProperty(
        name="Boundary", description="Corners of the cage's boundary", items=BOUNDARIES, default="all",
        update=_loop_changed,
    )  # fmt: skip


class StivObjectSettings(bpy.types.PropertyGroup):
    """How an object takes part."""

    role: EnumProperty(
        name="Role", description="How the object takes part", items=ROLES, default="auto", override=OVERRIDABLE
    )
    deformation: EnumProperty(
        name="Deformation", description="By what the object is moved and gives way", items=DEFORMATIONS, default="auto",
        override=OVERRIDABLE,
    )  # fmt: skip
    handles: CollectionProperty(type=StivHandleGroup, name="Handles", description="Vertex groups that are handles")
    anchor: StringProperty(name="Anchor", description="Vertex group that stays where it is")
    rest: EnumProperty(name="Rest", description="What is no handle", items=RESTS, default="follows")
    pull: FloatProperty(
        name="Pull",
        description="How hard handles pull, times the weight in their group; 0 holds their vertices exactly",
        default=0.0,
        min=0.0,
        soft_max=10.0,
    )
    weight_group: StringProperty(
        name="Weights",
        description="Vertex group that says how far each vertex or point gives way; 0, or not in the group, pins it",
    )
    weight_invert: BoolProperty(name="Invert", description="Pin what is in the group instead")
    weight_axes: BoolVectorProperty(
        name="Weight Axes",
        description="Local axes of the object that the weights apply to",
        default=(True, True, True),
        size=3,
        subtype="XYZ",
    )
    loop: PointerProperty(type=StivLoop)


class StivCheckResult(bpy.types.PropertyGroup):
    """What the last check found; not saved."""

    summary: StringProperty(name="Result of the last check", options={"SKIP_SAVE"})
    left_out: StringProperty(name="Left out of the last edit", options={"SKIP_SAVE"})


CLASSES = (StivPairSeparation, StivSceneSettings, StivHandleGroup, StivLoop, StivObjectSettings, StivCheckResult)


def register() -> None:
    """Attach the settings to Blender's types."""
    bpy.types.Scene.stiv = PointerProperty(type=StivSceneSettings)
    bpy.types.Object.stiv = PointerProperty(type=StivObjectSettings, override=OVERRIDABLE)
    bpy.types.WindowManager.stiv_check = PointerProperty(type=StivCheckResult)
    bpy.types.WindowManager.stiv_last_edit = StringProperty(
        name="Last edit, as JSON", options={"SKIP_SAVE", "HIDDEN"}, update=note_written
    )


def unregister() -> None:
    """Take them off again; the values stay in the file."""
    del bpy.types.WindowManager.stiv_last_edit
    del bpy.types.WindowManager.stiv_check
    del bpy.types.Object.stiv
    del bpy.types.Scene.stiv
