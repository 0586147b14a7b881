# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.transform` and `stiv.live_transform`: start a drag from a tool, and by Blender's own keys."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty

from ... import stiv_blender
from ...native_module import NeedsNativeModule, problem
from ..reports import report_raised
from .drag import OPERATORS
from .transform_operator import MODES

BLENDER_OPERATORS = {"move": "translate", "rotate": "rotate", "scale": "resize"}
ONLY_BLENDER = ("use_transform_data_origin", "use_transform_pivot_point_align", "use_transform_skip_children")
MOUSE_BUTTONS = frozenset({"LEFTMOUSE", "RIGHTMOUSE", "MIDDLEMOUSE"})


class StartsDrag(NeedsNativeModule):
    """Base of both operators: drags the selection, or starts Blender's own transform if it has no surface."""

    kind: EnumProperty(name="Transform", items=[(kind, kind.title(), "") for kind in OPERATORS], options={"SKIP_SAVE"})
    axis: IntProperty(default=-1, min=-1, max=2, options={"HIDDEN", "SKIP_SAVE"})
    plane: BoolProperty(options={"HIDDEN", "SKIP_SAVE"})
    release_confirm: BoolProperty(options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def is_available(cls, context: bpy.types.Context) -> bool:
        """In the modes of the transforms; elsewhere Blender continues with its own key."""
        return context.mode in MODES and context.region_data is not None

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Start a drag, which makes its own undo step."""
        confirms = self.release_confirm or context.preferences.inputs.use_drag_immediately
        release = event.type if confirms and event.type in MOUSE_BUTTONS else ""
        try:
            if may_collide(context):
                kind = self._possible_kind(context)
                bpy.ops.stiv.drag("INVOKE_DEFAULT", kind=kind, axis=self.axis, plane=self.plane, release=release)
            else:
                self._start_blender(release)
        except RuntimeError as error:
            return report_raised(self, error)
        return {"CANCELLED"}

    def _possible_kind(self, context: bpy.types.Context) -> str:
        """Rotate for connected bones, which cannot move, as Blender does."""
        rotates = context.mode == "POSE" and self.kind == "move" and not stiv_blender.has_movable_bones(context)
        return "rotate" if rotates else str(self.kind)

    def _start_blender(self, release: str) -> None:
        start = getattr(bpy.ops.transform, BLENDER_OPERATORS[self.kind])
        start("INVOKE_DEFAULT", constraint_axis=constrained_axes(self.axis, self.plane), release_confirm=bool(release))


class STIV_OT_transform(StartsDrag, bpy.types.Operator):
    """Drag the selection; surfaces collide instead of intersecting"""

    bl_idname = "stiv.transform"
    bl_label = "Collision Transform"
    bl_options = {"INTERNAL"}  # noqa: RUF012 (Blender reads a set)


class STIV_OT_live_transform(StartsDrag, bpy.types.Operator):
    """Blender's move, rotate or scale while its transforms collide"""

    bl_idname = "stiv.live_transform"
    bl_label = "Live Collision Transform"
    bl_options = {"INTERNAL"}  # noqa: RUF012 (Blender reads a set)

    @classmethod
    def is_available(cls, context: bpy.types.Context) -> bool:
        """Where the switch is on; elsewhere Blender continues with its own key."""
        return super().is_available(context) and is_live(context)


def is_live(context: bpy.types.Context) -> bool:
    """Whether Blender's own transforms collide in the scene."""
    return context.scene is not None and bool(context.scene.stiv.live_transforms) and not problem()


def may_collide(context: bpy.types.Context) -> bool:
    """Whether the selection may move surfaces that collide: not for lights, cameras or the role No Collision.

    Transforms of origins, or of parents without their children, are Blender's own.
    """
    if context.mode == "POSE":
        return stiv_blender.poses_surface(context)
    if context.mode != "OBJECT":
        return True
    if any(getattr(context.scene.tool_settings, name) for name in ONLY_BLENDER):
        return False
    chosen = [obj for obj in context.selected_objects if obj.stiv.role not in {"ignored", "obstacle"}]
    return stiv_blender.moves_surface(context, chosen)


def constrained_axes(axis: int, plane: bool) -> tuple[bool, bool, bool]:
    """Blender's `constraint_axis` for a lock; no axis without one."""
    x, y, z = (axis >= 0 and (each == axis) != plane for each in range(3))
    return x, y, z
