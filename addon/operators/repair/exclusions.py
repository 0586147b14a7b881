# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.exclude_intersections` and `stiv.clear_exclusions`: go on with a scene that intersects."""

from __future__ import annotations

import functools
from typing import Any

import bpy

from ...native_module import NeedsNativeModule
from ...scene.edit_settings import edit_settings
from ..check.check import counted


class ExclusionOperator(NeedsNativeModule):
    """Base: changes the setting of the scene."""

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)


class STIV_OT_exclude_intersections(ExclusionOperator, bpy.types.Operator):
    """Allow the current intersections, but no new ones; all other pairs stay guarded"""

    bl_idname = "stiv.exclude_intersections"
    bl_label = "Exclude Intersections"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Find all pairs and keep them in the scene, in place of those kept before."""
        from stiv.blender.verify.scene_check import exclusions_now  # the add-on registers without the native module

        try:
            excluded, others = exclusions_now(context, _settings(context))
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        context.scene.stiv.excluded = excluded.to_json()
        self.report({"INFO"}, f"Excluded {counted(len(excluded.pairs), 'face pair')}")
        if others:
            name, pairs = others[0].first.object, counted(len(others), "pair")
            self.report({"WARNING"}, f"{name}: {pairs} of edges, vertices or hair left. Set its role to No Collision")
        return {"FINISHED"}


class STIV_OT_clear_exclusions(ExclusionOperator, bpy.types.Operator):
    """Guard all pairs of faces again"""

    bl_idname = "stiv.clear_exclusions"
    bl_label = "Clear Exclusions"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Forget them."""
        context.scene.stiv.excluded = ""
        return {"FINISHED"}


@functools.lru_cache(maxsize=4)
def excluded_count(kept: str) -> str:
    """How many pairs a scene keeps as excluded, in words; "" for none."""
    from stiv.blender import Exclusions  # the add-on registers without the native module

    try:
        count = len(Exclusions.from_json(kept).pairs)
    except ValueError as error:
        return str(error)
    return counted(count, "excluded face pair") if count else ""


def _settings(context: bpy.types.Context) -> Any:
    """As for an edit, but for exclusions, which may be unreadable."""
    kept, context.scene.stiv.excluded = context.scene.stiv.excluded, ""
    try:
        return edit_settings(context.scene)
    finally:
        context.scene.stiv.excluded = kept
