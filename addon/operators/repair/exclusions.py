# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.exclude_intersections` and `stiv.clear_exclusions`: editing a scene that intersects."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import bpy

from ... import stiv_blender
from ...intersection_texts import counted_faces, short_name
from ...native_module import NeedsNativeModule
from ...scene.edit_settings import edit_settings
from ...translations import translate, translate_error
from ..finding_operator import FindingOperator

_Found = tuple["stiv_blender.Exclusions", Sequence["stiv_blender.FacePair"]]


class STIV_OT_exclude_intersections(FindingOperator, bpy.types.Operator):
    """Allow current intersections to stay or shrink; all other pairs stay guarded"""

    bl_idname = "stiv.exclude_intersections"
    bl_label = "Exclude Collisions"

    def find(self, context: bpy.types.Context) -> _Found:
        """All intersecting pairs."""
        return stiv_blender.find_exclusions(context, _settings(context))

    def take(self, context: bpy.types.Context, found: _Found) -> None:
        """Store the pairs in the scene, replacing earlier ones."""
        excluded, others = found
        context.scene.stiv.excluded = excluded.to_json()
        self.report({"INFO"}, _excluded(excluded))
        if others:
            text = translate("{}: its edges or hair still cut; set its role to No Collision")
            self.report({"WARNING"}, text.format(short_name(others[0].first.object)))


class STIV_OT_clear_exclusions(NeedsNativeModule, bpy.types.Operator):
    """Guard all pairs of faces again"""

    bl_idname = "stiv.clear_exclusions"
    bl_label = "Clear Excluded Collisions"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Delete the exclusions."""
        context.scene.stiv.excluded = ""
        return {"FINISHED"}


@functools.lru_cache(maxsize=4)
def excluded_count(stored: str) -> str:
    """The number of excluded faces stored in a scene, as a text; "" for none."""
    try:
        excluded = stiv_blender.Exclusions.from_json(stored)
    except ValueError as error:
        return translate_error(error)
    return _excluded(excluded) if len(excluded) else ""


def _excluded(excluded: stiv_blender.Exclusions) -> str:
    return translate("{} excluded").format(counted_faces(excluded.face_count, translate))


def _settings(context: bpy.types.Context) -> stiv_blender.EditSettings:
    """The settings of an edit without exclusions, which may be unreadable."""
    stored, context.scene.stiv.excluded = context.scene.stiv.excluded, ""
    try:
        return edit_settings(context.scene)
    finally:
        context.scene.stiv.excluded = stored
