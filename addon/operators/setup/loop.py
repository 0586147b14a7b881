# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.loop_add`, `stiv.loop_refresh`, `stiv.loop_remove`: the Loop subdivision of a triangle cage."""

from __future__ import annotations

import bpy
from bpy.props import EnumProperty, IntProperty

from ... import stiv_blender
from ...native_module import NeedsNativeModule
from ...properties import BOUNDARIES
from ...scene.edit_settings import loop_surface, refined_object
from ..reports import report_error


class _LoopOperator(NeedsNativeModule):
    """Base of operators on the active mesh in Object Mode, where Blender's undo restores all objects."""

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)
    needs_refined = True

    @classmethod
    def is_available(cls, context: bpy.types.Context) -> bool:
        """With an active mesh that has a subdivision, or has none yet."""
        obj = context.active_object
        if context.mode != "OBJECT" or getattr(obj, "type", "") != "MESH":
            return False
        return (refined_object(obj) is not None) == cls.needs_refined


class STIV_OT_loop_add(_LoopOperator, bpy.types.Operator):
    """Show the active triangle cage as a smooth surface, which edits then use"""

    bl_idname = "stiv.loop_add"
    bl_label = "Add Loop Subdivision"
    needs_refined = False

    levels: IntProperty(
        name="Levels", description="Number of subdivisions; each splits a triangle into 4", default=2, min=1, max=3
    )
    boundary: EnumProperty(name="Boundary Smooth", items=BOUNDARIES, default="all")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add the object; the cage is drawn as a wireframe and not rendered."""
        cage = context.active_object
        try:
            refined = stiv_blender.add_refined(context, cage, self.levels, self.boundary)
        except stiv_blender.InputError as error:
            return report_error(self, error)
        loop = cage.stiv.loop
        loop.levels, loop.boundary = self.levels, self.boundary
        loop.object = refined
        cage.display_type, cage.hide_render = "WIRE", True
        return {"FINISHED"}


class STIV_OT_loop_refresh(_LoopOperator, bpy.types.Operator):
    """Update the Loop subdivision of the active cage"""

    bl_idname = "stiv.loop_refresh"
    bl_label = "Refresh Loop Subdivision"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Update it, or report the reason if the cage is invalid."""
        cage = context.active_object
        try:
            stiv_blender.refresh(cage, cage.stiv.loop.object, loop_surface(cage))
        except stiv_blender.InputError as error:
            return report_error(self, error)
        return {"FINISHED"}


class STIV_OT_loop_remove(_LoopOperator, bpy.types.Operator):
    """Delete the Loop subdivision of the active cage and show the cage again"""

    bl_idname = "stiv.loop_remove"
    bl_label = "Remove Loop Subdivision"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Delete it."""
        cage = context.active_object
        stiv_blender.remove_refined(cage.stiv.loop.object)
        cage.display_type, cage.hide_render = "TEXTURED", False
        return {"FINISHED"}
