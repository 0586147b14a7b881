# SPDX-License-Identifier: GPL-3.0-or-later
"""Example scenes inside the extension, and the steps that the panel shows in each."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import bpy
import bpy.utils.previews
from bpy.props import EnumProperty, IntProperty

from .. import stiv_blender
from ..translations import translate

FOLDER = Path(__file__).absolute().parents[1] / "examples"  # an extension run from its sources has none


@dataclass(frozen=True)
class Step:
    """One step: a text, the objects and bones that it selects, and an operator with its properties."""

    text: str
    objects: tuple[str, ...]
    operator: str
    properties: dict[str, Any] = field(default_factory=dict)
    bones: tuple[str, ...] = ()


EXAMPLES = (
    ("dress_figure", "Dress Figure", "A shirt that cuts a figure, and a hat and glasses to put on"),
    ("pot_plant", "Pot Plant", "A plant above a vase that is narrower than the plant"),
    ("pack_box", "Pack Box", "A monkey, a ring and other objects above a box"),
    ("pose_arm", "Pose Arm", "A character whose arms stop at its body"),
    ("morph_body", "Morph Body", "A figure with shape keys under a shirt that yields"),
    ("clean_walk", "Clean Walk", "A walk cycle whose forearms cut the hips"),
)
STEP_TEXTS = {
    "contract": "Shrink the figure out of its shirt",
    "expand": "Grow it again; the shirt makes room",
    "glasses": "Drag the glasses onto the nose",
    "hat": "Drag the hat onto the head",
    "plant": "Drag the plant down into the vase",
    "monkey": "Drag the monkey into the box",
    "torus": "Drag the ring into the box",
    "arm": "Lower the arm onto the body",
    "forearm": "Bend the elbow",
    "heavier": "Drag Heavier; the shirt makes room",
    "both_keys": "Set both keys at once",
    "walk": "Check this frame: the arms cut the hips",
}
STEPS = {
    "dress_figure": (
        Step(STEP_TEXTS["contract"], ("Ogre",), "contract", {"steps": 12, "until_free": True}),
        Step(STEP_TEXTS["expand"], ("Ogre", "Shirt"), "expand"),
        Step(STEP_TEXTS["glasses"], ("Glasses",), "move"),
        Step(STEP_TEXTS["hat"], ("Hat",), "move"),
    ),
    "pot_plant": (Step(STEP_TEXTS["plant"], ("Lattice",), "move"),),
    "pack_box": (
        Step(STEP_TEXTS["monkey"], ("Suzanne",), "move"),
        Step(STEP_TEXTS["torus"], ("Torus",), "move"),
    ),
    "pose_arm": (
        Step(STEP_TEXTS["arm"], ("Rig",), "rotate", bones=("Arm.L",)),
        Step(STEP_TEXTS["forearm"], ("Rig",), "rotate", bones=("Forearm.L",)),
    ),
    "morph_body": (
        Step(STEP_TEXTS["heavier"], ("Body",), "morph_drag"),
        Step(STEP_TEXTS["both_keys"], ("Body",), "morph"),
    ),
    "clean_walk": (Step(STEP_TEXTS["walk"], ("Body",), "check"),),
}
KEY = "stiv_example"  # property of an example's scene: its identifier

_pictures: bpy.utils.previews.ImagePreviewCollection | None = None


class STIV_OT_open_example(bpy.types.Operator):
    """Open an example scene as a new file; asks to save the current one"""

    bl_idname = "stiv.open_example"
    bl_label = "Open Example"
    bl_options = {"INTERNAL"}  # noqa: RUF012 (Blender reads a set)

    example: EnumProperty(name="Example", description="Scene to open", items=EXAMPLES)

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """The description of the chosen scene."""
        return next(text for identifier, _, text in EXAMPLES if identifier == properties.example)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Open the scene; Blender asks first if the current file has changes."""
        return self._read("INVOKE_DEFAULT")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Open the scene at once."""
        return self._read("EXEC_DEFAULT")

    def _read(self, mode: str) -> set[str]:
        """Read the scene like a template: the file has no name yet, and the extension's copy stays as it is."""
        path = FOLDER / f"{self.example}.blend"
        return set(bpy.ops.wm.read_homefile(mode, filepath=str(path), load_ui=False, use_splash=False))


class STIV_OT_example_step(bpy.types.Operator):
    """Select the objects of a step, and run its operator"""

    bl_idname = "stiv.example_step"
    bl_label = "Example Step"
    bl_options = {"INTERNAL"}  # noqa: RUF012 (Blender reads a set)

    step: IntProperty(name="Step", description="Number of the step, from 0", min=0)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Select, then run the operator as a button would."""
        return self._run(context, "INVOKE_DEFAULT")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Select, then run the operator as a script would."""
        return self._run(context, "EXEC_DEFAULT")

    def _run(self, context: bpy.types.Context, mode: str) -> set[str]:
        steps = steps_of(context.scene)
        objects = [context.view_layer.objects.get(name) for name in steps[self.step].objects] if steps else [None]
        if None in objects:
            self.report({"ERROR"}, translate("The example has changed; open it again"))
            return {"CANCELLED"}
        if context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        for ob in context.view_layer.objects:
            ob.select_set(ob in objects)
        context.view_layer.objects.active = objects[0]
        if steps[self.step].bones:
            bpy.ops.object.mode_set(mode="POSE")
            stiv_blender.select_bones(objects[0], steps[self.step].bones)
        operator = getattr(bpy.ops.stiv, steps[self.step].operator)
        return set(operator(mode, **steps[self.step].properties)) - {"RUNNING_MODAL"} or {"FINISHED"}


def is_available() -> bool:
    """Whether the extension contains the examples."""
    return FOLDER.is_dir()


def steps_of(scene: bpy.types.Scene) -> tuple[Step, ...]:
    """The steps of an example scene; none for any other scene."""
    return STEPS.get(str(scene.get(KEY, "")), ())


def picture(example: str) -> int:
    """The icon of an example's picture, read at its first use."""
    global _pictures
    if _pictures is None:
        _pictures = bpy.utils.previews.new()
    if example not in _pictures:
        _pictures.load(example, str(FOLDER / f"{example}.png"), "IMAGE")
    return int(_pictures[example].icon_id)


def unregister() -> None:
    """Remove the pictures."""
    global _pictures
    if _pictures is not None:
        bpy.utils.previews.remove(_pictures)
        _pictures = None


CLASSES = (STIV_OT_open_example, STIV_OT_example_step)
