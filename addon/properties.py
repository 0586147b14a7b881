# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings stored in the .blend, for the scene and for each object."""

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
from .automatic import AutomaticProperty
from .operators.last_edit import note_written
from .operators.transform import morph_slider
from .operators.transform.options import OBJECT_RESPONSES

CHOSEN_SEPARATION = 0.001  # initial value when the user turns Auto off
OVERRIDABLE = {"LIBRARY_OVERRIDABLE"}  # can be set for a library override too

ROLES = (
    ("auto", "Automatic", "Moves with its controls or as a rigid object if selected; otherwise an obstacle"),
    ("controls", "Controls", "Yields with the vertices of its cage or the points of its lattice"),
    ("rigid", "Rigid", "Yields as a rigid object, as the scene's Response lets it"),
    ("obstacle", "Obstacle", "Never yields"),
    ("ignored", "No Collision", "Other objects pass through it"),
)
DEFORMATIONS = (
    ("auto", "Automatic", "Follows the scene's Response; moves vertices or points in Edit Mode"),
    ("vertices", "Vertices", "Moves the vertices of the cage, or the points of a lattice or curve"),
    ("laplacian", "Soft: Laplacian", "Moves handles; the rest follows smoothly and preserves its details"),
    ("arap", "As-Rigid-As-Possible", "Moves handles; the rest follows as rigidly as possible and rotates with them"),
    ("lattice", "Lattice", "Moves the points of the lattice that deforms the object"),
    ("rigid", "Rigid", "Preserves the object's shape"),
)
RESTS = (
    ("follows", "Follow", "Other vertices follow the handles unless anchored"),
    ("stays", "Fixed", "Only handles move"),
)
BOUNDARIES = (
    ("all", "All", "Smooth boundaries, including corners"),
    ("preserve_corners", "Keep Corners", "Smooth boundaries, but keep corners sharp"),
)
CONSTRAINTS = (
    ("per_patch", "Per Region", "Each contact region responds separately"),
    ("single", "Single", "One constraint for all contact regions; more rounds and a less even response"),
)
RESPONDERS = (
    ("selected", "Selected", "The selection is deflected; everything else stays fixed"),
    ("unselected", "Others", "The selection goes to its goal and pushes everything else aside"),
    ("all", "Both", "Both sides move"),
)
GUARDS = (
    ("auto", "Automatic", "Both, if the render differs and the surface has fewer than 500K triangles"),
    ("viewport", "Viewport", "Surfaces that the viewport shows in Object Mode and Edit Mode"),
    ("render", "Render", "Surfaces that are rendered"),
    ("both", "Both", "Surfaces of the viewport and of the render"),
)


