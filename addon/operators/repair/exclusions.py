# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.exclude_intersections` and `stiv.clear_exclusions`: editing a scene that intersects."""

from __future__ import annotations

import functools

import bpy

from ... import stiv_blender
from ...native_module import NeedsNativeModule
from ...scene.edit_settings import edit_settings
from ...translations import counted, translate
from ..reports import report_error


class ExclusionOperator(NeedsNativeModule):
    """Base of operators that change the exclusions of the scene."""

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)


class STIV_OT_exclude_intersections(ExclusionOperator, bpy.types.Operator):
    """Allow the current intersections, but no new ones; all other pairs stay guarded"""

    bl_idname = "stiv.exclude_intersections"
    bl_label = "Exclude Intersections"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Find all intersecting pairs and store them in the scene, replacing earlier ones."""
        try:
            excluded, others = stiv_blender.find_exclusions(context, _settings(context))
        except ValueError as error:
            return report_error(self, error)
        context.scene.stiv.excluded = excluded.to_json()
        self.report({"INFO"}, _excluded(len(excluded.pairs)))
        if others:
            text = translate("{}: {} of edges, vertices or hair left. Set its role to No Collision")
            self.report({"WARNING"}, text.format(others[0].first.object, counted(len(others), "1 pair", "{} pairs")))
        return {"FINISHED"}


class STIV_OT_clear_exclusions(ExclusionOperator, bpy.types.Operator):
    """Guard all pairs of faces again"""

    bl_idname = "stiv.clear_exclusions"
    bl_label = "Clear Exclusions"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Delete the exclusions."""
        context.scene.stiv.excluded = ""
        return {"FINISHED"}


@functools.lru_cache(maxsize=4)
def excluded_count(stored: str) -> str:
    """The number of excluded pairs stored in a scene, as a text; "" for none."""
    try:
        count = len(stiv_blender.Exclusions.from_json(stored).pairs)
    except ValueError as error:
        return str(error)
    return _excluded(count) if count else ""


def _excluded(count: int) -> str:
    return counted(count, "1 excluded face pair", "{} excluded face pairs")


def _settings(context: bpy.types.Context) -> stiv_blender.EditSettings:
    """The settings of an edit without exclusions, which may be unreadable."""
    stored, context.scene.stiv.excluded = context.scene.stiv.excluded, ""
    try:
        return edit_settings(context.scene)
    finally:
        context.scene.stiv.excluded = stored
