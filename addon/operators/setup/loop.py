# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.loop_add`, `stiv.loop_refresh`, `stiv.loop_remove`: Loop subdivision shown beside a cage of triangles."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import EnumProperty, IntProperty

from ...native_module import NeedsNativeModule
from ...properties import BOUNDARIES
from ...scene.edit_settings import refined_object


class _LoopOperator(NeedsNativeModule):
    """Base: for the active mesh in Object Mode, which Blender's undo takes back as a whole."""

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)
    needs_refined = True

    @classmethod
    def fits(cls, context: bpy.types.Context) -> bool:
        """With an active mesh that has a subdivision, or has none yet."""
        thing = context.active_object
        if context.mode != "OBJECT" or getattr(thing, "type", "") != "MESH":
            return False
        return (refined_object(thing) is not None) == cls.needs_refined


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
        """Make the object; the cage is drawn as wires and not rendered."""
        from stiv import InputError
        from stiv.blender import add_refined

        cage = context.active_object
        try:
            refined = add_refined(context, cage, self.levels, self.boundary)
        except InputError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
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
        """Refresh, or say why it cannot be."""
        from stiv import InputError
        from stiv.blender import LoopSurface, refresh

        cage: Any = context.active_object
        refined, loop = refined_object(cage), cage.stiv.loop
        try:
            refresh(cage, refined, LoopSurface(refined.name, loop.levels, loop.boundary))
        except InputError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class STIV_OT_loop_remove(_LoopOperator, bpy.types.Operator):
    """Delete the Loop subdivision of the active cage and show the cage again"""

    bl_idname = "stiv.loop_remove"
    bl_label = "Remove Loop Subdivision"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Delete it."""
        from stiv.blender import remove_refined

        cage = context.active_object
        remove_refined(refined_object(cage))
        cage.display_type, cage.hide_render = "TEXTURED", False
        return {"FINISHED"}