def _guard_switched(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    from .guard import watcher  # which imports this module

    watcher.switched(context)


def _live_transforms_switched(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    from .tools import live_switch

    settings.live_guard = settings.live_transforms
    live_switch.switched()


def _exclusions_changed(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    from .guard import watcher

    watcher.exclusions_changed(context)


def _loop_changed(loop: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    loop_updates.refresh_cage(loop.id_data)


class StivPairSeparation(bpy.types.PropertyGroup):
    """Two objects, or one twice, with their own minimum distance."""

    first: PointerProperty(name="First Object", type=bpy.types.Object)
    second: PointerProperty(name="Second Object", type=bpy.types.Object)
    separation: FloatProperty(
        name="Minimum Distance",
        description="Distance between the two objects",
        subtype="DISTANCE",
        default=0.01,
        min=1e-6,
        soft_max=1.0,
        precision=4,
    )


class StivPassingPair(bpy.types.PropertyGroup):
    """Two objects that pass through each other; nothing tests them against each other."""

    first: PointerProperty(name="First Object", type=bpy.types.Object)
    second: PointerProperty(name="Second Object", type=bpy.types.Object)


class StivSceneSettings(bpy.types.PropertyGroup):
    """How edits of a scene respond to collisions."""

    separation: FloatProperty(
        name="Minimum Distance",
        description="Distance between surfaces; 0 is a ten-thousandth of the selection's size",
        subtype="DISTANCE",
        default=0.0,
        min=0.0,
        soft_max=1.0,
        precision=4,
    )
    automatic_separation: AutomaticProperty(
        of="separation",
        start=CHOSEN_SEPARATION,
        name="Auto Distance",
        description="Choose the minimum distance from the size of the selection",
    )
    pair_separations: CollectionProperty(type=StivPairSeparation, name="Pair Distances")
    passing_pairs: CollectionProperty(type=StivPassingPair, name="Passing Pairs")
    interference: BoolProperty(
        name="Collisions",
        description="Prevent surfaces from passing through each other; if off, nothing is tested",
        default=True,
    )
    live_guard: BoolProperty(
        name="Live Guard",
        description="Correct the results of Blender's tools so that surfaces do not intersect",
        default=False,
        update=_guard_switched,
    )
    live_transforms: BoolProperty(
        name="Live Collisions",
        description="Stop Blender's own transforms at surfaces; Live Guard corrects other tools",
        default=False,
        update=_live_transforms_switched,
    )
    responders: EnumProperty(
        name="Yields", description="Which side moves out of the way", items=RESPONDERS, default="selected"
    )
    object_response: EnumProperty(
        name="Response",
        description="How objects respond to contact in Object Mode",
        items=OBJECT_RESPONSES,
        default="slide",
    )
    slide_out_of_axis: BoolProperty(
        name="Slide out of Axis",
        description="Let contact move the selection off the chosen axes",
        default=False,
    )
    guard: EnumProperty(
        name="Guard", description="Evaluation that stays free of intersections", items=GUARDS, default="auto"
    )
    joint_region: FloatProperty(
        name="Joint Region",
        description="Skin around joints that may fold into itself, in radii of the limb; 0 for none",
        default=2.0,
        min=0.0,
        soft_max=5.0,
        step=10,
        precision=2,
    )
    smoothness: FloatProperty(
        name="Smoothness",
        description="Higher spreads the response smoothly, lower follows the goal more tightly",
        default=0.1,
        min=1e-4,
        max=10.0,
        soft_min=0.01,
        soft_max=1.0,
        precision=3,
    )
    tight: BoolProperty(
        name="Tight",
        description="End confirmed edits as close to the goal as possible: slower and less smooth",
        default=False,
    )
    constraints: EnumProperty(
        name="Contacts", description="How contact regions respond", items=CONSTRAINTS, default="per_patch"
    )
    excluded: StringProperty(
        name="Excluded Pairs",
        description="Pairs of faces that may intersect, as JSON",
        options={"HIDDEN"},
        update=_exclusions_changed,
    )


class StivHandleGroup(bpy.types.PropertyGroup):
    """A handle; `name` is the name of its vertex group, empty for a new row."""


class StivLoop(bpy.types.PropertyGroup):
    """The Loop subdivision of a triangle cage; `object` shows it, None without one."""

    object: PointerProperty(name="Refined Object", type=bpy.types.Object, options={"HIDDEN"})
    levels: IntProperty(
        name="Levels", description="Number of subdivisions; each splits a triangle into 4", default=2, min=1, max=3,
        update=_loop_changed,
    )  # fmt: skip
    boundary: EnumProperty(
        name="Boundary Smooth", description="How open boundaries are smoothed", items=BOUNDARIES, default="all",
        update=_loop_changed,
    )  # fmt: skip


class StivObjectSettings(bpy.types.PropertyGroup):
    """How an object participates."""

    role: EnumProperty(
        name="Role",
        description="How the object participates in collisions",
        items=ROLES,
        default="auto",
        override=OVERRIDABLE,
    )
    deformation: EnumProperty(
        name="Deformation", description="How the object deforms on contact", items=DEFORMATIONS, default="auto",
        override=OVERRIDABLE,
    )  # fmt: skip
    handles: CollectionProperty(type=StivHandleGroup, name="Handles", description="Vertex groups that act as handles")
    anchor: StringProperty(name="Anchor", description="Vertex group that stays fixed")
    rest: EnumProperty(name="Unselected", description="Vertices that are not handles", items=RESTS, default="follows")
    pull: FloatProperty(
        name="Handle Stiffness",
        description="Stiffness of the handles, multiplied by their weights; 0 places vertices exactly",
        default=0.0,
        min=0.0,
        soft_max=10.0,
    )
    weight_group: StringProperty(
        name="Weights",
        description="Vertex group that sets how far points yield; weight 0 pins them",
    )
    weight_invert: BoolProperty(name="Invert", description="Invert vertex group influence")
    weight_axes: BoolVectorProperty(
        name="Weight Axes",
        description="Local axes of the object that the weights apply to",
        default=(True, True, True),
        size=3,
        subtype="XYZ",
    )
    loop: PointerProperty(name="Loop Subdivision", type=StivLoop)
    morph_value: FloatProperty(
        name="Value",
        description="Value of the active shape key; it stops where surfaces touch",
        min=-10.0,
        max=10.0,
        step=1,
        precision=3,
        options=set(),
        get=morph_slider.get_value,
        set=morph_slider.set_value,
    )


class StivCheckResult(bpy.types.PropertyGroup):
    """The result of the last check; not saved."""

    summary: StringProperty(name="Check Result", options={"SKIP_SAVE"})
    intersects: BoolProperty(name="Intersects", options={"SKIP_SAVE", "HIDDEN"})
    left_out: StringProperty(name="Unguarded Objects", options={"SKIP_SAVE"})


class StivKeyValue(bpy.types.PropertyGroup):
    """A shape key by its name, and the value that it should get."""

    value: FloatProperty(name="Value", description="Value of the shape key", soft_min=0.0, soft_max=1.0)


CLASSES = (
    StivKeyValue,
    StivPairSeparation,
    StivPassingPair,
    StivSceneSettings,
    StivHandleGroup,
    StivLoop,
    StivObjectSettings,
    StivCheckResult,
)


def register() -> None:
    """Add the settings to Blender's types."""
    bpy.types.Scene.stiv = PointerProperty(type=StivSceneSettings)
    bpy.types.Object.stiv = PointerProperty(type=StivObjectSettings, override=OVERRIDABLE)
    bpy.types.WindowManager.stiv_check = PointerProperty(type=StivCheckResult)
    bpy.types.WindowManager.stiv_last_edit = StringProperty(
        name="Last Edit", options={"SKIP_SAVE", "HIDDEN"}, update=note_written
    )


def unregister() -> None:
    """Remove the settings; the values stay in the file."""
    del bpy.types.WindowManager.stiv_last_edit
    del bpy.types.WindowManager.stiv_check
    del bpy.types.Object.stiv
    del bpy.types.Scene.stiv
