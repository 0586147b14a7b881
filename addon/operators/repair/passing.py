# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.let_pass`, `stiv.let_pass_remove`: pairs of objects that pass through each other."""

from __future__ import annotations

import bpy
from bpy.props import IntProperty

from ... import stiv_blender
from ...guard import watcher
from ...native_module import NeedsNativeModule
from ...scene.edit_settings import edit_settings, passing_pairs
from ...translations import translate
from ..finding_operator import FindingOperator

LISTED = 2  # pairs in a line


class STIV_OT_let_pass(FindingOperator, bpy.types.Operator):
    """Let the selected objects pass through the objects that they intersect now"""

    bl_idname = "stiv.let_pass"
    bl_label = "Let Collisions Pass"

    def find(self, context: bpy.types.Context) -> list[tuple[str, str]] | None:
        """Each intersecting pair of a selected object and another one; if there is none, with itself."""
        found = stiv_blender.check_scene(context, edit_settings(context.scene)).pairs
        selected = {obj.name for obj in context.selected_objects}
        chosen = sorted(names for names in found.by_objects() if selected.intersection(names))
        pairs = [pair for pair in chosen if pair[0] != pair[1]] or chosen
        if not pairs:
            self.report({"INFO"}, translate("The selection intersects no other object"))
            return None
        return pairs

    def take(self, context: bpy.types.Context, pairs: list[tuple[str, str]]) -> None:
        """Add a row for each pair."""
        for first, second in pairs:
            row = context.scene.stiv.passing_pairs.add()
            row.first, row.second = context.scene.objects[first], context.scene.objects[second]
        self.report({"INFO"}, passing_text(context.scene))
        watcher.exclusions_changed(context)


class STIV_OT_let_pass_remove(NeedsNativeModule, bpy.types.Operator):
    """Guard this pair of objects again"""

    bl_idname = "stiv.let_pass_remove"
    bl_label = "Guard Collisions Again"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    index: IntProperty(name="Index", min=0)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove the row."""
        rows = context.scene.stiv.passing_pairs
        if self.index >= len(rows):
            self.report({"ERROR"}, translate("Pair {} does not exist: the list has {}").format(self.index, len(rows)))
            return {"CANCELLED"}
        rows.remove(self.index)
        watcher.exclusions_changed(context)
        return {"FINISHED"}


def passing_text(scene: bpy.types.Scene) -> str:
    """The pairs of objects that nothing tests against each other, as a line; "" without any."""
    pairs = passing_pairs(scene)
    if not pairs:
        return ""
    places = ", ".join(["{} / {}"] * min(len(pairs), LISTED)) + (", …" if len(pairs) > LISTED else "")
    names = [name for pair in pairs[:LISTED] for name in pair]
    return stiv_blender.fit_message(translate("{}: excluded, may pass").format(places), *names)
